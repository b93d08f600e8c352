// SPDX-License-Identifier: MIT
/*
 * points.h - the random numbers of a pixel's samples, computed together
 *
 * The same numbers as random_2d() gives, for eight samples in one loop that
 * compilers turn into vector code. A dimension is computed when the first
 * sample asks for it: where one path goes, the others mostly go as well.
 *
 * Units:     numbers in [0, 1)
 * Ownership: none
 * Threads:   one at a time
 * Errors:    none
 */
#ifndef KERNELS_POINTS_H
#define KERNELS_POINTS_H

#include "kernels/path_types.h"
#include "kernels/rng.h"

/* Kinds of dimensions at a vertex, and vertices that are computed ahead, the
 * camera the first: what comes later few paths ask for. */
#define POINT_KINDS    4u
#define POINT_VERTICES 16u

/* The vertex of the dimensions below DIMENSION_BOUNCE. */
#define POINTS_CAMERA 0u

struct points {
    uint32_t key; /* that all have */
    uint32_t reversed_index[SAMPLE_BLOCK];
    uint32_t known_from[POINT_VERTICES]; /* this kind on */
    float x[POINT_VERTICES * POINT_KINDS][SAMPLE_BLOCK];
    float y[POINT_VERTICES * POINT_KINDS][SAMPLE_BLOCK];
};

/* `kind` and those behind it: who asks for the first kind asks for the others
 * as well, and steps of one number wait for each other, those of four need
 * not. */
static inline void points_compute(struct points *p, uint32_t vertex,
                                  uint32_t kind)
{
    struct sampler any = {p->key, 0};

    for (uint32_t k = kind; k < p->known_from[vertex]; k++) {
        uint32_t key = dimension_key(any, vertex * DIMENSION_STRIDE + k);
        uint32_t slot = vertex * POINT_KINDS + k;

        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++) {
            struct bits2 b = sobol_point(p->reversed_index[i], key);

            p->x[slot][i] = unit_float(b.x);
            p->y[slot][i] = unit_float(b.y);
        }
    }
    p->known_from[vertex] = kind;
}

/* random_2d() of sample i at a vertex, the first of which is 1; `kind` is one
 * of enum dimension's that are counted from DIMENSION_BOUNCE, for the camera
 * from 0. Without points, for one sample alone. */
static inline struct vec2 points_2d(struct points *p, uint32_t i,
                                    struct sampler s, uint32_t vertex,
                                    uint32_t kind)
{
    uint32_t slot = vertex * POINT_KINDS + kind;

    if (p == NULL || vertex >= POINT_VERTICES)
        return random_2d(s, vertex * DIMENSION_STRIDE + kind);
    if (kind < p->known_from[vertex])
        points_compute(p, vertex, kind);
    return v2(p->x[slot][i], p->y[slot][i]);
}

#endif
