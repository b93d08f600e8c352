// SPDX-License-Identifier: MIT
#include "render/render_metadata.h"

#include <inttypes.h>
#include <stdio.h>

#include "base/clock.h"
#include "base/decimal.h"
#include "base/file.h"
#include "glim/version.h"

static const char key_of_identity[] = "glim:identity";

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

struct image_metadata render_metadata_film(const struct render_progress *p,
                                           const struct film_header *h,
                                           bool is_denoised)
{
    const struct film_identity *id = &h->identity;
    struct image_metadata m =
        render_metadata(p, h->scene, id->seed, is_denoised);

    if (h->ranges[0].first != 0)
        image_metadata_add(&m, "glim:first_sample", "%" PRIu64,
                           h->ranges[0].first);
    if (id->width != id->picture_width || id->height != id->picture_height)
        image_metadata_add(&m, "glim:crop", "%d,%d,%d,%d", id->x, id->y,
                           id->width, id->height);
    if (id->is_adaptive)
        image_metadata_add(&m, "glim:adaptive", "true");
    if (h->view[0] != '\0')
        image_metadata_add(&m, "glim:view", "%s", h->view);
    return m;
}

void render_metadata_identify(struct image_metadata *m,
                              const struct film_identity *id)
{
    char text[17 * FILM_PARTS + 1];

    for (int i = 0; i < FILM_PARTS; i++)
        snprintf(text + 17 * i, 18, "%016" PRIx64 " ", id->hashes[i]);
    text[sizeof text - 2] = '\0';
    image_metadata_add(m, key_of_identity, "%s", text);
}

bool render_metadata_identity(const struct image_metadata *m,
                              struct film_identity *id)
{
    const char *p = image_metadata_value(m, key_of_identity);

    for (int i = 0; p != NULL && i < FILM_PARTS; i++) {
        if (!digits_parse(&p, 16, UINT64_MAX, &id->hashes[i]) ||
            *p != (i + 1 < FILM_PARTS ? ' ' : '\0'))
            return false;
        p++;
    }
    return p != NULL;
}
