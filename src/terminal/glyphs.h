// SPDX-License-Identifier: MIT
/*
 * glyphs.h - characters that parts of which have two colours
 *
 * Units:     Unicode code points; dots, bit 0 at the upper left, then along
 *            the rows
 * Threads:   any
 */
#ifndef GLIM_GLYPHS_H
#define GLIM_GLYPHS_H

#include <stdbool.h>
#include <stdint.h>

/* How a cell of the terminal shows the picture. */
enum glyphs {
    GLYPHS_HALF,  /* half blocks, upper or lower */
    GLYPHS_UPPER, /* half blocks, only the upper */
    GLYPHS_LOWER,
    GLYPHS_QUADRANT,
    GLYPHS_SEXTANT,
    GLYPHS_BRAILLE,
    GLYPHS_SPACE, /* one colour a cell */
    GLYPHS_ASCII, /* brightness as characters */
    GLYPHS_COUNT
};

#define CELL_UPPER 0x2580u
#define CELL_LOWER 0x2584u
#define CELL_FULL  0x2588u

/* The most dots that a glyph has. */
#define GLYPH_DOTS_MAX 8

struct glyph_grid {
    int across, down;
};

/* The pixels that a cell stands for. */
struct glyph_grid glyphs_grid(enum glyphs glyphs);

/* The glyph whose dots of this mask have the foreground; where they do not fill
 * their places (braille) or there is no such glyph, as near as it can be. */
uint32_t glyphs_of_mask(enum glyphs glyphs, unsigned mask);

/* Its inverse. False if the glyph is none of these. */
bool glyphs_mask(enum glyphs glyphs, uint32_t glyph, unsigned *mask);

/* True if there is a glyph for every mask and its dots leave no gaps, so that
 * foreground and background may change places. */
bool glyphs_are_solid(enum glyphs glyphs);

/* Its name for people. */
const char *glyphs_name(enum glyphs glyphs);

/* UTF-8 of a code point; the number of bytes. */
int glyph_utf8(uint32_t glyph, char bytes[4]);

#endif
