// SPDX-License-Identifier: MIT
/*
 * swatches.h - colour samples beside the lines of a panel, two cells each
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
    bool *is_there; /* for each row */
};

bool swatches_init(struct swatches *s, int rows, struct error *err);
void swatches_free(struct swatches *s);

/* Removes the colours of all rows. */
void swatches_clear(struct swatches *s);

/* Sets the colour of a row. Channels above 1 are shown as 1. */
void swatches_set(struct swatches *s, int row, const double rgb[3]);

/* Encodes all swatches into s->ansi, except where the window covers them. (col,
 * row) is their upper left cell on the screen; the cursor ends in end_row. */
void swatches_draw(struct swatches *s, enum palette palette, int col, int row,
                   const struct ansi_diff_rect *window, int end_row);

#endif
