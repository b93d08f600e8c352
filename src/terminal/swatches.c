// SPDX-License-Identifier: MIT
#include "terminal/swatches.h"

#include <stdlib.h>
#include <string.h>

#include "terminal/xmalloc.h"

#include "kernels/tone.h"

bool swatches_init(struct swatches *s, int rows, struct error *err)
{
    *s = (struct swatches){.is_there = NULL};
    s->is_there = xcalloc((size_t)rows, sizeof *s->is_there);
    if (frame_init(&s->frame, SWATCH_COLS, rows, err) &&
        cells_init(&s->cells, SWATCH_COLS, rows, err) &&
        ansi_diff_init(&s->ansi, SWATCH_COLS, rows, err))
        return true;
    swatches_free(s);
    return false;
}

void swatches_free(struct swatches *s)
{
    frame_free(&s->frame);
    cells_free(&s->cells);
    ansi_diff_free(&s->ansi);
    free(s->is_there);
    *s = (struct swatches){.is_there = NULL};
}

void swatches_clear(struct swatches *s)
{
    memset(s->is_there, 0, (size_t)s->cells.rows * sizeof *s->is_there);
}

void swatches_set(struct swatches *s, int row, const double rgb[3])
{
    size_t first = (size_t)row * SWATCH_COLS;

    for (size_t i = 0; i < SWATCH_COLS; i++)
        for (size_t c = 0; c < 3; c++)
            s->frame.rgb[3 * (first + i) + c] =
                (uint8_t)srgb_byte((float)rgb[c]);
    s->is_there[row] = true;
}

/* Finds the runs of rows without a colour. Returns their number. */
static int find_gaps(const struct swatches *s, struct ansi_diff_rect *gaps)
{
    int count = 0;

    for (int y = 0; y < s->cells.rows; y++) {
        if (s->is_there[y])
            continue;
        if (y > 0 && !s->is_there[y - 1])
            gaps[count - 1].rows++;
        else
            gaps[count++] = (struct ansi_diff_rect){0, y, SWATCH_COLS, 1};
    }
    return count;
}

void swatches_draw(struct swatches *s, enum palette palette, int col, int row,
                   const struct ansi_diff_rect *window, int end_row)
{
    struct ansi_diff_rect *covered =
        xcalloc((size_t)s->cells.rows + 1, sizeof *covered);
    int count = find_gaps(s, covered);
    struct ansi_diff_draw how = {.col = col,
                                 .row = row,
                                 .budget_bytes = SIZE_MAX,
                                 .covered = covered,
                                 .covered_count = count + 1};

    covered[count] =
        (struct ansi_diff_rect){window->col - col, window->row - row,
                                window->cols, window->rows};
    ansi_diff_begin(&s->ansi);
    ansi_diff_invalidate_all(&s->ansi);
    cells_from_frame(&s->cells, &s->frame, palette, GLYPHS_SPACE);
    ansi_diff_picture(&s->ansi, &s->cells, &how);
    ansi_diff_end(&s->ansi, end_row);
    free(covered);
}
