// SPDX-License-Identifier: MIT
/*
 * dither.h - colours of a picture to the colours of a terminal
 *
 * Where a palette is small, neighbours get different colours that mean the
 * right one together. Which of them a pixel gets is a function of its colour
 * and its place alone: what stands still does not crawl, and a small change
 * of a picture changes few pixels.
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

/* What the terminal can show, from least to most. */
enum palette {
    PALETTE_MONO,
    PALETTE_16,
    PALETTE_256, /* only 16..255: the rest belongs to the person's theme */
    PALETTE_24BIT
};

struct rgb {
    int r, g, b;
};

/* One of the 256 colours. */
struct ink {
    struct vec3 light; /* linear */
    struct vec3 lab;   /* OKLab */
};

struct dither {
    struct ink *inks; /* 16..255, from index 0 on */
    uint64_t *mixes;  /* those that were needed so far, found once each */
};

bool dither_init(struct dither *d, struct error *err);
void dither_free(struct dither *d);

/* The colour of a pixel: 0xRRGGBB, or a number of the palette, which is not
 * PALETTE_MONO. */
uint32_t dither_color(struct dither *d, struct rgb c, int x, int y,
                      enum palette palette);

/* What a number of PALETTE_256 or PALETTE_16 looks like. */
struct rgb dither_value(uint32_t number, enum palette palette);

/* What the place adds to the choice, 0 to 15: each once in any 4x4 pixels. */
int dither_threshold(int x, int y);

#endif
