// SPDX-License-Identifier: MIT
#include "terminal/curses_windows.h"

#include <assert.h>
#include <curses.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_width.h"
#include "terminal/tty.h"
#include "terminal/xmalloc.h"

static WINDOW *window;
static WINDOW *panel;

/* A cell of picture or swatch: blank until that is drawn. */
static const struct window_cell spared = {WINDOW_CELL_SPARED, L" ", 0};

/* Cells as the terminal shows them. */
static struct {
    int cols, rows;
    struct window_cell *cell;
    bool must_clear;
} shown;

/* Bytes of a column: a character and some that combine with it. */
#define COLUMN_BYTES 16

/* Curses attribute that marks cells of picture and swatches. Text never has
 * it. */
#define SPARED WA_LOW

/* Attributes of text. */
#define ATTRIBUTES (A_BOLD | A_DIM | A_REVERSE)

/* Puts text at the cursor, cut or filled with blanks to exactly `cols`
 * columns. */
static void add_columns(WINDOW *to, const char *text, int cols)
{
    if (cols <= 0)
        return;

    size_t size_bytes = (size_t)cols * COLUMN_BYTES + 1;
    char *line = xmalloc(size_bytes);
    text_width_fit(line, size_bytes, text, cols);
    waddstr(to, line);
    free(line);
}

void windows_free(void)
{
    windows_close();
    windows_hide_panel();
    free(shown.cell);
    memset(&shown, 0, sizeof shown);
}

static void leave_to_picture(int (*erase_cells)(WINDOW *))
{
    cchar_t blank;

    setcchar(&blank, L" ", SPARED, 0, NULL);
    bkgrndset(&blank);
    erase_cells(stdscr);
    setcchar(&blank, L" ", WA_NORMAL, 0, NULL);
    bkgrndset(&blank);
}

void windows_clear(void)
{
    windows_close();
    windows_hide_panel();
    leave_to_picture(werase);
    free(shown.cell);
    shown.cell = xcalloc((size_t)LINES * (size_t)COLS, sizeof *shown.cell);
    shown.cols = COLS;
    shown.rows = LINES;
    for (int i = 0; i < COLS * LINES; i++)
        shown.cell[i] = spared;
    shown.must_clear = true;
}

/* Columns that a text takes if there are `cols`. */
static int shown_columns(const char *text, int cols)
{
    int all = text_width_of(text);

    return all < cols ? all : cols;
}

void windows_status(const char *text)
{
    move(LINES - 1, 0);
    if (!text) {
        leave_to_picture(wclrtoeol);
        return;
    }
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
    struct window_rect r = {0, 0, text_width_of(title) + 6, text_count + 2};

    for (int i = 0; i < text_count; i++) {
        int cols = text_width_of(texts[i]) + 4;

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
    box_set(window, NULL, NULL);
    wmove(window, 0, 2);
    add_columns(window, title, shown_columns(title, r.cols - 4));
    windows_set(texts, text_count);
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
    mvwvline_set(panel, 0, 0, NULL, r.rows);
    for (int i = 0; i < line_count && i < r.rows; i++) {
        wattrset(panel, attribute_of(panel_lines[i].look));
        wmove(panel, i, 1);
        add_columns(panel, panel_lines[i].text, cols - 1);
    }
    wattrset(panel, A_NORMAL);
    return r;
}

void windows_spare(int row, int col, int cols)
{
    cchar_t blank;

    if (!panel)
        return;
    setcchar(&blank, L" ", SPARED, 0, NULL);
    mvwhline_set(panel, row, col, &blank, cols);
}

void windows_hide_panel(void)
{
    if (!panel)
        return;
    delwin(panel);
    panel = NULL;
}

void windows_notice(const char *text)
{
    int cols = text_width_of(text);

    erase();
    if (cols <= COLS)
        move((LINES - 1) / 2, (COLS - cols) / 2);
    else
        move(0, 0);
    add_columns(stdscr, text, shown_columns(text, LINES * COLS - 1));
}

/* ---- writing ---- */

/* A stream to the terminal with the cursor's cell and the attributes that are
 * in force there. */
struct writer {
    FILE *to;
    int row, col; /* of the cursor; row -1: unknown */
    attr_t attributes;
};

const struct window_cell *windows_shown(int col, int row)
{
    assert(col < shown.cols && row < shown.rows);
    return &shown.cell[row * shown.cols + col];
}

static bool has_cell(const WINDOW *w, int col, int row)
{
    return w && col >= getbegx(w) && col < getbegx(w) + getmaxx(w) &&
           row >= getbegy(w) && row < getbegy(w) + getmaxy(w);
}

/* Returns the topmost window at a cell. */
static WINDOW *owner_of(int col, int row)
{
    if (has_cell(window, col, row))
        return window;
    return has_cell(panel, col, row) ? panel : stdscr;
}

/* True for half of a wide character if a window above covers the other half. */
static bool is_torn(WINDOW *w, const struct window_cell *cell, int col, int row)
{
    if (cell->kind == WINDOW_CELL_TAIL)
        return !has_cell(w, col - 1, row) || owner_of(col - 1, row) != w;
    return wcwidth(cell->text[0]) > 1 &&
           (!has_cell(w, col + 1, row) || owner_of(col + 1, row) != w);
}

static void look_at(int col, int row, struct window_cell *cell)
{
    WINDOW *w = owner_of(col, row);
    attr_t attributes = 0;
    short pair;
    cchar_t c;

    memset(cell, 0, sizeof *cell);
    mvwin_wch(w, row - getbegy(w), col - getbegx(w), &c);
    getcchar(&c, cell->text, &attributes, &pair, NULL);
    cell->attributes = attributes & (ATTRIBUTES | A_ALTCHARSET);
    cell->kind = WINDOW_CELL_TEXT;
    if (attributes & SPARED)
        *cell = spared;
    else if ((c.attr & A_CHARTEXT) > 1) /* curses' mark of a right half */
        *cell = (struct window_cell){.kind = WINDOW_CELL_TAIL};
    if (is_torn(w, cell, col, row))
        *cell = (struct window_cell){.kind = WINDOW_CELL_TEXT, .text = L" "};
}

static void put_attributes(struct writer *w, attr_t attributes)
{
    if (attributes == w->attributes)
        return;
    fprintf(w->to, "\033[0%s%s%sm", attributes & A_BOLD ? ";1" : "",
            attributes & A_DIM ? ";2" : "", attributes & A_REVERSE ? ";7" : "");
    w->attributes = attributes;
}

/* Writes a line-drawing character from the terminal's alternate character
 * set. */
static void put_line(struct writer *w, wchar_t name)
{
    const char *begin = tigetstr("smacs");
    const char *end = tigetstr("rmacs");

    fprintf(w->to, "%s%c%s", begin ? begin : "",
            (int)(acs_map[name & 127] & A_CHARTEXT), end ? end : "");
}

static void put_cell(struct writer *w, const struct window_cell *cell, int col,
                     int row)
{
    if (w->row != row || w->col != col)
        fprintf(w->to, "\033[%d;%dH", row + 1, col + 1);
    put_attributes(w, cell->attributes & ATTRIBUTES & term_attrs());
    if (cell->attributes & A_ALTCHARSET)
        put_line(w, cell->text[0]);
    else
        fprintf(w->to, "%ls", cell->text);
    /* terminals disagree about the width of other characters */
    w->row = wcwidth(cell->text[0]) == 1 && cell->text[1] == L'\0' ? row : -1;
    w->col = col + 1;
}

static void update_cell(struct writer *w, int col, int row)
{
    struct window_cell *was = &shown.cell[row * shown.cols + col];
    struct window_cell now;

    look_at(col, row, &now);
    if (memcmp(was, &now, sizeof now) == 0 ||
        (tty_scrolls_at_end() && col == shown.cols - 1 &&
         row == shown.rows - 1))
        return;
    *was = now;
    if (now.kind != WINDOW_CELL_TAIL)
        put_cell(w, &now, col, row);
}

/* Curses' doupdate() would destroy the picture, which it does not know: to save
 * bytes it scrolls, erases to the end of a line, and writes blanks instead of
 * moving the cursor. */
void windows_update(void)
{
    char *bytes;
    size_t size_bytes;
    struct writer w = {.to = open_memstream(&bytes, &size_bytes), .row = -1};

    if (!w.to)
        return;
    if (shown.must_clear)
        fputs("\033[m\033[H\033[J", w.to);
    shown.must_clear = false;
    for (int row = 0; row < shown.rows; row++) {
        for (int col = 0; col < shown.cols; col++)
            update_cell(&w, col, row);
    }
    if (ftell(w.to) > 0)
        fprintf(w.to, "\033[m\033[%d;1H", shown.rows);
    fclose(w.to);
    tty_write(bytes, size_bytes);
    free(bytes);
}
