// SPDX-License-Identifier: MIT
/*
 * lights.h - finds the area lights of a world and builds the tree of them and
 * of its point lights
 *
 * An emissive triangle is a light if it has enough power to be sampled. With
 * the next triangle it is one light if both are much alike and form a flat
 * face, like the halves of a quad. light_tree.h builds the tree.
 *
 * Units:     normalised scene units
 * Ownership: lights_free() frees; a zeroed struct has no lights
 * Threads:   one thread builds; read only after
 * Errors:    memory
 */
#ifndef GLIM_LIGHTS_H
#define GLIM_LIGHTS_H

#include "base/error.h"
#include "kernels/types.h"

struct lights {
    struct light *lights; /* in the order of their first triangles */
    uint32_t light_count;
    double (*powers)[2]; /* of the triangles of each light */
    uint32_t *tri_lights;
    struct point_light *point_lights; /* spheres first */
    uint32_t point_light_count, sphere_count;
    double point_power; /* of all point lights */
    struct light_node *nodes;
    uint32_t node_count;
    double unsampled_variance; /* sum of area times squared radiance */
};

/* Finds the lights from the world's triangles, materials and textures, and
 * copies its point lights. */
bool lights_build(struct lights *lights, const struct world *world,
                  struct error *err);

/* Returns the power of all lights. The power of a triangle is its area times
 * the mean of its radiance over its part of the emission map and over the
 * channels, times its opacity; a point light has the power of a surface with
 * the same flux. */
double lights_power(const struct lights *lights);

/* Returns the power of a point light. */
double point_light_power(const struct world *w,
                         const struct point_light *light);

/* Returns true if a change from one material to the other changes the lights.
 */
bool lights_differ(const struct material *a, const struct material *b);

/* Lends the arrays to the world, which must have its sky. The lights get a
 * smaller share of the light samples where a constant sky outshines them. */
void lights_lend(const struct lights *lights, struct world *world);

void lights_free(struct lights *lights);

#endif
