// SPDX-License-Identifier: MIT
/*
 * triangle_cdf.h - some triangles of a world, to choose from by weight
 *
 * Units:     normalised scene units
 * Ownership: triangle_cdf_free() frees; a zeroed struct is an empty list
 * without room Threads:   one thread fills; read only after Errors:    memory,
 * by false
 */
#ifndef GLIM_TRIANGLE_CDF_H
#define GLIM_TRIANGLE_CDF_H

#include "kernels/types.h"

struct triangle_cdf {
    uint32_t *tris;
    double *sums; /* of the weights up to and with each */
    uint32_t count;
};

/* Room for so many. */
bool triangle_cdf_init(struct triangle_cdf *list, uint32_t capacity);

void triangle_cdf_add(struct triangle_cdf *list, uint32_t tri, double weight);

double triangle_cdf_total(const struct triangle_cdf *list);

/* For u in [0, 1); the list is not empty. */
uint32_t triangle_cdf_choose(const struct triangle_cdf *list, float u);

void triangle_cdf_free(struct triangle_cdf *list);

void tri_corners(const struct world *world, uint32_t tri, struct vec3 p[3]);

double tri_area(const struct world *world, uint32_t tri);

#endif
