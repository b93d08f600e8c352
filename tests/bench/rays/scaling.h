// SPDX-License-Identifier: MIT
/*
 * scaling.h - the cost of a ray by the number of triangles
 *
 * Units:     seconds
 * Threads:   all build, one traces
 * Errors:    memory
 */
#ifndef RAYS_SCALING_H
#define RAYS_SCALING_H

#include "base/error.h"
#include "racer.h"

/* Prints times of glim's rays in terrains of 1,000 to 10 million triangles, and
 * the increase per doubling. The racer's tree is not read. */
bool scaling_run(const struct racer *racer, struct error *err);

#endif
