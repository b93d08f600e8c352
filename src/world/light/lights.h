// SPDX-License-Identifier: MIT
/*
 * lights.h - finds the area lights of a world and builds the tree of them and
 * of its point lights
 *
 * An emissive triangle is a light if it has enough power to be sampled. With
 * the next triangle it is one light if both are much alike and form a flat
 * face, like the halves of a quad. light_tree.h builds the tree.
 *
 * Units:     normalised scene units; texture coordinates; radiance, as the mean
 *            of the channels
 * Ownership: lights_free() and texture_power_free() free; zeroed structs have
 *            none
 * Threads:   one thread builds; read only after
 * Errors:    memory
 */
#ifndef GLIM_LIGHTS_H
#define GLIM_LIGHTS_H

#include "base/error.h"
#include "kernels/types.h"

/* ---- power of textured emitters ---- */

/*
 * A summed-area table of the texels (Crow 1984) has the mean over any rectangle
 * of the repeating image. A triangle is covered by bands of such rectangles,
 * with a margin, so that its mean is above 0 if any texel that it shows is.
 */

struct texture_power_sums {
    double *sums; /* over texels above and left: (width + 1)(height + 1) */
    uint32_t width, height;
};

/* Sums up the radiance of a material, which has an emission texture. */
bool texture_power_init(struct texture_power_sums *f, const struct world *w,
                        const struct material *m, struct error *err);

/* Returns the mean over the whole image. */
double texture_power_whole(const struct texture_power_sums *footprint);

/* Returns the mean over a triangle with these texture coordinates. */
double texture_power_mean(const struct texture_power_sums *f,
                          const struct vec2 uv[3]);

void texture_power_free(struct texture_power_sums *f);

/* ---- lights ---- */

/*
 * An emissive triangle is a light if it has enough power to be sampled. With
 * the next triangle it is one light if both are much alike and form a flat
 * face, like the halves of a quad. light_tree.h builds the tree.
 */

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
