// SPDX-License-Identifier: MIT
#include "terminal/curses_windows.h"

#include <assert.h>
#include <curses.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/print.h"
#include "base/text_stream.h"
#include "terminal/glyphs.h"
#include "terminal/theme.h"
#include "terminal/tty.h"
#include "terminal/xmalloc.h"

static WINDOW *window;
static WINDOW *panel;

/* Colours and attributes of each role. Curses keeps the role of a cell as its
 * colour pair; no pairs are defined, since curses writes no colours here. */
static struct text_style styles[ROLES];
static enum palette palette = PALETTE_MONO;

/* Cells as the terminal shows them, and cells that windows_paint() has put, by
 * their place on the screen. */
static struct {
    int cols, rows;
    struct window_cell *cell;
    struct cell *painted[WINDOW_PARTS];
    bool *is_touched; /* rows that windows_update() looks at */
    bool must_clear;
} shown;

/* Bytes of a column: a character and some that combine with it. */
#define COLUMN_BYTES 16

/* Attributes of curses that mark cells of the picture and painted cells. Text
 * never has them. */
#define SPARED  WA_LOW
#define PAINTED WA_RIGHT

static WINDOW *window_of(enum window_part part)
{
    switch (part) {
    case WINDOW_STATUS: return stdscr;
    case WINDOW_PANEL: return panel;
    case WINDOW_OVER: return window;
    case WINDOW_PARTS: break;
    }
    return NULL;
}

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

/* Returns the row of the window in which row `row` of the part is. */
static int window_row(enum window_part part, int row)
{
    return part == WINDOW_STATUS ? LINES - 1 + row : row;
}

static void touch_rows(int row, int count)
{
    for (int i = 0; i < count && row + i < shown.rows; i++)
        shown.is_touched[row + i] = true;
}

static void touch_window(const WINDOW *w)
{
    touch_rows(getbegy(w), getmaxy(w));
}

/* Moves the cursor of a part to a cell that is going to change. Returns NULL if
 * there is none. */
static WINDOW *window_at(enum window_part part, int row, int col)
{
    WINDOW *w = window_of(part);

    row = window_row(part, row);
    if (!w || wmove(w, row, col) == ERR)
        return NULL;
    touch_rows(getbegy(w) + row, 1);
    return w;
}

void windows_text(enum window_part part, int row, int col, int cols,
                  enum text_role role, const char *text)
{
    WINDOW *to = window_at(part, row, col);

    if (!to)
        return;
    if (cols > getmaxx(to) - col)
        cols = getmaxx(to) - col;
    wattr_set(to, A_NORMAL, (short)role, NULL);
    add_columns(to, text, cols);
    wattr_set(to, A_NORMAL, ROLE_OUTSIDE, NULL);
}

void windows_paint(enum window_part part, int row, int col,
                   const struct cell *cells, int count)
{
    WINDOW *to = window_at(part, row, col);
    cchar_t blank;

    if (!to)
        return;
    if (count > getmaxx(to) - col)
        count = getmaxx(to) - col;
    setcchar(&blank, L" ", PAINTED, 0, NULL);
    if (count <= 0 || whline_set(to, &blank, count) == ERR)
        return;
    memcpy(&shown.painted[part][(getcury(to) + getbegy(to)) * shown.cols + col +
                                getbegx(to)],
           cells, (size_t)count * sizeof *cells);
}

void windows_rule(enum window_part part, int row, int col, int cols)
{
    WINDOW *to = window_at(part, row, col);

    if (!to || cols <= 0)
        return;
    wattr_set(to, A_NORMAL, ROLE_FRAME, NULL);
    whline_set(to, NULL, cols);
    wattr_set(to, A_NORMAL, ROLE_OUTSIDE, NULL);
}

void windows_use_theme(enum theme theme, enum palette new_palette)
{
    palette = new_palette;
    for (int role = 0; role < ROLES; role++)
        styles[role] = theme_style(theme, palette, (enum text_role)role);
    touch_rows(0, shown.rows);
}

static void free_shown(void)
{
    free(shown.cell);
    free(shown.is_touched);
    for (int i = 0; i < WINDOW_PARTS; i++)
        free(shown.painted[i]);
    memset(&shown, 0, sizeof shown);
}

void windows_free(void)
{
    windows_close();
    windows_hide_panel();
    free_shown();
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

bool windows_reset(bool must_clear)
{
    size_t count = (size_t)LINES * (size_t)COLS;

    windows_close();
    windows_hide_panel();
    leave_to_picture(werase);
    touch_rows(0, shown.rows);
    if (!must_clear && shown.cols == COLS && shown.rows == LINES)
        return shown.must_clear;
    free_shown();
    shown.cell = xcalloc(count, sizeof *shown.cell);
    for (int i = 0; i < WINDOW_PARTS; i++)
        shown.painted[i] = xcalloc(count, sizeof *shown.painted[i]);
    shown.is_touched = xcalloc((size_t)LINES, sizeof *shown.is_touched);
    shown.cols = COLS;
    shown.rows = LINES;
    shown.must_clear = true;
    return true;
}

/* Columns that a text takes if there are `cols`. */
static int shown_columns(const char *text, int cols)
{
    int all = text_width_of(text);

    return all < cols ? all : cols;
}

void windows_hide_status(void)
{
    window_at(WINDOW_STATUS, 0, 0);
    leave_to_picture(wclrtoeol);
}

void windows_set(const char *const *texts, int text_count)
{
    int cols, rows;

    if (!window)
        return;
    getmaxyx(window, rows, cols);
    for (int i = 0; i < text_count && i < rows - 2; i++)
        windows_text(WINDOW_OVER, i + 1, 2, cols - 4, ROLE_TEXT, texts[i]);
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
    return r;
}

/* Fills a part with blanks in the colours of text. */
static void fill(enum window_part part)
{
    WINDOW *w = window_of(part);

    for (int row = 0; row < getmaxy(w); row++)
        windows_text(part, row, 0, getmaxx(w), ROLE_TEXT, "");
}

struct window_rect windows_open(enum window_place place, int foot_rows,
                                const char *title, const char *const *texts,
                                int text_count)
{
    struct window_rect r = window_size(title, texts, text_count);
    int rows = LINES - (place == WINDOW_BOTTOM_LEFT ? foot_rows : 1);

    r.rows = r.rows > rows ? rows : r.rows;

    if (place == WINDOW_MIDDLE) {
        r.col = (COLS - r.cols) / 2;
        r.row = (rows - r.rows) / 2;
    }
    if (place == WINDOW_BOTTOM_LEFT)
        r.row = rows - r.rows;
    window = newwin(r.rows, r.cols, r.row, r.col);
    if (!window)
        return (struct window_rect){0};
    fill(WINDOW_OVER);
    wattr_set(window, A_NORMAL, ROLE_FRAME, NULL);
    box_set(window, NULL, NULL);
    windows_text(WINDOW_OVER, 0, 2, shown_columns(title, r.cols - 4),
                 ROLE_TITLE, title);
    windows_set(texts, text_count);
    return r;
}

void windows_close(void)
{
    if (!window)
        return;
    touch_window(window);
    delwin(window);
    window = NULL;
}

void windows_open_panel(int cols)
{
    struct window_rect r = {COLS - cols, 0, cols, LINES - 1};

    if (!panel)
        panel = newwin(r.rows, r.cols, r.row, r.col);
    if (!panel)
        return;
    fill(WINDOW_PANEL);
    wattr_set(panel, A_NORMAL, ROLE_FRAME, NULL);
    mvwvline_set(panel, 0, 0, NULL, r.rows);
    wattr_set(panel, A_NORMAL, ROLE_OUTSIDE, NULL);
}

void windows_hide_panel(void)
{
    if (!panel)
        return;
    touch_window(panel);
    delwin(panel);
    panel = NULL;
}

void windows_notice(const char *text)
{
    int cols = text_width_of(text);

    touch_rows(0, shown.rows);
    erase();
    if (cols <= COLS)
        move((LINES - 1) / 2, (COLS - cols) / 2);
    else
        move(0, 0);
    add_columns(stdscr, text, shown_columns(text, LINES * COLS - 1));
}

/* ---- writing ---- */

/* A stream to the terminal with the cursor's cell and the style that is in
 * force there. */
struct writer {
    FILE *to;
    int row, col; /* of the cursor; row -1: unknown */
    struct text_style style;
};

const struct window_cell *windows_shown(int col, int row)
{
    assert(col < shown.cols && row < shown.rows);
    return &shown.cell[row * shown.cols + col];
}

/* True for a cell that is never written, since that would scroll the screen. */
static bool would_scroll(int col, int row)
{
    return tty_scrolls_at_end() && col == shown.cols - 1 &&
           row == shown.rows - 1;
}

void windows_set_shown(int col, int row, enum window_cell_kind kind)
{
    struct window_cell cell;

    memset(&cell, 0, sizeof cell); /* also the padding, which is compared */
    cell.kind = kind;
    if (!would_scroll(col, row))
        shown.cell[row * shown.cols + col] = cell;
    touch_rows(row, 1);
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

/* Returns what windows_paint() has put at a cell of a window. */
static struct window_cell painted_cell(const WINDOW *w, int col, int row)
{
    enum window_part part = w == window  ? WINDOW_OVER
                            : w == panel ? WINDOW_PANEL
                                         : WINDOW_STATUS;
    const struct cell *c = &shown.painted[part][row * shown.cols + col];
    struct window_cell cell;

    memset(&cell, 0, sizeof cell);
    cell.kind = WINDOW_CELL_PAINTED;
    cell.text[0] = (wchar_t)c->glyph;
    cell.style = (struct text_style){c->fg, c->bg, 0};
    return cell;
}

static struct text_style style_of(short role)
{
    struct text_style style = styles[role];
    attr_t available = term_attrs();

    if (!(available & A_BOLD))
        style.attributes &= ~(unsigned)TEXT_BOLD;
    if (!(available & A_DIM))
        style.attributes &= ~(unsigned)TEXT_DIM;
    return style;
}

static void look_at(int col, int row, struct window_cell *cell)
{
    WINDOW *w = owner_of(col, row);
    attr_t attributes = 0;
    short role = ROLE_OUTSIDE;
    cchar_t c;

    memset(cell, 0, sizeof *cell);
    mvwin_wch(w, row - getbegy(w), col - getbegx(w), &c);
    getcchar(&c, cell->text, &attributes, &role, NULL);
    cell->kind =
        attributes & A_ALTCHARSET ? WINDOW_CELL_LINE : WINDOW_CELL_TEXT;
    cell->style = style_of(role);
    if (attributes & SPARED)
        memset(cell, 0, sizeof *cell);
    else if (attributes & PAINTED)
        *cell = painted_cell(w, col, row);
    else if ((c.attr & A_CHARTEXT) > 1) /* curses' mark of a right half */
        *cell = (struct window_cell){.kind = WINDOW_CELL_TAIL};
    if (is_torn(w, cell, col, row))
        *cell = (struct window_cell){.kind = WINDOW_CELL_TEXT,
                                     .text = L" ",
                                     .style = style_of(role)};
}

/* Appends the parameters of a colour that changes. */
static char *change_color(char *end, uint32_t from, uint32_t to,
                          enum sgr_ground ground)
{
    if (from == to)
        return end;
    *end++ = ';';
    return sgr_color(end, to, palette, ground);
}

/* Writes what changes of the style. Attributes end only with a reset: not every
 * terminal can end them one by one. */
static void put_style(struct writer *w, const struct text_style *style)
{
    char text[2 * SGR_COLOR_BYTES + 16], *end = text;
    unsigned added = style->attributes & ~w->style.attributes;

    if (memcmp(style, &w->style, sizeof *style) == 0)
        return;
    if (w->style.attributes & ~style->attributes) {
        end = stpcpy(end, ";0");
        w->style = (struct text_style){CELL_DEFAULT, CELL_DEFAULT, 0};
        added = style->attributes;
    }
    end = stpcpy(end, added & TEXT_BOLD ? ";1" : "");
    end = stpcpy(end, added & TEXT_DIM ? ";2" : "");
    end = stpcpy(end, added & TEXT_REVERSE ? ";7" : "");
    end = change_color(end, w->style.fg, style->fg, SGR_FOREGROUND);
    end = change_color(end, w->style.bg, style->bg, SGR_BACKGROUND);
    *end = '\0';
    fprintf(w->to, "\033[%sm", text + 1); /* without the first semicolon */
    w->style = *style;
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

/* Writes a glyph of a picture, whatever the encoding of the locale is. */
static void put_glyph(struct writer *w, uint32_t glyph)
{
    char bytes[4];

    fwrite(bytes, 1, (size_t)glyph_utf8(glyph, bytes), w->to);
}

static void put_cell(struct writer *w, const struct window_cell *cell, int col,
                     int row)
{
    static const struct text_style plain = {CELL_DEFAULT, CELL_DEFAULT, 0};

    if (w->row != row)
        fprintf(w->to, "\033[%d;%dH", row + 1, col + 1);
    else if (w->col != col)
        fprintf(w->to, "\033[%dC", col - w->col);
    put_style(w, cell->kind == WINDOW_CELL_SPARED ? &plain : &cell->style);
    if (cell->kind == WINDOW_CELL_SPARED)
        fputc(' ', w->to);
    else if (cell->kind == WINDOW_CELL_PAINTED)
        put_glyph(w, (uint32_t)cell->text[0]);
    else if (cell->kind == WINDOW_CELL_LINE)
        put_line(w, cell->text[0]);
    else
        fprintf(w->to, "%ls", cell->text);
    /* terminals disagree about the width of other characters */
    w->row = cell->kind == WINDOW_CELL_PAINTED ||
                     cell->kind == WINDOW_CELL_SPARED ||
                     (wcwidth(cell->text[0]) == 1 && cell->text[1] == L'\0')
                 ? row
                 : -1;
    w->col = col + 1;
}

static void update_cell(struct writer *w, int col, int row)
{
    struct window_cell *was = &shown.cell[row * shown.cols + col];
    struct window_cell now;

    look_at(col, row, &now);
    if (memcmp(was, &now, sizeof now) == 0 || would_scroll(col, row))
        return;
    *was = now;
    if (now.kind != WINDOW_CELL_TAIL)
        put_cell(w, &now, col, row);
}

/* Curses' doupdate() would destroy the picture, which it does not know: to save
 * bytes it scrolls, erases to the end of a line, and writes blanks instead of
 * moving the cursor. */
size_t windows_update(void)
{
    char *bytes;
    size_t size_bytes;
    struct text_stream s;
    struct writer w = {.row = -1, .style = {CELL_DEFAULT, CELL_DEFAULT, 0}};

    if (!text_stream_open(&s))
        return 0;
    w.to = s.to;
    if (shown.must_clear)
        fputs("\033[m\033[H\033[J", w.to);
    shown.must_clear = false;
    for (int row = 0; row < shown.rows; row++) {
        for (int col = 0; shown.is_touched[row] && col < shown.cols; col++)
            update_cell(&w, col, row);
        shown.is_touched[row] = false;
    }
    fflush(s.to);
    if (s.size_bytes > 0)
        fprintf(s.to, "\033[m\033[%d;1H", shown.rows);
    bytes = xchecked(text_stream_close(&s, &size_bytes));
    tty_write(bytes, size_bytes);
    free(bytes);
    return size_bytes;
}
