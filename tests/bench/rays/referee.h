// SPDX-License-Identifier: MIT
/*
 * referee.h - the true hit of a ray, where two programs differ
 *
 * All triangles that a ray may hit are tested in numbers of 113 binary digits.
 * The corners of instances are exact, or rounded to floats as glim's.
 *
 * Threads:   one
 */
#ifndef REFEREE_H
#define REFEREE_H

#include "racer.h"

/* Distances of a hit and of the true one are the same within this part of the
 * distance, and of the coordinates of its origin, which are rounded. */
#define T_TOLERANCE 1e-5f
#define T_ROUNDING  0x1p-23f

/* Returns true if the distances are the same; that of no hit is FLT_MAX. */
bool referee_is_same(float a, float b);

/* Returns the distance of the true closest hit, or FLT_MAX if there is none.
 * The ray may hit the triangle that it has left, if it is really before it. */
float referee_distance(const struct world *world, const struct ray *ray,
                       bool is_rounded);

#endif
