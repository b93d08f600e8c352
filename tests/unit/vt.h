// SPDX-License-Identifier: MIT
/*
 * vt.h - a terminal for tests: bytes become a grid of cells
 *
 * It implements the sequences of ECMA-48, DEC and xterm that glim and curses
 * send, and answers questions. Sequences that would move or remove cells on the
 * screen are executed and noted in `moved`.
 *
 * Units:     cells, row 0 at the top
 * Ownership: the grid is part of the struct
 * Threads:   one per terminal
 * Errors:    an unknown sequence is noted in `unknown`
 */
#ifndef TESTS_VT_H
#define TESTS_VT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <wchar.h>

#include "terminal/cells.h"

#define VT_COLS_MAX 200
#define VT_ROWS_MAX 80

/* Glyph in the right half of a wide character. */
#define VT_TAIL 0x110000u

#define VT_PARAMS_MAX   16
#define VT_TEXT_MAX     256
#define VT_ANSWERS_MAX  256
#define VT_SEQUENCE_MAX 64
#define VT_COMBINED_MAX 3

/* Bit n is SGR n: bold 1, dim 2, reverse 7. */
#define VT_BOLD    (1u << 1)
#define VT_DIM     (1u << 2)
#define VT_REVERSE (1u << 7)

struct vt_cell {
    uint32_t fg, bg; /* as in struct cell */
    uint32_t glyph;  /* 0: nothing was written here yet */
    uint32_t combined[VT_COMBINED_MAX];
    unsigned attributes;
};

enum vt_state { VT_GROUND, VT_ESCAPE, VT_CSI, VT_STRING, VT_STRING_END };

struct vt {
    int cols, rows;
    struct vt_cell cell[VT_ROWS_MAX][VT_COLS_MAX];
    int row, col;
    bool is_pending; /* the last column is written, and the next character wraps
                      */
    bool wraps_at_once; /* the terminal wraps without waiting for the next
                           character */
    int top, bottom;    /* scroll region */
    struct vt_cell pen;
    struct vt_cell *last; /* last printed cell */
    bool inserts;
    bool is_line[2]; /* G0 and G1 are line drawing */
    int shift;       /* the set in use */
    /* state of the parser */
    enum vt_state state;
    char text[VT_TEXT_MAX];
    size_t length;
    uint32_t point; /* UTF-8 character so far */
    int more;
    char last_string[VT_TEXT_MAX]; /* OSC, DCS or APC; begins with its kind */
    unsigned string_count;
    char answers[VT_ANSWERS_MAX]; /* for the program; the reader empties it */
    size_t answer_length;
    char moved[VT_SEQUENCE_MAX];   /* first sequence that moved cells, or "" */
    char unknown[VT_SEQUENCE_MAX]; /* first unknown sequence, or "" */
    bool seen[128];                /* final bytes of control sequences */
};

static inline void vt_open(struct vt *t, int cols, int rows)
{
    memset(t, 0, sizeof *t);
    t->cols = cols;
    t->rows = rows;
    t->bottom = rows - 1;
    t->pen.fg = t->pen.bg = CELL_DEFAULT;
    for (int y = 0; y < VT_ROWS_MAX; y++)
        for (int x = 0; x < VT_COLS_MAX; x++)
            t->cell[y][x].fg = t->cell[y][x].bg = CELL_DEFAULT;
}

static inline void vt_note(const struct vt *t, char note[VT_SEQUENCE_MAX])
{
    if (note[0] == '\0')
        snprintf(note, VT_SEQUENCE_MAX, "%.*s", (int)t->length, t->text);
}

/* The background is the current one (bce); attributes are not kept. */
static inline void vt_erase(struct vt *t, int y, int x, int end)
{
    for (; x < end; x++)
        t->cell[y][x] =
            (struct vt_cell){.fg = CELL_DEFAULT, .bg = t->pen.bg, .glyph = ' '};
}

static inline void vt_erase_rows(struct vt *t, int y, int end)
{
    for (; y < end; y++)
        vt_erase(t, y, 0, t->cols);
}

/* Cells of the window keep their distance from the upper left corner. */
static inline void vt_resize(struct vt *t, int cols, int rows)
{
    struct vt_cell pen = t->pen;

    t->pen.bg = CELL_DEFAULT;
    for (int y = 0; y < rows; y++)
        if (y >= t->rows)
            vt_erase(t, y, 0, cols);
        else if (cols > t->cols)
            vt_erase(t, y, t->cols, cols);
    t->pen = pen;
    t->cols = cols;
    t->rows = rows;
    t->top = 0;
    t->bottom = rows - 1;
    t->row = t->row < rows ? t->row : rows - 1;
    t->col = t->col < cols ? t->col : cols - 1;
    t->is_pending = false;
}

/* Moves rows [top, bottom] up by n, or down by -n. */
static inline void vt_scroll(struct vt *t, int top, int bottom, int n)
{
    vt_note(t, t->moved);
    for (int i = 0; i <= bottom - top; i++) {
        int y = n > 0 ? top + i : bottom - i;
        int from = y + n;

        if (from >= top && from <= bottom)
            memcpy(t->cell[y], t->cell[from], sizeof t->cell[y]);
        else
            vt_erase(t, y, 0, t->cols);
    }
}

/* Moves the cells from the cursor on to the left by n, or to the right by
 * -n. */
static inline void vt_shift(struct vt *t, int n)
{
    struct vt_cell *row = t->cell[t->row];

    vt_note(t, t->moved);
    for (int i = 0; i < t->cols - t->col; i++) {
        int x = n > 0 ? t->col + i : t->cols - 1 - i;
        int from = x + n;

        if (from >= t->col && from < t->cols)
            row[x] = row[from];
        else
            vt_erase(t, t->row, x, x + 1);
    }
}

static inline void vt_line_feed(struct vt *t)
{
    t->is_pending = false;
    if (t->row == t->bottom)
        vt_scroll(t, t->top, t->bottom, 1);
    else if (t->row < t->rows - 1)
        t->row++;
}

static inline void vt_wrap(struct vt *t)
{
    t->col = 0;
    vt_line_feed(t);
}

static inline uint32_t vt_line_drawing(uint32_t c)
{
    switch (c) {
    case 'j': return 0x2518;
    case 'k': return 0x2510;
    case 'l': return 0x250c;
    case 'm': return 0x2514;
    case 'q': return 0x2500;
    case 'x': return 0x2502;
    default: return c;
    }
}

/* Overwriting half of a wide character erases the other half. */
static inline void vt_break_wide(struct vt *t, int x)
{
    struct vt_cell *row = t->cell[t->row];

    if (row[x].glyph == VT_TAIL && x > 0)
        row[x - 1].glyph = ' ';
    if (x + 1 < t->cols && row[x + 1].glyph == VT_TAIL)
        row[x + 1].glyph = ' ';
}

static inline void vt_combine(struct vt *t, uint32_t c)
{
    for (int i = 0; t->last && i < VT_COMBINED_MAX; i++) {
        if (t->last->combined[i] == 0) {
            t->last->combined[i] = c;
            return;
        }
    }
}

static inline void vt_print(struct vt *t, uint32_t c)
{
    int width = c < 128 ? 1 : wcwidth((wchar_t)c);

    if (width == 0) {
        vt_combine(t, c);
        return;
    }
    width = width < 0 ? 1 : width;
    if (t->is_pending || t->col + width > t->cols)
        vt_wrap(t);
    t->is_pending = false;
    if (t->inserts)
        vt_shift(t, -width);
    t->last = &t->cell[t->row][t->col];
    for (int i = 0; i < width && t->col < t->cols; i++) {
        vt_break_wide(t, t->col);
        t->cell[t->row][t->col] = t->pen;
        t->cell[t->row][t->col++].glyph = i > 0 ? VT_TAIL
                                          : t->is_line[t->shift]
                                              ? vt_line_drawing(c)
                                              : c;
    }
    if (t->col < t->cols)
        return;
    t->col = t->cols - 1;
    t->is_pending = !t->wraps_at_once;
    if (t->wraps_at_once)
        vt_wrap(t);
}

static inline void vt_answer(struct vt *t, const char *text)
{
    size_t room = sizeof t->answers - t->answer_length;
    int length = snprintf(t->answers + t->answer_length, room, "%s", text);

    t->answer_length += (size_t)length < room ? (size_t)length : 0;
}

static inline uint32_t vt_color(const int *p, int count, int *used)
{
    if (count >= 5 && p[1] == 2) {
        *used = 5;
        return (uint32_t)(p[2] << 16 | p[3] << 8 | p[4]);
    }
    *used = 3;
    return count >= 3 && p[1] == 5 ? (uint32_t)p[2] : CELL_DEFAULT;
}

static inline void vt_sgr(struct vt *t, const int *p, int count)
{
    for (int i = 0, used; i < count; i += used) {
        int n = p[i];

        used = 1;
        if (n == 0)
            t->pen = (struct vt_cell){.fg = CELL_DEFAULT, .bg = CELL_DEFAULT};
        else if (n < 10)
            t->pen.attributes |= 1u << n;
        else if (n == 10 || n == 11)
            t->is_line[0] = n == 11;
        else if (n == 22)
            t->pen.attributes &= ~(VT_BOLD | VT_DIM);
        else if (n > 20 && n < 30)
            t->pen.attributes &= ~(1u << (n - 20));
        else if (n == 38)
            t->pen.fg = vt_color(p + i, count - i, &used);
        else if (n == 48)
            t->pen.bg = vt_color(p + i, count - i, &used);
        else if (n == 39)
            t->pen.fg = CELL_DEFAULT;
        else if (n == 49)
            t->pen.bg = CELL_DEFAULT;
        else if (n >= 30 && n < 40)
            t->pen.fg = (uint32_t)n - 30;
        else if (n >= 40 && n < 50)
            t->pen.bg = (uint32_t)n - 40;
        else if (n >= 90 && n < 98)
            t->pen.fg = (uint32_t)n - 82;
        else if (n >= 100 && n < 108)
            t->pen.bg = (uint32_t)n - 92;
        else
            vt_note(t, t->unknown);
    }
}

static inline int vt_clamp(int n, int max)
{
    return n < 0 ? 0 : n > max ? max : n;
}

static inline void vt_jump(struct vt *t, int row, int col)
{
    t->row = vt_clamp(row, t->rows - 1);
    t->col = vt_clamp(col, t->cols - 1);
    t->is_pending = false;
}

static inline void vt_erase_display(struct vt *t, int kind)
{
    if (kind == 0) {
        vt_erase(t, t->row, t->col, t->cols);
        vt_erase_rows(t, t->row + 1, t->rows);
    } else if (kind == 1) {
        vt_erase_rows(t, 0, t->row);
        vt_erase(t, t->row, 0, t->col + 1);
    } else {
        vt_erase_rows(t, 0, t->rows);
    }
}

static inline void vt_erase_line(struct vt *t, int kind)
{
    vt_erase(t, t->row, kind == 0 ? t->col : 0,
             kind == 1 ? t->col + 1 : t->cols);
}

/* A region that is the whole screen moves nothing. */
static inline void vt_set_region(struct vt *t, const int *p, int count)
{
    t->top = p[0] > 0 ? p[0] - 1 : 0;
    t->bottom =
        vt_clamp(count > 1 && p[1] > 0 ? p[1] - 1 : t->rows - 1, t->rows - 1);
    if (t->top != 0 || t->bottom != t->rows - 1)
        vt_note(t, t->moved);
    vt_jump(t, 0, 0);
}

static inline void vt_report(struct vt *t, int what)
{
    char text[32];

    if (what == 5)
        vt_answer(t, "\033[0n");
    if (what != 6)
        return;
    snprintf(text, sizeof text, "\033[%d;%dR", t->row + 1, t->col + 1);
    vt_answer(t, text);
}

static inline void vt_repeat(struct vt *t, int n)
{
    uint32_t c = t->last ? t->last->glyph : ' ';

    for (int i = 0; i < n; i++)
        vt_print(t, c);
}

static inline void vt_control(struct vt *t, char last)
{
    const char *p = t->text + 2;
    bool is_private = *p == '?' || *p == '>' || *p == '<' || *p == '=';
    int params[VT_PARAMS_MAX] = {0};
    int count = 1;

    t->seen[last & 127] = true;
    for (; *p != '\0'; p++) {
        if (*p == ';' && count < VT_PARAMS_MAX)
            count++;
        else if (*p >= '0' && *p <= '9')
            params[count - 1] = params[count - 1] * 10 + (*p - '0');
    }
    int n = params[0] > 0 ? params[0] : 1;
    if (is_private) {
        if (last == 'h' && params[0] == 1049)
            vt_erase_rows(t, 0, t->rows);
        return; /* modes, and questions that need no answer */
    }
    switch (last) {
    case 'm': vt_sgr(t, params, count); break;
    case 'H':
    case 'f': vt_jump(t, n - 1, count > 1 ? params[1] - 1 : 0); break;
    case 'A': vt_jump(t, t->row - n, t->col); break;
    case 'B': vt_jump(t, t->row + n, t->col); break;
    case 'C': vt_jump(t, t->row, t->col + n); break;
    case 'D': vt_jump(t, t->row, t->col - n); break;
    case 'G':
    case '`': vt_jump(t, t->row, n - 1); break;
    case 'd': vt_jump(t, n - 1, t->col); break;
    case 'J': vt_erase_display(t, params[0]); break;
    case 'K': vt_erase_line(t, params[0]); break;
    case 'X': vt_erase(t, t->row, t->col, vt_clamp(t->col + n, t->cols)); break;
    case 'b': vt_repeat(t, n); break;
    case 'r': vt_set_region(t, params, count); break;
    case 'S': vt_scroll(t, t->top, t->bottom, n); break;
    case 'T': vt_scroll(t, t->top, t->bottom, -n); break;
    case 'L': vt_scroll(t, t->row, t->bottom, -n); break;
    case 'M': vt_scroll(t, t->row, t->bottom, n); break;
    case 'P': vt_shift(t, n); break;
    case '@': vt_shift(t, -n); break;
    case 'h':
    case 'l':
        if (params[0] == 4)
            t->inserts = last == 'h';
        if (t->inserts)
            vt_note(t, t->moved);
        break;
    case 'n': vt_report(t, params[0]); break;
    case 'c': vt_answer(t, "\033[?62;22c"); break;
    case 'p': /* a mode or a size: no answer */
    case 't': break;
    default: vt_note(t, t->unknown);
    }
}

static inline void vt_end_string(struct vt *t)
{
    snprintf(t->last_string, sizeof t->last_string, "%s", t->text + 1);
    t->string_count++;
    t->state = VT_GROUND;
}

static inline void vt_take_escape(struct vt *t, char c)
{
    t->state = VT_GROUND;
    switch (c) {
    case '[': t->state = VT_CSI; return;
    case ']':
    case 'P':
    case '_': t->state = VT_STRING; return;
    case '(':
    case ')': t->state = VT_ESCAPE; return; /* one more byte */
    case 'D': vt_line_feed(t); return;
    case 'E': vt_wrap(t); return;
    case 'M':
        if (t->row == t->top)
            vt_scroll(t, t->top, t->bottom, -1);
        else
            vt_jump(t, t->row - 1, t->col);
        return;
    case '=':
    case '>':
    case '\\': return;
    default: break;
    }
    if (t->length == 3 && (t->text[1] == '(' || t->text[1] == ')'))
        t->is_line[t->text[1] == ')'] = c == '0';
    else
        vt_note(t, t->unknown);
}

static inline void vt_take_control(struct vt *t, char c)
{
    switch (c) {
    case '\r': vt_jump(t, t->row, 0); break;
    case '\n': vt_line_feed(t); break;
    case '\b': vt_jump(t, t->row, t->col - 1); break;
    case '\t': vt_jump(t, t->row, (t->col / 8 + 1) * 8); break;
    case 14:
    case 15: t->shift = c == 14; break;
    case 27: t->state = VT_ESCAPE; break;
    default: break;
    }
}

static inline void vt_take_ground(struct vt *t, unsigned char c)
{
    if (t->more > 0 && (c & 0xc0) == 0x80) {
        t->point = t->point << 6 | (c & 0x3fu);
        if (--t->more == 0)
            vt_print(t, t->point);
        return;
    }
    t->more = 0;
    t->length = 1;
    t->text[0] = (char)c;
    t->text[1] = '\0';
    if (c < ' ') {
        vt_take_control(t, (char)c);
    } else if (c < 0x80) {
        vt_print(t, c);
    } else {
        t->more = c >= 0xf0 ? 3 : c >= 0xe0 ? 2 : 1;
        t->point = c & (0x3fu >> t->more);
    }
}

static inline void vt_take(struct vt *t, unsigned char c)
{
    if (t->state == VT_GROUND) {
        vt_take_ground(t, c);
        return;
    }
    if (t->state == VT_STRING && (c == 7 || c == 27)) {
        t->state = VT_STRING_END;
        if (c == 7)
            vt_end_string(t);
        return;
    }
    if (t->state == VT_STRING_END) {
        vt_end_string(t);
        return;
    }
    if (t->length + 1 < sizeof t->text)
        t->text[t->length++] = (char)c;
    t->text[t->length] = '\0';
    if (t->state == VT_ESCAPE) {
        vt_take_escape(t, (char)c);
    } else if (t->state == VT_CSI && c >= '@') {
        t->state = VT_GROUND;
        vt_control(t, (char)c);
    }
}

static inline void vt_write(struct vt *t, const char *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++)
        vt_take(t, (unsigned char)bytes[i]);
}

/* Returns the colours of the dots of a block, of both colours whichever is the
 * foreground. Returns false for other glyphs. */
static inline bool vt_dots(const struct cell *cell, uint32_t dots[GLYPH_DOTS])
{
    unsigned mask;

    if (!glyph_block_mask(cell->glyph, &mask))
        return false;
    for (int i = 0; i < GLYPH_DOTS; i++)
        dots[i] = mask >> i & 1 ? cell->fg : cell->bg;
    return true;
}

/* Returns whether the terminal's cell looks like the cell of the picture. */
static inline bool vt_shows(const struct vt_cell *got, const struct cell *want)
{
    struct cell is = {got->fg, got->bg, got->glyph};
    uint32_t dots[2][GLYPH_DOTS];

    if (got->attributes != 0 || got->combined[0] != 0)
        return false;
    /* The terminal's default colours, or a mark. */
    if (want->bg == CELL_DEFAULT || !vt_dots(want, dots[1]))
        return is.glyph == want->glyph && is.bg == want->bg &&
               (is.fg == want->fg || want->glyph == ' ');
    return vt_dots(&is, dots[0]) &&
           memcmp(dots[0], dots[1], sizeof dots[0]) == 0;
}

#endif
