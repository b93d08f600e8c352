// SPDX-License-Identifier: MIT
/*
 * collision.h - moves of the camera that surfaces stop
 *
 * The eye is a point. Each part of its way is tested against the tree, and it
 * stops COLLISION_MARGIN before a surface. An eye that is nearer than that, or
 * inside of a thing, can move in every direction that is free.
 *
 * Units:     file units of the scene
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_COLLISION_H
#define GLIM_COLLISION_H

#include "studio/surfaces.h"

/* Distance that the eye keeps from surfaces, relative to the size of the scene.
 * It is 1000 times the rounding error of rays, and lets the eye through a gap
 * of 2 cm in a scene of 100 m. */
#define COLLISION_MARGIN 1e-4

/* Moves from `from` towards `to`, slides along the surfaces before it, and sets
 * `to` to the end. Returns true, with the object that is in the way, if a
 * surface takes most of the motion. */
bool collision_slide(const struct surfaces *s, const double from[3],
                     double to[3], uint32_t *object);

/* Moves the eye of an orbit around the pivot from `from` to `to`, which has the
 * same distance to the pivot. Comes nearer to the pivot where a surface is in
 * the way, and goes back to `distance` from it where none is. Sets `to` to the
 * end. Returns false if no way is free. */
bool collision_orbit(const struct surfaces *s, const double pivot[3],
                     double distance, const double from[3], double to[3]);

#endif
