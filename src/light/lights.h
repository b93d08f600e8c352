// SPDX-License-Identifier: MIT
/*
 * lights.h - the triangles that shine, and the tree that finds them
 *
 * A triangle is a light if it sheds enough to be worth sampling; with the next
 * one it is a single light if both are much the same and make one flat face, as
 * the halves of a quad do. light_tree.h builds the tree.
 *
 * Units:     normalised scene units
 * Ownership: lights_free() frees; a zeroed struct is a scene without lights
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
    double (
        *powers)[2]; /* of each light: of its triangles, see lights_power() */
    uint32_t *tri_lights;
    struct light_node *nodes;
    uint32_t node_count;
    double unsampled_variance; /* sum of area times radiance squared */
};

/* Reads the world's triangles, materials and textures. */
bool lights_build(struct lights *lights, const struct world *world,
                  struct error *err);

/* Returns the power of all lights. The power of a triangle is its area times
 * the mean of its radiance over its part of the emission map and over the
 * channels, times its opacity. */
double lights_power(const struct lights *lights);

/* True if a triangle that gets the other material becomes another light. */
bool lights_differ(const struct material *a, const struct material *b);

/* Lends the arrays to the world, which has its sky. Where a constant sky
 * outshines the lights they are sampled less often. */
void lights_lend(const struct lights *lights, struct world *world);

void lights_free(struct lights *lights);

#endif
