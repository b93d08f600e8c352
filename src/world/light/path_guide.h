// SPDX-License-Identifier: MIT
/*
 * path_guide.h - the path guide: tables of directions to the sky that is seen
 * through portals (sky_portals.h)
 *
 * kernels/guide.h samples the tables and weights the samples,
 * so that errors of the tables cost time but add no bias. The guide depends on
 * the scene and its sky, not on the camera.
 *
 * Units:     normalised scene units, radiance
 * Ownership: path_guide_free() frees; a zeroed struct has no tables
 * Threads:   one thread updates, with the threads of a pool if there is one,
 *            while nothing renders; read only otherwise
 * Errors:    memory
 */
#ifndef GLIM_PATH_GUIDE_H
#define GLIM_PATH_GUIDE_H

#include <stdbool.h>

#include "base/error.h"
#include "world/light/lights.h"
#include "world/light/sky_portals.h"

struct path_guide {
    struct guide_cell *cells; /* see kernels/guide.h; NULL if there are none */
    float *sums;
    struct guide_grid grid;
    struct sky_portals portals; /* of which the tables are made */
    double lights; /* mean irradiance by all lights on the box / pi */
    double sky;    /* mean radiance of the sky for which cells are */
    bool is_current;
};

/* Returns true if there are tables of any kind. */
bool path_guide_has_tables(const struct path_guide *guide);

/* Returns true if the table suits a sky of this mean radiance, and nothing has
 * changed since it was made. */
bool path_guide_is_current(const struct path_guide *guide, double sky);

/* Returns true if path_guide_update() has to trace rays, for which it needs a
 * tree. */
bool path_guide_needs_rays(const struct path_guide *guide,
                           const struct world *world, double sky);

/* Updates the tables for a world, its lights, which it has been lent, and a sky
 * of this mean radiance. Searches only what has not been searched since
 * path_guide_outdate(). The old arrays are freed when the new ones are ready.
 */
bool path_guide_update(struct path_guide *guide, const struct world *world,
                       const struct lights *lights, double sky,
                       struct pool *pool, struct error *err);

/* Call this when the world has changed in geometry or in how rays scatter. */
void path_guide_outdate(struct path_guide *guide);

/* Call this when only colours have changed. */
void path_guide_recolor(struct path_guide *guide);

/* Returns true if a change from one material to the other changes the rays of
 * the search. */
bool path_guides_differ(const struct material *a, const struct material *b);

/* Lends the tables to the world. */
void path_guide_lend(const struct path_guide *guide, struct world *world);

void path_guide_free(struct path_guide *guide);

#endif
