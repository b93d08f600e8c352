// SPDX-License-Identifier: MIT
/*
 * gltf_vertices.h - the vertices of one primitive: positions, normals, texture
 * coordinates and colours, bent by morph targets and joints
 *
 * Threads:   one for each scene, and those of the pool
 * Errors:    a joint that the skin does not have
 */
#ifndef GLIM_GLTF_VERTICES_H
#define GLIM_GLTF_VERTICES_H

#include "read/gltf/gltf_primitive.h"

/* Adds the vertices to the scene, whose arrays have room for them. Normals have
 * unit length, or are 0 if the file's are unusable. */
bool gltf_vertices_add(const struct gltf_value *value,
                       const struct gltf_primitive *p,
                       const struct gltf_shape *shape, struct scene *scene,
                       struct pool *pool, struct error *err);

#endif
