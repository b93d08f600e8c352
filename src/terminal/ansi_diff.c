// SPDX-License-Identifier: MIT
#include "terminal/ansi_diff.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "terminal/theme.h"

/* ---- differences ---- */

/* Most bytes of a cell: a jump of 10, two 24-bit colours of 38 together, a
 * glyph of 4. */
#define CELL_BYTES_MAX 56

bool ansi_diff_init(struct ansi_diff *a, int cols, int rows, struct error *err)
{
    size_t count = (size_t)cols * (size_t)rows;

    assert(cols > 0 && rows > 0);
    *a = (struct ansi_diff){.cols = cols, .rows = rows};
    a->capacity = count * CELL_BYTES_MAX + ANSI_DIFF_TEXT_MAX;
    a->shown = alloc_array(count, sizeof a->shown[0]);
    a->bytes = alloc_array(a->capacity, 1);
    if (!a->shown || !a->bytes) {
        ansi_diff_free(a);
        return fail(err, "out of memory for a window of %dx%d cells", cols,
                    rows);
    }
    return true;
}

void ansi_diff_free(struct ansi_diff *a)
{
    free(a->shown);
    free(a->bytes);
    *a = (struct ansi_diff){0};
}

void ansi_diff_invalidate(struct ansi_diff *a, struct ansi_diff_rect rect)
{
    for (int y = rect.row; y < rect.row + rect.rows; y++) {
        for (int x = rect.col; x < rect.col + rect.cols; x++) {
            if (x >= 0 && x < a->cols && y >= 0 && y < a->rows)
                ansi_diff_shown(a, x, y)->glyph = 0;
        }
    }
}

void ansi_diff_invalidate_all(struct ansi_diff *a)
{
    ansi_diff_invalidate(a, (struct ansi_diff_rect){0, 0, a->cols, a->rows});
}

struct cell *ansi_diff_shown(const struct ansi_diff *a, int col, int row)
{
    return &a->shown[(size_t)row * (size_t)a->cols + (size_t)col];
}

void ansi_diff_begin(struct ansi_diff *a)
{
    a->length = 0;
    a->fg = CELL_DEFAULT;
    a->bg = CELL_DEFAULT;
}

bool ansi_diff_reserve(struct ansi_diff *a, size_t size_bytes)
{
    size_t needed = a->length + size_bytes + ANSI_DIFF_TEXT_MAX;
    void *bytes = a->bytes;
    bool ok = grow_array(&bytes, &a->capacity, needed, 1);

    a->bytes = bytes;
    return ok;
}

static void put(struct ansi_diff *a, const char *text, size_t length)
{
    assert(a->length + length <= a->capacity);
    memcpy(a->bytes + a->length, text, length);
    a->length += length;
}

void ansi_diff_text(struct ansi_diff *a, const char *text)
{
    put(a, text, strlen(text));
}

static void put_char(struct ansi_diff *a, char c)
{
    a->bytes[a->length++] = c;
}

static void put_number(struct ansi_diff *a, uint32_t n)
{
    a->length = (size_t)(sgr_number(a->bytes + a->length, n) - a->bytes);
}

static void put_color(struct ansi_diff *a, uint32_t color, enum palette palette,
                      enum sgr_ground ground)
{
    char *end = sgr_color(a->bytes + a->length, color, palette, ground);

    a->length = (size_t)(end - a->bytes);
}

/* Returns true if the foreground must be set. Blanks show none. */
static bool needs_fg(const struct ansi_diff *a, const struct cell *cell)
{
    return cell->glyph != ' ' && cell->fg != a->fg;
}

static bool needs_bg(const struct ansi_diff *a, const struct cell *cell)
{
    return cell->bg != a->bg;
}

/* Writes one escape sequence for the colours that change. */
static void put_colors(struct ansi_diff *a, const struct cell *cell,
                       enum palette palette)
{
    bool new_fg = needs_fg(a, cell);
    bool new_bg = needs_bg(a, cell);

    if (!new_fg && !new_bg)
        return;
    put(a, "\033[", 2);
    if (new_fg) {
        put_color(a, cell->fg, palette, SGR_FOREGROUND);
        a->fg = cell->fg;
    }
    if (new_fg && new_bg)
        put_char(a, ';');
    if (new_bg) {
        put_color(a, cell->bg, palette, SGR_BACKGROUND);
        a->bg = cell->bg;
    }
    put_char(a, 'm');
}

static void put_cell(struct ansi_diff *a, const struct cells *cells,
                     const struct cell *cell)
{
    char bytes[4];

    put_colors(a, cell, cells->palette);
    put(a, bytes, (size_t)glyph_utf8(cell->glyph, bytes));
}

void ansi_diff_jump(struct ansi_diff *a, int row, int col)
{
    put(a, "\033[", 2);
    put_number(a, (uint32_t)row + 1);
    put_char(a, ';');
    put_number(a, (uint32_t)col + 1);
    put_char(a, 'H');
}

/* Moves the cursor. `from` is its column in this row, -1 if it is elsewhere. */
static void put_jump(struct ansi_diff *a, int row, int col, int from)
{
    if (from == col)
        return;
    if (from < 0) {
        ansi_diff_jump(a, row, col);
        return;
    }
    put(a, "\033[", 2);
    if (col - from > 1)
        put_number(a, (uint32_t)(col - from));
    put_char(a, 'C');
}

static bool channels_close(uint32_t a, uint32_t b, int step)
{
    for (int shift = 0; shift < 24; shift += 8) {
        if (abs((int)(a >> shift & 255) - (int)(b >> shift & 255)) > step)
            return false;
    }
    return true;
}

/* Returns true if the channels of all dots differ by at most `step`. */
static bool dots_close(const struct cell *a, const struct cell *b, int step)
{
    unsigned masks[2];

    if (a->bg == CELL_DEFAULT || b->bg == CELL_DEFAULT ||
        !glyph_block_mask(a->glyph, &masks[0]) ||
        !glyph_block_mask(b->glyph, &masks[1]))
        return false;
    for (int i = 0; i < GLYPH_DOTS; i++) {
        if (!channels_close(masks[0] >> i & 1 ? a->fg : a->bg,
                            masks[1] >> i & 1 ? b->fg : b->bg, step))
            return false;
    }
    return true;
}

static bool may_stay(const struct cell *shown, const struct cell *cell,
                     int step)
{
    if (shown->glyph == cell->glyph && shown->bg == cell->bg &&
        (shown->fg == cell->fg || cell->glyph == ' '))
        return true;
    return step > 0 && dots_close(shown, cell, step);
}

int ansi_diff_uncovered(const struct ansi_diff_draw *how, int col, int row)
{
    for (int i = 0; i < how->covered_count; i++) {
        const struct ansi_diff_rect *r = &how->covered[i];

        if (row >= r->row && row < r->row + r->rows && col >= r->col &&
            col < r->col + r->cols) {
            col = r->col + r->cols;
            i = -1; /* the next window may begin there */
        }
    }
    return col;
}

/* Writes the cells that differ in columns [begin, end) of a row within the
 * budget. Returns the column where it stopped, or `end`. */
static int put_row(struct ansi_diff *a, const struct cells *cells, int row,
                   int begin, int end, const struct ansi_diff_draw *how)
{
    const struct cell *made = &cells->cell[(size_t)row * (size_t)cells->cols];
    int step = cells->palette == PALETTE_24BIT ? how->step : 0;
    int from = -1;

    for (int col = ansi_diff_uncovered(how, begin, row); col < end;
         col = ansi_diff_uncovered(how, col + 1, row)) {
        const struct cell *cell = &made[col];
        struct cell *shown = ansi_diff_shown(a, how->col + col, how->row + row);

        if (may_stay(shown, cell, step))
            continue;
        if (a->length - a->begun >= how->budget_bytes)
            return col;
        put_jump(a, how->row + row, how->col + col,
                 from < 0 ? -1 : how->col + from);
        put_cell(a, cells, cell);
        *shown = *cell;
        from = col + 1;
    }
    return end;
}

/* Ends a frame. The next one begins at this cell. */
static bool stop_at(struct ansi_diff *a, int row, int col)
{
    a->next_row = row;
    a->next_col = col;
    return false;
}

bool ansi_diff_picture(struct ansi_diff *a, struct cells *cells,
                       const struct ansi_diff_draw *how)
{
    int start_row = a->next_row;
    int start_col = a->next_col;

    assert(how->col >= 0 && how->col + cells->cols <= a->cols);
    assert(how->row >= 0 && how->row + cells->rows <= a->rows);
    a->begun = a->length;
    if (cells->palette != a->palette) /* colours have another meaning now */
        ansi_diff_invalidate_all(a);
    a->palette = cells->palette;
    /* The first row comes twice: its right part first, its left part last. */
    for (int i = 0; i <= cells->rows; i++) {
        int row = (start_row + i) % cells->rows;
        int begin = i == 0 ? start_col : 0;
        int end = i == cells->rows ? start_col : cells->cols;
        int stop;

        if (i > 0 && cells->frame && frame_is_cancelled(cells->frame))
            return stop_at(a, row, begin);
        cells_row(cells, row);
        stop = put_row(a, cells, row, begin, end, how);
        if (stop < end)
            return stop_at(a, row, stop);
    }
    a->next_row = 0;
    a->next_col = 0;
    return true;
}

void ansi_diff_end(struct ansi_diff *a, int row)
{
    ansi_diff_text(a, "\033[m");
    ansi_diff_jump(a, row, 0);
    a->fg = CELL_DEFAULT;
    a->bg = CELL_DEFAULT;
}

bool ansi_diff_lines(const struct cells *cells, char **text, size_t *size_bytes,
                     struct error *err)
{
    struct ansi_diff a;

    if (!ansi_diff_init(&a, cells->cols, cells->rows, err))
        return false;
    for (int row = 0; row < cells->rows; row++) {
        a.fg = CELL_DEFAULT;
        a.bg = CELL_DEFAULT;
        for (int col = 0; col < cells->cols; col++)
            put_cell(&a, cells, &cells->cell[row * cells->cols + col]);
        if (a.fg != CELL_DEFAULT || a.bg != CELL_DEFAULT)
            put(&a, "\033[m", 3);
        put_char(&a, '\n');
    }
    *text = a.bytes;
    *size_bytes = a.length;
    a.bytes = NULL; /* the caller owns it now */
    ansi_diff_free(&a);
    return true;
}

/* ---- text ---- */

bool ansi_text_frame_init(struct frame *frame,
                          const struct ansi_text_style *style,
                          struct error *err)
{
    struct glyph_grid grid = glyphs_grid(style->glyphs);

    return frame_init(frame, grid.across * style->cols, grid.down * style->rows,
                      err);
}

bool ansi_text_of_frame(const struct frame *frame,
                        const struct ansi_text_style *style, char **text,
                        size_t *size_bytes, struct error *err)
{
    struct cells cells = {0};
    bool ok = cells_init(&cells, style->cols, style->rows, err);

    if (ok) {
        cells_from_frame(&cells, frame, style->palette, style->glyphs);
        ok = ansi_diff_lines(&cells, text, size_bytes, err);
    }
    cells_free(&cells);
    return ok;
}
