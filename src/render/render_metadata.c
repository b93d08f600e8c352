// SPDX-License-Identifier: MIT
#include "render/render_metadata.h"

#include <inttypes.h>

#include "base/clock.h"
#include "base/file.h"
#include "glim/version.h"

static const char *const limits[] = {
    [RENDER_LIMIT_SPP] = "samples",
    [RENDER_LIMIT_ERROR] = "error",
    [RENDER_LIMIT_TIME] = "time",
};

const char *render_limit_name(enum render_limit limit)
{
    return limits[limit];
}

static void add_error(struct image_metadata *m, const struct film_error *e)
{
    if (!e->is_known)
        return;
    image_metadata_add(m, "glim:error", "%.6g", e->error);
    image_metadata_add(m, "glim:error_low", "%.6g", e->low);
    image_metadata_add(m, "glim:error_high", "%.6g", e->high);
    image_metadata_add(m, "glim:resolved", "%s",
                       e->is_resolved ? "true" : "false");
}

struct image_metadata render_metadata(const struct render_progress *p,
                                      const char *scene_path, uint32_t seed,
                                      bool is_denoised)
{
    struct image_metadata m = {.count = 0};

    image_metadata_add(&m, IMAGE_KEY_SOFTWARE, "glim %s", GLIM_VERSION);
    image_metadata_add(&m, "glim:scene", "%s", path_name(scene_path));
    image_metadata_add(&m, "glim:seed", "%" PRIu32, seed);
    image_metadata_add(&m, "glim:spp", "%" PRIu64, p->spp_done);
    add_error(&m, &p->film_error);
    if (p->stopped_by != RENDER_LIMIT_NONE)
        image_metadata_add(&m, "glim:stopped_by", "%s",
                           render_limit_name(p->stopped_by));
    if (p->stopped_by == RENDER_LIMIT_TIME)
        image_metadata_add(&m, "glim:time_s", "%.3f",
                           seconds_between(0, p->render_ns));
    if (is_denoised)
        image_metadata_add(&m, "glim:denoised", "true");
    return m;
}
