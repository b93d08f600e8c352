// SPDX-License-Identifier: MIT
/*
 * path_guide.h - the table of directions that light comes from which is hard to
 * find
 *
 * Caustics (caustics.h), and the sky where it is seen through openings
 * (sky_portals.h). The table only says where to look, kernels/guide.h weighs
 * what is found: that it is made of few rays costs time and no truth. A
 * function of the scene and its sky, not of the eye.
 *
 * Units:     normalised scene units, radiance
 * Ownership: path_guide_free() frees; a zeroed struct is a scene without a
 * table Threads:   one thread updates, with those of a pool, if it has one,
 * while nobody renders; read only otherwise Errors:    memory
 */
#ifndef GLIM_PATH_GUIDE_H
#define GLIM_PATH_GUIDE_H

#include <stdbool.h>

#include "base/error.h"
#include "light/lights.h"
#include "light/sky_portals.h"

struct path_guide {
    struct guide_cell
        *cells; /* as kernels/guide.h reads them; NULL: there are none */
    float *sums;
    struct guide_grid grid;
    /* what they are made of */
    struct guide_flux caustics; /* NULL: not searched for */
    struct sky_portals portals;
    double lights; /* mean radiance that all lights would shed on a box */
    double sky;    /* that the cells suit */
    bool is_current;
};

/* Would path_guide_update() trace rays? Else it needs no tree. */
bool path_guide_needs_rays(const struct path_guide *guide,
                           const struct world *world, double sky);

/* Brings the table to what suits the world, its lights, which it has been lent,
 * and a sky of this mean radiance. Searches only for what the scene has not
 * been searched for since path_guide_outdate(). Arrays that were lent live
 * until the new ones do.
 */
bool path_guide_update(struct path_guide *guide, const struct bvh8_world *world,
                       const struct lights *lights, double sky,
                       struct pool *pool, struct error *err);

/* The world is another. */
void path_guide_outdate(struct path_guide *guide);

/* Only colours are. */
void path_guide_recolor(struct path_guide *guide);

/* Of two materials: would the rays meet or do anything else? */
bool path_guides_differ(const struct material *a, const struct material *b);

/* Lends the table to the world. */
void path_guide_lend(const struct path_guide *guide, struct world *world);

void path_guide_free(struct path_guide *guide);

#endif
