// SPDX-License-Identifier: MIT
/*
 * sky_portals.h - portals: the windows and doors through which the sky is seen
 *
 * Probes on all surfaces trace rays. A probe whose rays see the sky in few
 * directions is enclosed, as in a room. (In the open any direction will do.)
 * The rays of enclosed probes that see the sky give portal points, where they
 * leave the box around the scene: any points behind the portals will do, as the
 * guide only proposes directions. Then portal rays are traced from each
 * enclosed probe to portal points, and those that arrive are the flux from the
 * sky. Light that bounces is estimated from the surfaces that probe rays hit:
 * whether they see the sky, and their colours.
 *
 * Measured: guided light samples have .5 times the variance in rooms of albedo
 * .5, .7 times in one of .9, .35 times under a sky image; paths that are guided
 * to panes of glass .6 times; 30 ms of one thread.
 *
 * Units:     normalised scene units; flux as the sky's part of the
 *            cosine-weighted hemisphere
 * Ownership: sky_portals_free() frees, also if the search fails; a zeroed
 *            struct has not been searched for
 * Threads:   those of the pool, or without one the caller's
 * Errors:    memory, by false
 */
#ifndef GLIM_SKY_PORTALS_H
#define GLIM_SKY_PORTALS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/thread_pool.h"
#include "world/bvh/bvh8.h"
#include "world/light/guide_grid.h"

struct sky_portals {
    struct guide_flux open;   /* for light samples; flux NULL before a search */
    struct guide_flux glazed; /* for paths through panes; flux NULL if none */
    float *bounced;    /* of each cell: light by one bounce if all is white */
    struct hit *walls; /* hits on surfaces of enclosed probes */
    uint32_t wall_count;
    double escape; /* share of bounced light that meets no surface */
};

/* Searches, with a sky of radiance 1 in all directions. grid and overlap are of
 * guide_grid_init(). */
bool sky_portals_find(const struct world *w, const struct guide_grid *grid,
                      double overlap, struct pool *pool,
                      struct sky_portals *portals);

/* Returns the light of all bounces as a multiple of `bounced`. The colours of
 * the walls may have changed since the search. */
double sky_portals_bounces(const struct sky_portals *portals,
                           const struct world *w);

void sky_portals_free(struct sky_portals *portals);

#endif
