// SPDX-License-Identifier: MIT
#include "glim/windows.h"

#include <curses.h>
#include <stdlib.h>
#include <string.h>

#include "glim/columns.h"
#include "glim/util.h"

static WINDOW *window;
static WINDOW *panel;

/* Bytes of a column: a character, and some that combine with it. */
#define COLUMN_BYTES 16

/* Puts exactly so many columns where the cursor is. */
static void add_columns(WINDOW *to, const char *text, int cols)
{
    if (cols <= 0)
        return;

    size_t size_bytes = (size_t)cols * COLUMN_BYTES + 1;
    char *line = xmalloc(size_bytes);
    columns_fit(line, size_bytes, text, cols);
    waddstr(to, line);
    free(line);
}

/* What a text takes of so many columns. */
static int shown_columns(const char *text, int cols)
{
    int all = columns_of(text);

    return all < cols ? all : cols;
}

void windows_status(const char *text)
{
    move(LINES - 1, 0);
    clrtoeol();
    if (!text)
        return;
    attron(A_REVERSE);
    add_columns(stdscr, text, COLS);
    attroff(A_REVERSE);
}

void windows_set(const char *const *texts, int text_count)
{
    int cols, rows;

    if (!window)
        return;
    getmaxyx(window, rows, cols);
    for (int i = 0; i < text_count && i < rows - 2; i++) {
        wmove(window, i + 1, 2);
        add_columns(window, texts[i], cols - 4);
    }
}

static struct window_rect window_size(const char *title,
                                      const char *const *texts, int text_count)
{
    struct window_rect r = {0, 0, columns_of(title) + 6, text_count + 2};

    for (int i = 0; i < text_count; i++) {
        int cols = columns_of(texts[i]) + 4;

        r.cols = cols > r.cols ? cols : r.cols;
    }
    r.cols = r.cols > COLS ? COLS : r.cols;
    r.rows = r.rows > LINES ? LINES : r.rows;
    return r;
}

static struct window_rect open_window(struct window_rect r, const char *title,
                                      const char *const *texts, int text_count)
{
    window = newwin(r.rows, r.cols, r.row, r.col);
    if (!window)
        return (struct window_rect){0};
    box(window, 0, 0);
    wmove(window, 0, 2);
    add_columns(window, title, shown_columns(title, r.cols - 4));
    windows_set(texts, text_count);
    /* curses believes that these cells are blank and would skip the blanks */
    redrawwin(window);
    return r;
}

struct window_rect windows_open(const char *title, const char *const *texts,
                                int text_count)
{
    struct window_rect r = window_size(title, texts, text_count);

    r.col = (COLS - r.cols) / 2;
    r.row = (LINES - r.rows) / 2;
    return open_window(r, title, texts, text_count);
}

struct window_rect windows_open_left(const char *title,
                                     const char *const *texts, int text_count)
{
    struct window_rect r = window_size(title, texts, text_count);

    r.row = r.rows < LINES ? LINES - 1 - r.rows : 0;
    return open_window(r, title, texts, text_count);
}

struct window_rect windows_open_corner(const char *title,
                                       const char *const *texts, int text_count)
{
    struct window_rect r = window_size(title, texts, text_count);

    r.col = COLS - r.cols;
    return open_window(r, title, texts, text_count);
}

void windows_close(void)
{
    if (!window)
        return;
    delwin(window);
    window = NULL;
    touchwin(stdscr);
}

static int attribute_of(enum window_look look)
{
    switch (look) {
    case WINDOW_SELECTED: return A_REVERSE;
    case WINDOW_TITLE: return A_BOLD;
    case WINDOW_HINT: return A_DIM;
    case WINDOW_PLAIN: break;
    }
    return A_NORMAL;
}

struct window_rect windows_show_panel(const struct window_line *panel_lines,
                                      int line_count, int cols)
{
    struct window_rect r = {COLS - cols, 0, cols, LINES - 1};

    if (!panel)
        panel = newwin(r.rows, r.cols, r.row, r.col);
    if (!panel)
        return (struct window_rect){0};
    werase(panel);
    mvwvline(panel, 0, 0, 0, r.rows);
    for (int i = 0; i < line_count && i < r.rows; i++) {
        wattrset(panel, attribute_of(panel_lines[i].look));
        wmove(panel, i, 1);
        add_columns(panel, panel_lines[i].text, cols - 1);
    }
    wattrset(panel, A_NORMAL);
    /* the picture and swatches were written past curses */
    redrawwin(panel);
    return r;
}

void windows_hide_panel(void)
{
    if (!panel)
        return;
    delwin(panel);
    panel = NULL;
    touchwin(stdscr);
}

void windows_notice(const char *text)
{
    int cols = columns_of(text);

    erase();
    if (cols <= COLS)
        move((LINES - 1) / 2, (COLS - cols) / 2);
    else
        move(0, 0);
    add_columns(stdscr, text, shown_columns(text, LINES * COLS - 1));
}

void windows_update(void)
{
    move(LINES - 1, 0);
    wnoutrefresh(stdscr);
    if (panel) {
        touchwin(panel);
        wnoutrefresh(panel);
    }
    if (window) {
        touchwin(window);
        wnoutrefresh(window);
    }
    if (panel || window)
        wnoutrefresh(stdscr); /* nothing but its cursor */
    doupdate();
}
