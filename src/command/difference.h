// SPDX-License-Identifier: MIT
/*
 * difference.h - errors and differences of pictures
 *
 * Units:     linear radiance, row 0 at the top, 3 floats a pixel; 8-bit sRGB
 * Ownership: tile_test_free() frees
 * Threads:   any
 * Errors:    out of memory
 */
#ifndef GLIM_DIFFERENCE_H
#define GLIM_DIFFERENCE_H

#include <stdbool.h>

#include "base/error.h"
#include "image/frame.h"

/* ---- errors ---- */

/* Two pictures of the same size. */
struct picture_pair {
    int width, height;
    const float *rgb;
    const float *reference;
};

/* Differences are rgb - reference. Means are over pixels and channels. */
struct picture_error {
    double mse;    /* mean of the squares of the differences */
    double relmse; /* mean of (rgb - reference)^2 / (reference^2 + 0.01) */
    double bias;   /* mean difference over the mean of the reference; NaN for a
                      black reference */
    double bias_margin; /* half of the 95 % interval of the bias, if the noise
                           of pixels is independent; NaN for a single pixel */
    double percentile;  /* 99.9 % of the differences are at most this, without
                           their sign */
    double largest;     /* the largest difference, with its sign */
    int largest_x, largest_y, largest_channel;
};

struct picture_error picture_error_of(const struct picture_pair *pair);

/* Returns the relative root mean square error as film_error.h defines it, with
 * the means of the reference around each pixel: what a film of the picture is
 * to state. `exposure` is that of the view. */
double picture_error_stated(const struct picture_pair *pair, double exposure);

/* Errors of parts of the picture, which are independent of each other: each has
 * pixels from everywhere. */
#define PIXEL_GROUPS 16

struct group_errors {
    double mse[PIXEL_GROUPS], relmse[PIXEL_GROUPS];
};

struct group_errors picture_error_groups(const struct picture_pair *pair);

/* Returns the measured error without the reference's own, which is independent
 * and so adds to it. Up to 5 % of the measured error it does not matter and
 * stays. The result is 0 or less if the reference is too noisy. */
double picture_error_without(double measured, double own);

/* ---- differences ---- */

/*
 * The pictures are divided into tiles. The mean difference of a tile and
 * channel over its standard error has Student's t distribution if the pictures
 * are the same but for noise that is independent between pixels. The bound is
 * for all tiles and the whole picture together (Bonferroni).
 */

/* ---- tiles ---- */

/* Probability that any tile of two equal pictures is marked. */
#define FALSE_ALARMS_DEFAULT 0.01

/* A tile with its most significant channel. */
struct tile {
    int x, y, width, height;
    int channel;
    double difference; /* mean of the differences */
    double reference;  /* mean of the reference */
    double t;          /* difference over its standard error; infinite if the
                          tile has a difference but no noise */
    bool differs;      /* |t| is above the bound */
};

struct tile_test {
    int cols, rows;
    struct tile *tiles; /* row by row */
    double bound;
    int differing;     /* number of tiles that differ */
    struct tile whole; /* the whole picture, which is tested as well */
};

/* Divides the pictures into at most `side_max` tiles each way, of at least
 * 16x16 pixels, and tests each. `false_alarms` is the probability that any tile
 * is marked although the pictures differ by noise alone. */
bool tile_test_init(struct tile_test *test, const struct picture_pair *pair,
                    int side_max, double false_alarms, struct error *err);

void tile_test_free(struct tile_test *test);

/* ---- picture ---- */

/* Draws the relative difference of each pixel in false colours, red where the
 * picture is brighter than the reference and blue where it is darker, and a
 * white frame around each tile that differs. The frame has the size of the
 * pictures. Returns the relative difference that has the brightest colour. */
double difference_draw(const struct picture_pair *pair,
                       const struct tile_test *test, struct frame *frame);

#endif
