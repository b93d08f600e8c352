// SPDX-License-Identifier: MIT
/*
 * path_types.h - what a sample returns
 *
 * Units:     radiance
 */
#ifndef KERNELS_PATH_TYPES_H
#define KERNELS_PATH_TYPES_H

#include "kernels/types.h"

/* Samples that are computed together, at most. */
#define SAMPLE_BLOCK 8

/* Sample `index` of pixel (x, y) of the whole picture. */
struct sample_id {
    uint32_t x, y;
    uint64_t index;
};

struct path_sample {
    struct vec3 radiance;
    uint32_t rays; /* closest-hit and any-hit queries */
    uint32_t cut;  /* 1: ended at the hard stop of vertices */
};

#endif
