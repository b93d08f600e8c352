// SPDX-License-Identifier: MIT
#include "engine/engine_film.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/version.h"
#include "picture/film_file.h"
#include "scene/world_hash.h"
#include "opencl/cl_source.h"

/* ---- what decides the samples ---- */

bool engine_film_describe(struct engine *e, const struct view *view,
                          struct film_identity *id, struct world *world,
                          struct error *err)
{
    float exposure = (float)view->lighting.exposure;

    if (!world_guide(&e->world, &e->scene, view, err) ||
        !world_lend(&e->world, &e->scene, view, e->options.seed, world, err))
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
             end_of(e->options.scene_path, sizeof h.scene));
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
