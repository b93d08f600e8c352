// SPDX-License-Identifier: MIT
/*
 * casters.h - the triangles that cast light, at which light paths aim
 *
 * They are sampled by area until casters_weigh() tells where light arrives:
 * most of the area of glass is behind other glass, or turned away from the
 * lamp. Triangles that are close together and face alike are a cluster.
 *
 * Units:     normalised scene units
 * Ownership: casters_free() frees; a zeroed struct is empty
 * Threads:   one builds and weighs; read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_CASTERS_H
#define GLIM_CASTERS_H

#include "world/light/triangle_cdf.h"

struct casters {
    struct triangle_cdf list; /* cluster by cluster */
    uint32_t *ends;           /* of the clusters in the list */
    uint32_t cluster_count;
};

/* Lists the triangles that cast. There are none if the world lists only some of
 * its triangles. */
bool casters_build(struct casters *casters, const struct world *world);

/* A point that was sampled. */
struct caster_point {
    struct vec3 p;
    uint32_t tri;
    float area; /* 1 / the density by area; 0: none */
};

/* Samples a point of all by numbers in [0, 1), or of a cluster. */
struct caster_point casters_choose(const struct casters *casters,
                                   const struct world *world, double choice,
                                   struct vec2 u);
struct caster_point casters_choose_in(const struct casters *casters,
                                      const struct world *world,
                                      uint32_t cluster, double choice,
                                      struct vec2 u);

/* Weighs the clusters, once, by the mean light that arrives at each. Light that
 * was not seen may arrive: none has less than a part of the mean. */
void casters_weigh(struct casters *casters, const double *light);

void casters_free(struct casters *casters);

#endif
