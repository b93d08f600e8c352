// SPDX-License-Identifier: MIT
/*
 * cells.h - a picture as terminal cells, each a glyph in two colours
 *
 * Units:     terminal cells, 8-bit sRGB
 * Ownership: cells_free() frees; a zeroed struct is empty
 * Threads:   any
 * Errors:    memory
 */
#ifndef GLIM_CELLS_H
#define GLIM_CELLS_H

#include <stdbool.h>
#include <stdint.h>

#include "image/frame.h"
#include "terminal/dither.h"
#include "terminal/glyphs.h"

/* The terminal's default foreground or background. */
#define CELL_DEFAULT 0xffffffffu

struct cell {
    uint32_t fg, bg; /* 0xRRGGBB, a palette number or CELL_DEFAULT */
    uint32_t glyph;  /* code point; 0 if unknown. A blank has fg = bg */
};

struct cells {
    int cols, rows;
    enum palette palette;
    enum glyphs glyphs;
    struct cell *cell; /* cols * rows, row 0 at the top */
    struct dither dither;
    const struct frame *frame; /* of cells_row(); NULL: all rows are made */
    uint8_t tones[256]; /* without colours: brightness with more contrast */
    bool has_mark;
    int mark_col, mark_row;
};

bool cells_init(struct cells *cells, int cols, int rows, struct error *err);
void cells_free(struct cells *cells);

/* Begins cells of a frame of cols * across by rows * down pixels, see
 * glyphs_grid(): cells_row() makes each row from it. Blocks also take a frame
 * for half blocks. Without colours (PALETTE_MONO) each dot of braille is set or
 * not; other glyphs become characters, since they show no shades. */
void cells_begin(struct cells *cells, const struct frame *frame,
                 enum palette palette, enum glyphs glyphs);
void cells_row(struct cells *cells, int row);

/* Begins the cells and makes all rows. */
void cells_from_frame(struct cells *cells, const struct frame *frame,
                      enum palette palette, enum glyphs glyphs);

/* Returns a blank of one colour. Without colours it is a character by
 * brightness. */
struct cell cells_of_color(struct rgb color, enum palette palette);

/* Lets cells_row() draw a cursor around a cell: [+]. */
void cells_mark(struct cells *cells, int col, int row);

/* Rectangle of the picture in a window, in cells. */
struct cells_rect {
    int col, row; /* the upper left cell, from 0 */
    int cols, rows;
};

/* Returns the largest centred rectangle with the picture's aspect ratio in a
 * window of cols x rows cells, at least 1x1. cell_aspect is the height of a
 * cell divided by its width. */
struct cells_rect cells_fit(int width_px, int height_px, int cols, int rows,
                            double cell_aspect);

#endif
