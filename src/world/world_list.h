// SPDX-License-Identifier: MIT
/*
 * world_list.h - the arrays of struct world as a list, for those who copy or
 * hash them all
 *
 * Units:     bytes
 * Ownership: the arrays stay the world's
 * Threads:   any
 */
#ifndef GLIM_WORLD_LIST_H
#define GLIM_WORLD_LIST_H

#include "world/world.h"

/* The arrays in the order of the struct, with their lengths for a world *w and
 * its settings *s. `nodes` and `leaf_tris` belong to the backend, which knows
 * their lengths. The table of the sky has its whole length, even if the view
 * does not use it. */
#define WORLD_LIST(X)                                                   \
    X(positions, s->position_count, WORLD_FIXED)                        \
    X(normals, s->normal_count, WORLD_FIXED)                            \
    X(uvs, s->uv_count, WORLD_FIXED)                                    \
    X(uvs2, s->uv2_count, WORLD_FIXED)                                  \
    X(colors, s->color_count, WORLD_FIXED)                              \
    X(alphas, s->alpha_count, WORLD_FIXED)                              \
    X(tangents, s->tangent_count, WORLD_FIXED)                          \
    X(tris, s->tri_count, WORLD_TRIS)                                   \
    X(instances, s->instance_count, WORLD_TRIS)                         \
    X(materials, s->material_count, WORLD_MATERIALS)                    \
    X(textures, s->texture_count, WORLD_TEXTURES)                       \
    X(texels, s->texel_count, WORLD_TEXELS)                             \
    X(linear_of_srgb, 256, WORLD_FIXED)                                 \
    X(sky_texels, (size_t)s->sky.width * s->sky.height, WORLD_SKY)      \
    X(nodes, 0, WORLD_SHAPE)                                            \
    X(leaf_tris, 0, WORLD_SHAPE)                                        \
    X(lights, s->light_count, WORLD_LIGHTS)                             \
    X(tri_lights, s->light_count > 0 ? s->tri_count : 0, WORLD_LIGHTS)  \
    X(light_nodes, s->light_node_count, WORLD_LIGHTS)                   \
    X(sky_cdf, sky_table_length(s->sky), WORLD_SKY)                     \
    X(guide_cells, guide_cell_count(&s->guide), WORLD_GUIDE)            \
    X(guide_cdf, (size_t)s->guide.table_count *GUIDE_BINS, WORLD_GUIDE) \
    X(point_lights, s->point_light_count, WORLD_LIGHTS)                 \
    X(directional_lights, s->directional_light_count,                   \
      WORLD_DIRECTIONAL_LIGHTS)                                         \
    X(profiles, s->profile_value_count, WORLD_LIGHTS)                   \
    X(caustic_nodes, s->caustic_node_count, WORLD_GUIDE)                \
    X(caustic_lobes, s->caustic_lobe_count, WORLD_GUIDE)

#define WORLD_LIST_NAME(name, count, part) WORLD_LIST_##name,
enum world_list_index { WORLD_LIST(WORLD_LIST_NAME) WORLD_LIST_COUNT };
#undef WORLD_LIST_NAME

struct world_array {
    const void *data; /* may be NULL */
    size_t size_bytes;
    enum world_part part; /* whose version the array has */
};

/* Lists the arrays of a world. */
void world_list(const struct world *world,
                struct world_array list[WORLD_LIST_COUNT]);

/* Makes an array of the world point to these data. */
void world_list_set(struct world *world, enum world_list_index index,
                    const void *data);

#endif
