// SPDX-License-Identifier: MIT
/*
 * caustics.h - where light comes from through glass and off mirrors
 *
 * Photons leave the lights for the glass and the mirrors alone (the projection
 * maps of Jensen 1996, "Global illumination using photon maps"), go through,
 * and are counted on the two next diffuse surfaces: the caustic, and what it
 * lights. Measured for a glass ball and a gold one: 20 ms of one thread and .66
 * times the error.
 *
 * Units:     normalised scene units
 * Ownership: the caller's, also if it fails
 * Threads:   those of the pool, or without one the caller's
 * Errors:    memory, by false
 */
#ifndef GLIM_CAUSTICS_H
#define GLIM_CAUSTICS_H

#include <stdbool.h>

#include "base/thread_pool.h"
#include "bvh/bvh8_traverse.h"
#include "light/guide_grid.h"
#include "light/lights.h"

/* The material as photons see it, without colours: what they come from is
 * white, the rest grey. */
struct material caustics_material(struct material m);

/* Do any lights of the world have something to shine through, or on? */
bool caustics_possible(const struct world *w);

/* `box` is the surface of the box around the scene. */
bool caustics_find(const struct bvh8_world *w, const struct lights *lights,
                   const struct guide_grid *grid, double box, struct pool *pool,
                   struct guide_flux *part);

#endif
