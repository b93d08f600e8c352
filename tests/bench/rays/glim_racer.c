// SPDX-License-Identifier: MIT
/* Queries of glim, built for an instruction set; RACER is the name of the
 * struct. */
#include "racer.h"

#include "world/bvh/ray_queries.h"

#ifndef RACER
#define RACER racer_plain
#endif

static void closest(const void *tree, const struct ray *rays, uint32_t count,
                    struct answer *answers)
{
    const struct world *w = tree;
    struct hit h;

    for (uint32_t i = 0; i < count; i++) {
        hit_closest(w, rays[i], &h);
        answers[i] = (struct answer){h.t, h.tri};
    }
}

static void any(const void *tree, const struct ray *rays, uint32_t count,
                struct answer *answers)
{
    const struct world *w = tree;

    for (uint32_t i = 0; i < count; i++) {
        bool found = hit_any(w, rays[i], NO_INDEX);

        answers[i] = (struct answer){0.0f, found ? 0 : NO_INDEX};
    }
}

static void coherent(const void *tree, const struct ray *rays, uint32_t count,
                     struct answer *answers)
{
    const struct world *w = tree;
    struct hit hits[PACKET_RAYS];

    for (uint32_t i = 0; i < count; i += PACKET_RAYS) {
        uint32_t left = count - i;
        uint32_t lanes = left < PACKET_RAYS ? left : PACKET_RAYS;

        hits_closest(w, rays + i, lanes, hits);
        for (uint32_t k = 0; k < lanes; k++)
            answers[i + k] = (struct answer){hits[k].t, hits[k].tri};
    }
}

const struct racer RACER = {NULL, closest, any, coherent, {0.0, 0.0}, 0.0};
