// SPDX-License-Identifier: MIT
/*
 * cells.h - a picture as terminal cells: half blocks, palettes, brightness as
 * characters
 *
 * A cell shows two pixels, one above the other. A frame for cells_from_frame()
 * therefore has the cells' columns and twice their rows.
 *
 * Units:     terminal cells, 8-bit sRGB
 * Ownership: cells_free() frees; a zeroed struct is empty
 * Threads:   any; no state but the caller's
 * Errors:    memory
 */
#ifndef GLIM_CELLS_H
#define GLIM_CELLS_H

#include "glim/film.h"
#include "glim/util.h"

/* What the terminal can show, from least to most. */
enum palette {
    PALETTE_MONO,
    PALETTE_16,
    PALETTE_256, /* only 16..255: the rest belongs to the person's theme */
    PALETTE_24BIT
};

enum glyphs {
    GLYPHS_UPPER, /* upper half block */
    GLYPHS_LOWER,
    GLYPHS_SPACE, /* one colour a cell */
    GLYPHS_ASCII  /* brightness as characters */
};

/* Glyphs that are no ASCII characters. 0 is no glyph: a cell of which nobody
 * knows what it shows. */
#define CELL_UPPER 1u
#define CELL_LOWER 2u
/* The terminal's own foreground or background. */
#define CELL_DEFAULT 0xffffffffu

struct cell {
    uint32_t fg, bg; /* 0xRRGGBB, or a number of the palette */
    uint32_t glyph;  /* a blank's fg is its bg */
};

struct cells {
    int cols, rows;
    enum palette palette;
    struct cell *cell; /* cols * rows, row 0 at the top */
};

bool cells_init(struct cells *cells, int cols, int rows, struct error *err);
void cells_free(struct cells *cells);

/* A monochrome palette always gives characters. */
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
