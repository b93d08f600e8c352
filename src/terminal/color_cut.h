// SPDX-License-Identifier: MIT
/*
 * color_cut.h - a palette made for one image, and the image in it
 *
 * Colours are counted in cells of the colour cube after ordered dithering, and
 * the cells are divided into boxes of little variance. A colour of the palette
 * is the mean of the undithered pixels of its box, so that flat areas have no
 * pattern, and slow changes no steps. The numbers are a function of the image
 * alone: a still one does not flicker.
 *
 * Units:     8-bit sRGB
 * Ownership: color_cut_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_COLOR_CUT_H
#define GLIM_COLOR_CUT_H

#include <stdint.h>

#include "terminal/dither.h"

/* More colours take more bytes: 256 a fifth more, for an error that is a
 * seventh smaller in ten rendered pictures. */
#define COLOR_CUT_MAX 128

struct color_cut {
    struct rgb colors[COLOR_CUT_MAX]; /* palette of the last image */
    int count;
    struct color_bin *bins; /* cells of the cube */
    uint16_t *used;         /* numbers of those with pixels */
};

bool color_cut_init(struct color_cut *c, struct error *err);
void color_cut_free(struct color_cut *c);

/* Image of three bytes a pixel. */
struct color_cut_image {
    const uint8_t *rgb;
    int width, height;
    int x, y; /* place of its corner in the pattern of the dither */
};

/* Makes a palette of at most `most` colours, and the number of each pixel. */
void color_cut(struct color_cut *c, const struct color_cut_image *image,
               int most, uint8_t *numbers);

#endif
