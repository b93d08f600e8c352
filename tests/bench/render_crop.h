// SPDX-License-Identifier: MIT
/*
 * render_crop.h - renders a part of a session's picture and waits for it
 *
 * Units:     pixels, samples per pixel
 * Errors:    those of world_lend() and render_start()
 */
#ifndef TESTS_RENDER_CROP_H
#define TESTS_RENDER_CROP_H

#include "session/session.h"
#include "world/world.h"

/* More features than the scene's select another kernel; the light is the same.
 */
static inline bool render_crop(struct session *s, struct rect crop,
                               uint64_t spp, uint32_t seed,
                               uint64_t more_features, struct error *err)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = crop,
                             .limits.spp = spp};

    if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view, seed,
                    &job.world, err))
        return false;
    job.world.settings.features |= more_features;
    if (!render_start(s->engine.render, &job, err))
        return false;
    return render_wait(s->engine.render, -1);
}

#endif
