// SPDX-License-Identifier: MIT
/*
 * mesh_transform.h - moves the vertices of a mesh by the matrix of an instance
 *
 * Units:     file units
 * Threads:   those of the pool
 */
#ifndef GLIM_MESH_TRANSFORM_H
#define GLIM_MESH_TRANSFORM_H

#include "scene/scene.h"

/* Moves as many vertices and normals as the mesh has, from these indices on.
 * Returns true if the matrix mirrors. */
bool mesh_transform(struct scene *scene, const struct affine *matrix,
                    const struct scene_mesh *mesh, uint32_t first_position,
                    uint32_t first_normal, struct pool *pool);

/* Exchanges two corners, and so the sides of the face. */
void tri_turn_over(struct tri *t);

#endif
