// SPDX-License-Identifier: MIT
#include "scene/world_hash.h"

#include <stddef.h>

#include "base/hash.h"

#include "kernels/guide.h"

/* A new array of the world is hashed below, unless it only decides the speed.
 */
_Static_assert(sizeof(struct world) - offsetof(struct world, positions) ==
                   24 * sizeof(void *),
               "world_hash() knows all arrays");

static uint64_t hash_array(uint64_t hash, const void *items, size_t count,
                           size_t size_bytes)
{
    size_t size = items != NULL ? count * size_bytes : 0;

    return hash_bytes(hash_number(hash, size), items, size);
}

static uint64_t hash_geometry(const struct world *w)
{
    const struct settings *s = &w->settings;
    uint64_t h = HASH_BEGIN;

    h = hash_array(h, w->positions, s->position_count, sizeof *w->positions);
    h = hash_array(h, w->normals, s->normal_count, sizeof *w->normals);
    h = hash_array(h, w->uvs, s->uv_count, sizeof *w->uvs);
    h = hash_array(h, w->colors, s->color_count, sizeof *w->colors);
    return hash_array(h, w->tris, s->tri_count, sizeof *w->tris);
}

static uint64_t hash_textures(const struct world *w)
{
    const struct settings *s = &w->settings;
    uint64_t h = HASH_BEGIN;

    h = hash_array(h, w->textures, s->texture_count, sizeof *w->textures);
    h = hash_array(h, w->texels, s->texel_count, sizeof *w->texels);
    return hash_array(h, w->linear_of_srgb, 256, sizeof *w->linear_of_srgb);
}

static uint64_t hash_light(const struct world *w)
{
    const struct settings *s = &w->settings;
    const struct sky *sky = &s->sky;
    uint64_t h = hash_bytes(HASH_BEGIN, sky, sizeof *sky);

    h = hash_array(h, w->sky_texels, (size_t)sky->width * sky->height,
                   sizeof *w->sky_texels);
    h = hash_array(h, w->sky_cdf, s->sky_cdf_count, sizeof *w->sky_cdf);
    h = hash_array(h, w->lights, s->light_count, sizeof *w->lights);
    h = hash_array(h, w->light_nodes, s->light_node_count,
                   sizeof *w->light_nodes);
    h = hash_array(h, w->point_lights, s->point_light_count,
                   sizeof *w->point_lights);
    h = hash_array(h, w->directional_lights, s->directional_light_count,
                   sizeof *w->directional_lights);
    h = hash_array(h, w->profiles, s->profile_value_count, sizeof *w->profiles);
    h = hash_bytes(h, &s->sky_share, sizeof s->sky_share);
    h = hash_bytes(h, &s->light_share, sizeof s->light_share);
    return hash_bytes(h, &s->sky_power, sizeof s->sky_power);
}

static uint64_t hash_limits(const struct settings *s)
{
    uint64_t h = HASH_BEGIN;

    h = hash_number(h, s->max_vertices);
    h = hash_number(h, s->direct);
    h = hash_number(h, s->order);
    return hash_number(h, s->sample);
}

static uint64_t hash_guide(const struct world *w)
{
    const struct settings *s = &w->settings;
    const struct guide_grid *g = &s->guide;
    size_t cubes = (size_t)g->width * g->height * g->depth;
    uint64_t h = hash_bytes(HASH_BEGIN, g, sizeof *g);

    h = hash_array(h, w->guide_cells, cubes * GUIDE_FACINGS,
                   sizeof *w->guide_cells);
    h = hash_array(h, w->guide_cdf, (size_t)g->table_count * GUIDE_BINS,
                   sizeof *w->guide_cdf);
    h = hash_bytes(h, s->caustic_grids, sizeof s->caustic_grids);
    h = hash_array(h, w->caustic_cells, s->caustic_cell_count,
                   sizeof *w->caustic_cells);
    h = hash_array(h, w->caustic_groups, s->caustic_group_count,
                   sizeof *w->caustic_groups);
    return hash_array(h, w->caustic_bins, s->caustic_bin_count,
                      sizeof *w->caustic_bins);
}

void world_hash(const struct world *w, uint64_t hashes[FILM_PARTS])
{
    const struct settings *s = &w->settings;

    hashes[FILM_GEOMETRY] = hash_geometry(w);
    hashes[FILM_MATERIALS] =
        hash_array(HASH_BEGIN, w->materials, s->material_count,
                   sizeof *w->materials);
    hashes[FILM_TEXTURES] = hash_textures(w);
    hashes[FILM_LIGHT] = hash_light(w);
    hashes[FILM_CAMERA] = hash_bytes(HASH_BEGIN, &s->camera, sizeof s->camera);
    hashes[FILM_LIMITS] = hash_limits(s);
    hashes[FILM_GUIDE] = hash_guide(w);
}
