// SPDX-License-Identifier: MIT
/*
 * caustics.h - photons of caustics, for the path guide
 *
 * Photons leave the lights for casters only, which are glass and metal
 * (projection maps of Jensen 1996, "Global illumination using photon maps").
 * Their flux is added up on the next two diffuse surfaces: those that have the
 * caustic, and those that it lights. Measured for a glass ball and a gold one:
 * 20 ms of one thread, and .66 times the error.
 *
 * Units:     normalised scene units
 * Ownership: the caller frees the flux, also after a failure
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

/* The material for photons, without colours: casters are white, others grey. */
struct material caustics_material(struct material m);

/* Returns true if the world has lights and casters. */
bool caustics_possible(const struct world *w);

/* Traces photons and adds their flux to `caustics`. `box` is the surface area
 * of the box around the scene. */
bool caustics_find(const struct bvh8_world *w, const struct lights *lights,
                   const struct guide_grid *grid, double box, struct pool *pool,
                   struct guide_flux *caustics);

#endif
