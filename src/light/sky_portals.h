// SPDX-License-Identifier: MIT
/*
 * sky_portals.h - through which windows and doors the sky is seen
 *
 * From places on all surfaces rays look around. Of those that see the sky in
 * few directions (a room; not what stands in the open, where any direction will
 * do) the looks that found it mark where its openings are, and from each such
 * place rays are aimed at these marks: what arrives is counted. As the table
 * decides only where to look, marks lie simply where looks left the box around
 * the scene. What else lights a place is guessed from what its looks have met:
 * whether that sees the sky, and of what colour it is.
 *
 * Measured: light samples that are led there leave .5 times the variance in
 * rooms of albedo .5, .7 times in one of .9, .35 under the image of a sky;
 * paths that are led behind panes .6 times; 30 ms of one thread.
 *
 * Units:     normalised scene units; flux as the sky's part of the cosine
 *            weighted hemisphere
 * Ownership: sky_portals_free() frees, also if the search fails; a zeroed
 * struct is one that was not made Threads:   those of the pool, or without one
 * the caller's Errors:    memory, by false
 */
#ifndef GLIM_SKY_PORTALS_H
#define GLIM_SKY_PORTALS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/thread_pool.h"
#include "bvh/bvh8.h"
#include "light/guide_grid.h"

struct sky_portals {
    struct guide_flux open;   /* for light samples; NULL: not searched for */
    struct guide_flux glazed; /* behind panes, where none of these arrive; NULL:
                                 there is no glass */
    float *bounced; /* of each cell: what comes by one wall if all are white */
    struct hit *walls; /* some places of surfaces that are not in the open */
    uint32_t wall_count;
    double escape; /* how much of what leaves a wall meets no other */
};

/* The sky shines 1 from everywhere. */
bool sky_portals_find(const struct bvh8_world *w, const struct guide_grid *grid,
                      struct pool *pool, struct sky_portals *portals);

/* All light that comes by walls as a multiple of `bounced`: the walls' colours
 * may be others than when they were found. */
double sky_portals_bounces(const struct sky_portals *portals,
                           const struct world *w);

void sky_portals_free(struct sky_portals *portals);

#endif
