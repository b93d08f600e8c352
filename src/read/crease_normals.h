// SPDX-License-Identifier: MIT
/*
 * crease_normals.h - smooth normals for meshes that have none
 *
 * Two faces belong together at a corner if they share an edge there, run
 * through it in opposite directions and meet at less than 40 degrees. All that
 * are joined by such edges get one normal there: the mean of theirs, weighted
 * by the angles of the corners (Thuermer and Wuethrich 1998), which does not
 * depend on how faces are cut into triangles. Corners are at the same place if
 * their coordinates are equal, whatever their vertices are.
 *
 * Units:     file units
 * Ownership: the normals belong to the scene
 * Threads:   one for each scene, and those of the pool
 * Errors:    false when memory is out
 */
#ifndef GLIM_CREASE_NORMALS_H
#define GLIM_CREASE_NORMALS_H

#include "base/thread_pool.h"
#include "scene/scene.h"

/* Gives normals to the triangles of a scene without any, before
 * scene_finish(). Triangles that stay flat get none. `pool` may be NULL. */
bool crease_normals(struct scene *scene, struct pool *pool);

#endif
