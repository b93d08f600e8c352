// SPDX-License-Identifier: MIT
#include "render/film_describe.h"

#include <stdio.h>
#include <string.h>

#include "glim/version.h"

#include "kernels/features.h"

struct film_identity film_describe_identity(const struct view *view,
                                            struct rect crop, uint32_t seed,
                                            uint32_t features, bool is_adaptive)
{
    float exposure = (float)view->lighting.exposure;
    struct film_identity id = {
        .seed = seed,
        .picture_width = view->width_px,
        .picture_height = view->height_px,
        .x = crop.x,
        .y = crop.y,
        .width = crop.width,
        .height = crop.height,
        .has_surfaces = (features & FEATURE_FILTER) != 0,
        .is_adaptive = is_adaptive,
    };

    memcpy(&id.exposure_bits, &exposure, sizeof exposure);
    return id;
}

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

struct film_header film_describe_header(const struct render_progress *p,
                                        const char *scene_path,
                                        uint64_t first_sample, uint64_t total,
                                        struct film_range *range)
{
    struct film_header h = {.ranges = range,
                            .range_count = 1,
                            .total = total,
                            .render_ns = p->render_ns,
                            .samples = p->samples,
                            .rays = p->rays,
                            .non_finite = p->non_finite,
                            .saturated = p->saturated,
                            .cut_paths = p->cut_paths};

    snprintf(h.version, sizeof h.version, "%s", GLIM_VERSION);
    snprintf(h.scene, sizeof h.scene, "%s", end_of(scene_path, sizeof h.scene));
    *range = (struct film_range){first_sample, first_sample + p->spp_done};
    return h;
}
