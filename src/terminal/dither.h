// SPDX-License-Identifier: MIT
/*
 * dither.h - colours of a picture to colours of a terminal
 *
 * Small palettes are dithered: neighbouring pixels get different colours whose
 * mean is the right one. The choice is a function of the pixel's colour and
 * place only, so a still picture does not flicker, and a small change of the
 * picture changes few pixels.
 *
 * Units:     8-bit sRGB
 * Ownership: dither_free() frees; a zeroed struct is for dither_init()
 * Threads:   one thread at a time for each struct
 * Errors:    memory
 */
#ifndef GLIM_DITHER_H
#define GLIM_DITHER_H

#include "base/error.h"
#include "kernels/vec.h"

/* Palettes of terminals, from least to most colours. */
enum palette {
    PALETTE_MONO,
    PALETTE_16,
    PALETTE_256, /* only 16..255: the user's theme defines the others */
    PALETTE_24BIT
};

struct rgb {
    int r, g, b;
};

/* Returns how bright a colour looks, roughly, from 0 to 255. */
static inline int rgb_brightness(struct rgb c)
{
    return (2 * c.r + 5 * c.g + c.b) / 8;
}

/* Two colours that a glyph mixes in a cell: so many quarters of it have the
 * foreground. */
struct shade {
    uint32_t fg, bg;
    int quarters;
};

/* Colour of a palette. */
struct palette_color {
    struct vec3 light; /* linear RGB */
    struct vec3 lab;   /* OKLab */
    struct shade shade;
    float variance; /* of the shade's colours, weighted */
};

struct dither {
    enum palette palette; /* of the mixes; PALETTE_MONO: none yet */
    bool has_shades;      /* shades are kept, not mixes */
    int count;            /* of colours */
    struct palette_color *colors;
    uint64_t *mixes; /* cache: each mix is computed when it is first needed */
};

bool dither_init(struct dither *d, struct error *err);
void dither_free(struct dither *d);

/* Returns the colour of a pixel: 0xRRGGBB, or a number of the palette. The
 * palette must not be PALETTE_MONO. */
uint32_t dither_color(struct dither *d, struct rgb c, int x, int y,
                      enum palette palette);

/* Returns the shade that is nearest to a colour in PALETTE_16, with 0 to 3
 * quarters. It is not dithered: its grain is finer than a cell's. */
struct shade dither_shade(struct dither *d, struct rgb c);

/* Returns the number of a colour of PALETTE_256 or PALETTE_16 that looks like
 * this one: of 256 the nearest grey, or the nearest of the cube. */
uint32_t dither_nearest(struct rgb c, enum palette palette);

/* Returns the sRGB colour of a number of PALETTE_256 or PALETTE_16. */
struct rgb dither_value(uint32_t number, enum palette palette);

/* Returns the threshold of a place, 0 to 15. Each occurs once in any 4x4
 * pixels. */
int dither_threshold(int x, int y);

#endif
