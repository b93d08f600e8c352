// SPDX-License-Identifier: MIT
/*
 * triangle_cdf.h - some triangles of a world, to choose from by weight
 *
 * Units:     normalised scene units
 * Ownership: tri_list_free() frees; a zeroed struct is an empty list without
 *            room
 * Threads:   one thread fills; read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_TRIANGLE_CDF_H
#define GLIM_TRIANGLE_CDF_H

#include "base/util.h"
#include "kernels/types.h"

struct tri_list {
    uint32_t *tris;
    double *sums; /* of the weights up to and with each */
    uint32_t count;
};

/* Room for so many. */
bool tri_list_init(struct tri_list *list, uint32_t capacity);

void tri_list_add(struct tri_list *list, uint32_t tri, double weight);

double tri_list_total(const struct tri_list *list);

/* For u in [0, 1); the list is not empty. */
uint32_t tri_list_choose(const struct tri_list *list, float u);

void tri_list_free(struct tri_list *list);

void tri_corners(const struct world *world, uint32_t tri, struct vec3 p[3]);

double tri_area(const struct world *world, uint32_t tri);

/* Area times the mean of what the material's channels emit. */
double tri_power(const struct world *world, uint32_t tri);

#endif
