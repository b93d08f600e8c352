// SPDX-License-Identifier: MIT
/*
 * cells.h - a picture as terminal cells: blocks of two colours, brightness as
 * characters
 *
 * Units:     terminal cells, 8-bit sRGB
 * Ownership: cells_free() frees; a zeroed struct is empty
 * Threads:   any; no state but the caller's
 * Errors:    memory
 */
#ifndef GLIM_CELLS_H
#define GLIM_CELLS_H

#include <stdbool.h>
#include <stdint.h>

#include "picture/film.h"
#include "terminal/dither.h"
#include "terminal/glyphs.h"

/* The terminal's own foreground or background. */
#define CELL_DEFAULT 0xffffffffu

struct cell {
    uint32_t fg, bg; /* 0xRRGGBB, a number of the palette, CELL_DEFAULT */
    uint32_t glyph;  /* a code point; a blank's fg is its bg. 0 is no glyph: a
                        cell of which nobody knows what it shows */
};

struct cells {
    int cols, rows;
    enum palette palette;
    enum glyphs glyphs;
    struct cell *cell; /* cols * rows, row 0 at the top */
    struct dither dither;
};

bool cells_init(struct cells *cells, int cols, int rows, struct error *err);
void cells_free(struct cells *cells);

/* The frame has cols * across by rows * down pixels of glyphs_grid(). Without
 * colours (PALETTE_MONO) dots are set or not; one or two pixels a cell are too
 * few for that and become characters. */
void cells_from_frame(struct cells *cells, const struct frame *frame,
                      enum palette palette, enum glyphs glyphs);

/* Puts a cursor around a cell: [+]. */
void cells_mark(struct cells *cells, int col, int row);

/* Where a picture goes in a window, in cells. */
struct fit {
    int col, row; /* of its upper left cell, from 0 */
    int cols, rows;
};

/* The largest rectangle of the picture's shape in a window of cols x rows
 * cells that are cell_aspect times as high as wide; centred, at least 1x1. */
struct fit cells_fit(int width_px, int height_px, int cols, int rows,
                     double cell_aspect);

#endif
