// SPDX-License-Identifier: MIT
/*
 * triangle_cdf.h - a list of triangles that are sampled by weight
 *
 * Units:     normalised scene units
 * Ownership: triangle_cdf_free() frees; a zeroed struct is empty, without room
 * Threads:   one thread fills; read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_TRIANGLE_CDF_H
#define GLIM_TRIANGLE_CDF_H

#include "base/thread_pool.h"
#include "kernels/types.h"

struct triangle_cdf {
    uint32_t *tris;
    double *sums; /* sum of the weights up to and with each */
    uint32_t count;
};

/* Makes an empty list with room for `capacity` triangles. */
bool triangle_cdf_init(struct triangle_cdf *list, uint32_t capacity);

void triangle_cdf_add(struct triangle_cdf *list, uint32_t tri, double weight);

/* Lists the first listed_tri_count() triangles by their areas. */
bool triangle_cdf_of_areas(struct triangle_cdf *list, const struct world *world,
                           struct pool *pool);

double triangle_cdf_total(const struct triangle_cdf *list);

/* Samples a triangle by u in [0, 1). The list is not empty. */
uint32_t triangle_cdf_choose(const struct triangle_cdf *list, float u);

/* Returns the index of the first triangle to which the weights have more than
 * this sum, or of the last. */
uint32_t triangle_cdf_index(const struct triangle_cdf *list, double sum);

void triangle_cdf_free(struct triangle_cdf *list);

/* The number of triangles that lists have: all, or the first of a scene with
 * instances where all would take too much memory. */
uint32_t listed_tri_count(const struct world *world);
bool all_are_listed(const struct world *world);

void tri_corners(const struct world *world, uint32_t tri, struct vec3 p[3]);

double tri_area(const struct world *world, uint32_t tri);

/* A uniform point of a triangle. */
struct vec3 tri_point(const struct world *world, uint32_t tri, struct vec2 u);

uint32_t tri_material_number(const struct world *world, uint32_t tri);

/* Returns twice the diagonal of the box around the triangles, or more. */
float beyond_scene(const struct world *world);

#endif
