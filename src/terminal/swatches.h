// SPDX-License-Identifier: MIT
/*
 * swatches.h - colours beside the lines of a panel, two cells each
 *
 * Units:     terminal cells; linear Rec.709
 * Ownership: swatches_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_SWATCHES_H
#define GLIM_SWATCHES_H

#include <stdbool.h>

#include "terminal/ansi_diff.h"

#define SWATCH_COLS 2

struct swatches {
    struct frame frame;
    struct cells cells;
    struct ansi_diff ansi;
    bool *is_there; /* one a row */
};

bool swatches_init(struct swatches *s, int rows, struct error *err);
void swatches_free(struct swatches *s);

/* No row has one. */
void swatches_clear(struct swatches *s);

/* Channels beyond 1 are shown as 1. */
void swatches_set(struct swatches *s, int row, const double rgb[3]);

/* All of them but for what a window of the screen covers, as what a terminal is
 * sent, with the upper left cell at (col, row) of the screen and the cursor in
 * end_row at the end: s->ansi.bytes, s->ansi.length. */
void swatches_draw(struct swatches *s, enum palette palette, int col, int row,
                   const struct ansi_diff_rect *window, int end_row);

#endif
