// SPDX-License-Identifier: MIT
/*
 * path_types.h - a sample of a pixel: which one it is, and its result
 *
 * Units:     radiance
 */
#ifndef KERNELS_PATH_TYPES_H
#define KERNELS_PATH_TYPES_H

#include "kernels/types.h"

/* Samples of a pixel that most passes add, and camera rays that are traced as
 * one packet. */
#define SAMPLE_BLOCK 8

/* Most samples that are computed together. With 16 or 32 pictures take 1 to 4 %
 * more time, with 256 up to 8 % more. */
#define SAMPLE_STREAM 64

/* Identifies a sample: its pixel in the whole picture, and its number there. */
struct sample_id {
    uint32_t x, y;
    uint64_t index;
};

/* Vertices of a path that give radiance_cells.h estimates. */
#define CELL_ESTIMATES_MAX 8

/* The radiance that a surface reflects, divided by its color. */
struct cell_estimate {
    uint64_t key; /* of its cell */
    struct vec3 radiance;
    struct vec3 weight; /* of the radiance in that of the path */
};

struct cell_estimates {
    uint32_t count;
    struct cell_estimate at[CELL_ESTIMATES_MAX];
};

struct path_sample {
    struct vec3 radiance;
    uint32_t rays; /* closest-hit and any-hit queries */
    uint32_t cut;  /* 1: the path ended at PATH_HARD_STOP or a limit like it */
};

#endif
