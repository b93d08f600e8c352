// SPDX-License-Identifier: MIT
/*
 * glyphs.h - characters that show a picture
 *
 * Units:     Unicode code points; masks of dots, bit 0 at the upper left, then
 *            row by row
 * Threads:   any
 */
#ifndef GLIM_GLYPHS_H
#define GLIM_GLYPHS_H

#include <stdbool.h>
#include <stdint.h>

/* Characters that make up the picture. */
enum glyphs {
    GLYPHS_HALF,  /* half blocks, upper or lower */
    GLYPHS_BLOCK, /* half blocks, quadrants and quarters */
    GLYPHS_BRAILLE,
    GLYPHS_SHADE, /* 16 colours: blanks, and glyphs that mix two colours */
    GLYPHS_SPACE, /* blanks, one colour a cell */
    GLYPHS_ASCII, /* ASCII characters by brightness */
    GLYPHS_COUNT
};

#define CELL_UPPER 0x2580u
#define CELL_LOWER 0x2584u
#define CELL_FULL  0x2588u
#define CELL_SHADE 0x2591u /* a quarter; two and three quarters follow */

/* Dots of a block or of braille: 2x4. */
#define GLYPH_DOTS 8

struct glyph_grid {
    int across, down;
};

/* Returns the number of pixels of a frame across and down a cell. */
struct glyph_grid glyphs_grid(enum glyphs glyphs);

/* Returns the block whose dots in the mask have the foreground colour; 0 if
 * there is none. */
uint32_t glyph_of_block(unsigned mask);

/* Finds the mask of a block. Returns false for other glyphs. */
bool glyph_block_mask(uint32_t glyph, unsigned *mask);

uint32_t glyph_of_braille(unsigned mask);

/* Returns the name as a person sees it. */
const char *glyphs_name(enum glyphs glyphs);

/* Writes a code point as UTF-8. Returns the number of bytes. */
int glyph_utf8(uint32_t glyph, char bytes[4]);

#endif
