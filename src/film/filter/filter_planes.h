// SPDX-License-Identifier: MIT
/*
 * filter_planes.h - arrays of the denoising filter
 *
 * A plane is a float for each pixel, with room around the picture that loops
 * may read. The pixels beside the picture are copies of the outermost ones;
 * weights outside of it are 0.
 *
 * Units:     as kernels/filter.h
 * Ownership: the planes are the filter's
 * Threads:   any, on tiles that differ
 */
#ifndef GLIM_FILTER_PLANES_H
#define GLIM_FILTER_PLANES_H

#include <stddef.h>

#include "kernels/filter.h"

/* Rows above and below the picture: the largest step, and one pixel for 3x3. */
#define FILTER_PAD ((1 << (FILTER_LEVELS - 1)) + 1)

/* Floats of a cache line, and pixels to the left and to the right of the
 * picture: FILTER_PAD in whole lines. */
#define FILTER_LINE   16
#define FILTER_MARGIN 48

/* Copied pixels on each side, for 5x5 pixels. */
#define FILTER_COPIES 2

/* Pairs of pixels: each has a weight with the one to the right, and with three
 * of the row below. */
#define FILTER_PAIRS 4

/* Albedo, normal and depth. */
#define FILTER_FEATURES 7

/* Size of a tile. Wide ones have long loops and few distances in common with
 * others; low ones fit into nearer caches. */
#define FILTER_TILE_WIDTH  416
#define FILTER_TILE_HEIGHT 16

/* Both halves: light and the variance of its noise. */
struct filter_halves {
    float *light[2][3];
    float *variance[2];
};

/* Features, scaled by FILTER_x_SCALE. */
struct filter_features {
    float *means[FILTER_FEATURES];
    float *noise; /* variance of the means, summed */
};

struct filter_planes {
    int width, height;
    ptrdiff_t pitch;                /* floats from a row to the next */
    struct filter_halves halves[2]; /* a level reads one, writes the other */
    /* of a level, from the light of each half */
    float *weights[2][FILTER_PAIRS];
    float *opposite[2][FILTER_PAIRS];
    struct filter_features features;
    float *samples; /* of each pixel, over the mean of all */
    float *albedo;  /* sum of channels, each with FILTER_ALBEDO_MIN */
};

struct filter_tile {
    int x, y, width, height;
};

/* Tiles cover the picture row by row. */
uint32_t filter_tile_columns(const struct filter_planes *p);
uint32_t filter_tile_count(const struct filter_planes *p);
struct filter_tile filter_tile_at(const struct filter_planes *p, uint32_t i);

/* Copies the outermost pixels of the tile to the pixels outside of the picture
 * that are beside it. */
void filter_extend(const struct filter_planes *p, float *plane,
                   struct filter_tile t);

#endif
