// SPDX-License-Identifier: MIT
#include "scene/world_hash.h"

#include "base/hash.h"
#include "scene/world_list.h"

/* The part of a film's identity in which an array counts. Trees, which have
 * another one for each backend, are not hashed: the list has no lengths. */
static const enum film_part film_parts[WORLD_LIST_COUNT] = {
    [WORLD_LIST_positions] = FILM_GEOMETRY,
    [WORLD_LIST_normals] = FILM_GEOMETRY,
    [WORLD_LIST_uvs] = FILM_GEOMETRY,
    [WORLD_LIST_uvs2] = FILM_GEOMETRY,
    [WORLD_LIST_colors] = FILM_GEOMETRY,
    [WORLD_LIST_alphas] = FILM_GEOMETRY,
    [WORLD_LIST_tangents] = FILM_GEOMETRY,
    [WORLD_LIST_tris] = FILM_GEOMETRY,
    [WORLD_LIST_instances] = FILM_GEOMETRY,
    [WORLD_LIST_materials] = FILM_MATERIALS,
    [WORLD_LIST_textures] = FILM_TEXTURES,
    [WORLD_LIST_texels] = FILM_TEXTURES,
    [WORLD_LIST_linear_of_srgb] = FILM_TEXTURES,
    [WORLD_LIST_sky_texels] = FILM_LIGHT,
    [WORLD_LIST_nodes] = FILM_GEOMETRY,
    [WORLD_LIST_leaf_tris] = FILM_GEOMETRY,
    [WORLD_LIST_lights] = FILM_LIGHT,
    [WORLD_LIST_tri_lights] = FILM_LIGHT,
    [WORLD_LIST_light_nodes] = FILM_LIGHT,
    [WORLD_LIST_sky_cdf] = FILM_LIGHT,
    [WORLD_LIST_guide_cells] = FILM_GUIDE,
    [WORLD_LIST_guide_cdf] = FILM_GUIDE,
    [WORLD_LIST_point_lights] = FILM_LIGHT,
    [WORLD_LIST_directional_lights] = FILM_LIGHT,
    [WORLD_LIST_profiles] = FILM_LIGHT,
    [WORLD_LIST_caustic_nodes] = FILM_GUIDE,
    [WORLD_LIST_caustic_lobes] = FILM_GUIDE,
};

static void add(uint64_t *hash, const void *bytes, size_t size)
{
    *hash = hash_bytes(*hash, bytes, size);
}

static void add_settings(const struct settings *s, uint64_t hashes[FILM_PARTS])
{
    add(&hashes[FILM_CAMERA], &s->camera, sizeof s->camera);
    add(&hashes[FILM_LIGHT], &s->sky, sizeof s->sky);
    add(&hashes[FILM_LIGHT], &s->sky_share, sizeof s->sky_share);
    add(&hashes[FILM_LIGHT], &s->light_share, sizeof s->light_share);
    add(&hashes[FILM_LIGHT], &s->sky_power, sizeof s->sky_power);
    add(&hashes[FILM_LIMITS], &s->max_vertices, sizeof s->max_vertices);
    add(&hashes[FILM_LIMITS], &s->direct, sizeof s->direct);
    add(&hashes[FILM_LIMITS], &s->order, sizeof s->order);
    add(&hashes[FILM_LIMITS], &s->sample, sizeof s->sample);
    add(&hashes[FILM_GUIDE], &s->guide, sizeof s->guide);
}

void world_hash(const struct world *w, uint64_t hashes[FILM_PARTS])
{
    struct world_array list[WORLD_LIST_COUNT];

    for (int i = 0; i < FILM_PARTS; i++)
        hashes[i] = HASH_BEGIN;
    world_list(w, list);
    for (int i = 0; i < WORLD_LIST_COUNT; i++) {
        uint64_t *hash = &hashes[film_parts[i]];

        *hash = hash_number(*hash, list[i].size_bytes);
        add(hash, list[i].data, list[i].size_bytes);
    }
    add_settings(&w->settings, hashes);
}
