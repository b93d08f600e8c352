// SPDX-License-Identifier: MIT
/*
 * gltf_instancing.h - a mesh of a node, once or as EXT_mesh_gpu_instancing says
 *
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene
 * Errors:    memory; attributes that do not fit
 */
#ifndef GLIM_GLTF_INSTANCING_H
#define GLIM_GLTF_INSTANCING_H

#include "base/geometry.h"
#include "gltf/gltf_value.h"
#include "scene/scene.h"

/* Places a mesh of the scene by the matrix, once or for each instance that the
 * node lists. */
bool gltf_instances_add(const struct gltf_value *node, struct scene *scene,
                        uint32_t mesh, const struct affine *matrix,
                        uint32_t object, struct error *err);

#endif
