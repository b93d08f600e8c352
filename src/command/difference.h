// SPDX-License-Identifier: MIT
/*
 * difference.h - where two pictures differ by more than their noise, and a
 * picture of it
 *
 * The pictures are divided into tiles. The mean difference of a tile and
 * channel over its standard error has Student's t distribution if the pictures
 * are the same but for noise that is independent between pixels. The bound is
 * for all tiles and the whole picture together (Bonferroni).
 *
 * Units:     pixels; linear radiance; 8-bit sRGB
 * Ownership: tile_test_free() frees
 * Threads:   any
 * Errors:    out of memory
 */
#ifndef GLIM_DIFFERENCE_H
#define GLIM_DIFFERENCE_H

#include <stdbool.h>

#include "base/error.h"
#include "command/picture_error.h"
#include "image/frame.h"

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
