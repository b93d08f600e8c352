// SPDX-License-Identifier: MIT
#include "studio/list_window.h"

#include <stdio.h>
#include <string.h>

#include "base/print.h"
#include "base/min_max.h"
#include "studio/keys_bar.h"

#define ESCAPE    27
#define BACKSPACE 127

#define TEXT_COLS 52 /* of a row */
#define PANE_MIN  24 /* of the pane, with two before it */
#define PANE_MAX  46
#define PANE_ROWS 10 /* of a list with a pane, at least */
#define KEY_COLS  9
#define PAGE_ROWS 10
#define WHEEL     3
#define LINES_MAX 256

/* Rows of the window besides the list: the search, a blank row, the keys. */
#define OTHER_ROWS 3

/* Column and first row of the text, from the corner of the window. */
#define LEFT 2
#define TOP  1

/* A line of the list: a row, or the title of its group. */
struct line {
    int row;
    bool is_title;
};

static bool begins_group(const struct list_window *l,
                         const struct list_row *rows, int i)
{
    return l->search[0] == '\0' && rows[i].group[0] != '\0' &&
           (i == 0 || strcmp(rows[i].group, rows[i - 1].group) != 0);
}

/* Returns the line of a row; of `count`, the number of lines. */
static int line_of(const struct list_window *l, const struct list_row *rows,
                   int row, int count)
{
    int line = row;

    for (int i = 0; i <= row && i < count; i++)
        line += begins_group(l, rows, i);
    return line;
}

/* Returns what line `at` shows. Its row is `count` behind the last one. */
static struct line line_at(const struct list_window *l,
                           const struct list_row *rows, int count, int at)
{
    int row = 0, line = 0;

    for (; row < count; row++) {
        bool has_title = begins_group(l, rows, row);

        if (has_title && line++ == at)
            return (struct line){row, true};
        if (line++ == at)
            break;
    }
    return (struct line){row, false};
}

/* Returns the columns of the pane with those before it. */
static int pane_cols(int cols)
{
    int room = cols - TEXT_COLS - 2 * LEFT;

    return room < PANE_MIN ? 0 : int_min(room, PANE_MAX);
}

void list_window_open(struct list_window *l, struct screen *screen,
                      const char *title, const struct list_row *rows, int count)
{
    struct tty_size size = term_size();
    int cols = int_min(TEXT_COLS, size.cols - 2 * LEFT);
    int pane = l->has_pane ? pane_cols(size.cols) : 0;
    const char *lines[LINES_MAX];
    char blank[TEXT_COLS + PANE_MAX + 1];

    l->is_open = true;
    l->rows = int_max(line_of(l, rows, count, count), pane > 0 ? PANE_ROWS : 0);
    l->rows = int_min(l->rows, size.rows - 3 - OTHER_ROWS);
    l->rows = int_min(int_max(l->rows, 1), LINES_MAX - OTHER_ROWS);
    snprintf(blank, sizeof blank, "%*s", int_max(cols + pane, 1), "");
    for (int i = 0; i < l->rows + OTHER_ROWS; i++)
        lines[i] = blank;
    l->at = screen_open_window(screen, WINDOW_MIDDLE, title, lines,
                               l->rows + OTHER_ROWS);
    l->pane = (struct window_rect){LEFT + cols + 2, TOP + 1,
                                   pane > 0 ? pane - 2 : 0, l->rows};
}

/* Returns the columns of the list. */
static int text_cols(const struct list_window *l)
{
    return l->at.cols - 2 * LEFT - (l->pane.cols > 0 ? l->pane.cols + 2 : 0);
}

static void scroll(struct list_window *l, const struct list_row *rows,
                   int count)
{
    int all = line_of(l, rows, count, count);
    int first, last;

    l->selected = int_max(int_min(l->selected, count - 1), 0);
    last = line_of(l, rows, l->selected, count);
    first = last - (count > 0 && begins_group(l, rows, l->selected));
    l->top = int_min(l->top, first);
    l->top = int_max(l->top, last - l->rows + 1);
    l->top = int_max(int_min(l->top, all - l->rows), 0);
}

static void draw_row(const struct list_row *row, int at, int cols,
                     bool is_selected)
{
    int key_cols = int_min(KEY_COLS, cols);

    windows_text(WINDOW_OVER, at, LEFT, key_cols,
                 is_selected ? ROLE_SELECTED : ROLE_KEY, row->key);
    windows_text(WINDOW_OVER, at, LEFT + key_cols, cols - key_cols,
                 is_selected ? ROLE_SELECTED : ROLE_TEXT, row->text);
}

/* Draws a bar at the right of a long list, marked where the shown lines are. */
static void draw_bar(const struct list_window *l, int all)
{
    for (int i = 0; i < l->rows; i++) {
        int line = i * all / l->rows;
        bool is_marked =
            all > l->rows && line >= l->top && line < l->top + l->rows;

        windows_text(WINDOW_OVER, TOP + 1 + i, LEFT + text_cols(l), 1,
                     is_marked ? ROLE_SELECTED : ROLE_TEXT, "");
    }
}

void list_window_draw(struct list_window *l, struct screen *screen,
                      const struct list_row *rows, int count, int all)
{
    const struct key_hint hints[] = {{"Enter", l->does},
                                     {"Esc", "back"},
                                     {"type", "to search"},
                                     {NULL, NULL}};
    int cols = text_cols(l);
    int lines = line_of(l, rows, count, count);
    char text[LIST_SEARCH + 64];

    if (cols <= 0)
        return;
    scroll(l, rows, count);
    snprintf(text, sizeof text, l->search[0] != '\0' ? "%d of %d" : "%d", count,
             all);
    windows_text(WINDOW_OVER, TOP, LEFT, cols, ROLE_FAINT, "");
    windows_text(WINDOW_OVER, TOP, LEFT + cols - text_width_of(text),
                 text_width_of(text), ROLE_FAINT, text);
    snprintf(text, sizeof text, ": %s_", l->search);
    windows_text(WINDOW_OVER, TOP, LEFT, text_width_of(text), ROLE_TITLE, text);
    for (int i = 0; i < l->rows; i++) {
        struct line line = line_at(l, rows, count, l->top + i);

        if (line.row >= count)
            windows_text(WINDOW_OVER, TOP + 1 + i, LEFT, cols, ROLE_FAINT,
                         count == 0 && i == 0 ? "nothing is called that" : "");
        else if (line.is_title)
            windows_text(WINDOW_OVER, TOP + 1 + i, LEFT, cols, ROLE_TITLE,
                         rows[line.row].group);
        else
            draw_row(&rows[line.row], TOP + 1 + i, cols,
                     line.row == l->selected);
    }
    draw_bar(l, lines);
    key_hints_draw(WINDOW_OVER, TOP + l->rows + OTHER_ROWS - 1, LEFT, cols,
                   hints);
    screen->must_update = true;
}

static void paint(const struct frame *picture, const struct screen *screen,
                  const struct window_rect *pane)
{
    const struct term_caps *d = &screen->display;
    struct tty_size size = term_size();
    struct cells_rect fit =
        cells_fit(picture->width, picture->height, pane->cols, pane->rows,
                  term_caps_cell_aspect(d, &size));
    struct glyph_grid grid = glyphs_grid(d->glyphs);
    struct frame frame = {.rgb = NULL};
    struct cells cells = {.cell = NULL};
    struct error ignored;

    if (frame_init(&frame, fit.cols * grid.across, fit.rows * grid.down,
                   &ignored) &&
        cells_init(&cells, fit.cols, fit.rows, &ignored)) {
        frame_scale(picture, &frame);
        cells_from_frame(&cells, &frame, d->palette, d->glyphs);
        for (int row = 0; row < fit.rows; row++)
            windows_paint(WINDOW_OVER, pane->row + row, pane->col + fit.col,
                          cells.cell + (size_t)row * (size_t)fit.cols,
                          fit.cols);
    }
    cells_free(&cells);
    frame_free(&frame);
}

void list_window_picture(const struct list_window *l,
                         const struct screen *screen,
                         const struct frame *picture)
{
    const struct window_rect *pane = &l->pane;

    for (int row = 0; row < pane->rows && pane->cols > 0; row++)
        windows_text(WINDOW_OVER, pane->row + row, pane->col, pane->cols,
                     ROLE_TEXT, "");
    if (pane->cols > 0 && picture != NULL)
        paint(picture, screen, pane);
}

static enum list_result leave(struct list_window *l, enum list_result result)
{
    l->is_open = false;
    return result;
}

static void search(struct list_window *l, size_t length, int key)
{
    l->search[length] = (char)key;
    if (key != '\0')
        l->search[length + 1] = '\0';
    l->selected = l->top = 0;
}

enum list_result list_window_key(struct list_window *l, int key, int count)
{
    size_t length = strlen(l->search);

    switch (key) {
    case ESCAPE:
        if (length == 0)
            return leave(l, LIST_CANCELLED);
        search(l, 0, '\0');
        break;
    case '\r':
        if (count > 0)
            return leave(l, LIST_CHOSEN);
        break;
    case TTY_KEY_UP: l->selected--; break;
    case TTY_KEY_DOWN: l->selected++; break;
    case TTY_KEY_PAGE_UP: l->selected -= PAGE_ROWS; break;
    case TTY_KEY_PAGE_DOWN: l->selected += PAGE_ROWS; break;
    case TTY_KEY_HOME: l->selected = 0; break;
    case TTY_KEY_END: l->selected = count - 1; break;
    case '\b':
    case BACKSPACE:
        if (length > 0)
            search(l, length - 1, '\0');
        break;
    default:
        if (key >= ' ' && key < BACKSPACE && length + 1 < LIST_SEARCH)
            search(l, length, key);
    }
    l->selected = int_max(int_min(l->selected, count - 1), 0);
    return LIST_STAYS;
}

static enum list_result take_mouse(struct list_window *l,
                                   const struct event *event,
                                   const struct list_row *rows, int count)
{
    int col = event->x - 1 - l->at.col, row = event->y - 1 - l->at.row;
    struct line line = line_at(l, rows, count, l->top + row - TOP - 1);

    if (event->mouse == MOUSE_WHEEL_UP)
        l->selected = int_max(l->selected - WHEEL, 0);
    if (event->mouse == MOUSE_WHEEL_DOWN)
        l->selected = int_min(l->selected + WHEEL, count - 1);
    if (event->mouse != MOUSE_PRESS)
        return LIST_STAYS;
    if (col < 0 || row < 0 || col >= l->at.cols || row >= l->at.rows)
        return leave(l, LIST_CANCELLED);
    if (row <= TOP || row > TOP + l->rows || line.is_title || line.row >= count)
        return LIST_STAYS;
    l->selected = line.row;
    return leave(l, LIST_CHOSEN);
}

enum list_result list_window_take(struct list_window *l,
                                  const struct event *event,
                                  const struct list_row *rows, int count)
{
    return event->kind == EVENT_KEY ? list_window_key(l, event->key, count)
                                    : take_mouse(l, event, rows, count);
}
