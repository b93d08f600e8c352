// SPDX-License-Identifier: MIT
#include "engine/engine_film.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "engine/engine_metadata.h"
#include "film/film_file.h"
#include "glim/version.h"
#include "render/opencl/cl_source.h"
#include "world/world.h"
#include "kernels/types.h"

/* ---- hash of the world ---- */

/*
 * All that decides the bits of samples counts, and nothing else: files with
 * other comments, in other folders, or in other formats make equal worlds.
 * Trees and features, which only decide the speed, do not count.
 */

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
    [WORLD_LIST_roots] = FILM_GEOMETRY,
    [WORLD_LIST_lights] = FILM_LIGHT,
    [WORLD_LIST_tri_lights] = FILM_LIGHT,
    [WORLD_LIST_light_nodes] = FILM_LIGHT,
    [WORLD_LIST_sky_cdf] = FILM_LIGHT,
    [WORLD_LIST_guide_cells] = FILM_GUIDE,
    [WORLD_LIST_guide_cdf] = FILM_GUIDE,
    [WORLD_LIST_point_lights] = FILM_LIGHT,
    [WORLD_LIST_directional_lights] = FILM_LIGHT,
    [WORLD_LIST_profiles] = FILM_LIGHT,
    [WORLD_LIST_smokes] = FILM_LIGHT,
    [WORLD_LIST_voxel_places] = FILM_LIGHT,
    [WORLD_LIST_voxels] = FILM_LIGHT,
    [WORLD_LIST_glows] = FILM_LIGHT,
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
    add(&hashes[FILM_LIGHT], &s->fog, sizeof s->fog);
    add(&hashes[FILM_LIMITS], &s->max_vertices, sizeof s->max_vertices);
    add(&hashes[FILM_LIMITS], &s->direct, sizeof s->direct);
    add(&hashes[FILM_LIMITS], &s->order, sizeof s->order);
    add(&hashes[FILM_LIMITS], &s->sample, sizeof s->sample);
    add(&hashes[FILM_LIMITS], &s->has_light_cells, sizeof s->has_light_cells);
    add(&hashes[FILM_GUIDE], &s->guide, sizeof s->guide);
}

/* Sets the hashes of a lent world, except that of the kernels. */
static void world_hash(const struct world *w, uint64_t hashes[FILM_PARTS])
{
    struct world_array list[WORLD_LIST_COUNT];

    for (int i = 0; i < FILM_PARTS; i++)
        hashes[i] = HASH_BEGIN;
    world_list(w, list);
    for (int i = 0; i < WORLD_LIST_COUNT; i++) {
        uint64_t *hash = &hashes[film_parts[i]];

        *hash = hash_number(*hash, list[i].size_bytes);
        *hash = hash_array(*hash, list[i].data, list[i].size_bytes);
    }
    add_settings(&w->settings, hashes);
}

/* ---- what decides the samples ---- */

bool engine_film_describe(struct engine *e, const struct view *view,
                          struct film_identity *id, struct world *world,
                          struct error *err)
{
    float exposure = (float)view->lighting.exposure;

    if (!world_guide(&e->world, &e->scene, view, err) ||
        !engine_lend(e, view, world, err))
        return false;
    *id = (struct film_identity){
        .seed = e->options.seed,
        .picture_width = view->width_px,
        .picture_height = view->height_px,
        .x = e->crop.x,
        .y = e->crop.y,
        .width = e->crop.width,
        .height = e->crop.height,
        .has_surfaces = e->options.wants_filter,
        .is_adaptive = e->options.is_adaptive,
    };
    memcpy(&id->exposure_bits, &exposure, sizeof exposure);
    return true;
}

bool engine_film_hash(const struct world *world, const char *kernels_path,
                      struct film_identity *id, struct error *err)
{
    char *kernels = cl_source_text(kernels_path, err);

    if (kernels == NULL)
        return false;
    world_hash(world, id->hashes);
    id->hashes[FILM_KERNELS] = cl_source_hash(kernels);
    free(kernels);
    return true;
}

bool engine_film_identify(struct engine *e, const struct view *view,
                          struct film_identity *id, struct error *err)
{
    struct world world;

    return engine_film_describe(e, view, id, &world, err) &&
           engine_film_hash(&world, e->options.device.kernels_path, id, err);
}

/* ---- head and file ---- */

/* Returns the end of a path that fits, from a character on. */
static const char *end_of(const char *path, size_t size_bytes)
{
    size_t length = strlen(path);

    if (length >= size_bytes)
        path += length - size_bytes + 1;
    while ((*path & 0xc0) == 0x80)
        path++;
    return path;
}

struct film_header engine_film_header(const struct engine *e,
                                      const struct view *view,
                                      uint64_t first_sample, uint64_t total,
                                      struct film_range *range)
{
    struct render_progress p = render_progress(e->render);
    struct film_header h = {.ranges = range,
                            .range_count = 1,
                            .total = total,
                            .tone = view->lighting.tone,
                            .render_ns = p.render_ns,
                            .samples = p.samples,
                            .rays = p.rays,
                            .non_finite = p.non_finite,
                            .saturated = p.saturated,
                            .cut_paths = p.cut_paths};

    snprintf(h.version, sizeof h.version, "%s", GLIM_VERSION);
    snprintf(h.scene, sizeof h.scene, "%s",
             end_of(e->options.scene.path, sizeof h.scene));
    engine_metadata_write_view(e, view, h.view);
    *range = (struct film_range){first_sample, first_sample + p.spp_done};
    return h;
}

static const uint16_t *shares_of(void *render)
{
    return render_shares(render);
}

bool engine_film_write(const struct engine *e, const char *path,
                       const struct film_header *h, struct error *err)
{
    return film_file_write(path, h, render_film(e->render), shares_of,
                           e->render, err);
}
