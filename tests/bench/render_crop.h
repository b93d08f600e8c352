// SPDX-License-Identifier: MIT
/*
 * render_crop.h - renders a part of a session's picture and waits for it
 *
 * Units:     pixels, samples per pixel
 * Errors:    those of world_lend() and render_start()
 */
#ifndef TESTS_RENDER_CROP_H
#define TESTS_RENDER_CROP_H

#include "scene/world.h"
#include "session/session.h"

/* More features than the scene's select another kernel; the light is the same.
 */
static inline bool render_crop(struct session *s, struct rect crop,
                               uint64_t spp, uint32_t seed,
                               uint32_t more_features, struct error *err)
{
    struct render_job job = {.host = &s->world,
                             .crop = crop,
                             .limits.spp = spp};

    if (!world_lend(&s->world, &s->scene, &s->edit.now.view, seed, &job.world,
                    err))
        return false;
    job.world.settings.features |= more_features;
    if (!render_start(s->render, &job, err))
        return false;
    return render_wait(s->render, -1);
}

#endif
