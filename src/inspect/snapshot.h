// SPDX-License-Identifier: MIT
/*
 * snapshot.h - a render as it was at one moment, to compare later ones with
 *
 * Each pixel has its mean and e, half the difference of the means of its two
 * halves, see film_error.h. A difference of means over a block of pixels is
 * significant if it is more than `bound` times the root of the sum of e^2 of
 * both renders: then less than one picture in twenty has a marked block where
 * only the noise differs.
 *
 * Units:     linear light
 * Ownership: snapshot_free() frees; a zeroed struct is empty
 * Threads:   one; rows of the film are locked
 * Errors:    memory
 */
#ifndef GLIM_SNAPSHOT_H
#define GLIM_SNAPSHOT_H

#include "film/film.h"
#include "film/film_error.h"

struct snapshot {
    int width, height;
    struct snapshot_pixel *pixels;
    uint64_t spp;
    struct film_error error;
};

struct snapshot_pixel {
    float mean[3], e[3];
    float is_known; /* 1: both halves have a sample; 0: e is unknown */
};

/* Keeps the film. A pixel without a known error has e = 0. */
bool snapshot_take(struct snapshot *kept, struct film *film, struct error *err);

uint64_t snapshot_bytes(const struct snapshot *kept);

/* Develops it into a frame of any size, as film_preview() does. */
void snapshot_paint(const struct snapshot *kept, struct develop how,
                    struct frame *frame);

/* Blocks of pixels, row 0 at the top. */
struct snapshot_blocks {
    int cols, rows;
    struct snapshot_block {
        float difference; /* of the means of the channels, relative to theirs */
        bool is_significant;
    } * blocks;
    int significant_count;
};

/* Finds the blocks in which the film differs from the kept render. There are no
 * more than cols x rows of them, and each has 8 x 8 pixels or more. Of large
 * films not all rows are read. */
bool snapshot_differences(const struct snapshot *kept, struct film *film,
                          int cols, int rows, struct snapshot_blocks *blocks,
                          struct error *err);

void snapshot_blocks_free(struct snapshot_blocks *blocks);
void snapshot_free(struct snapshot *kept);

#endif
