// SPDX-License-Identifier: MIT
/*
 * gltf_skin.h - the matrices of a skin's joints
 *
 * Ownership: the matrices are for free()
 * Threads:   one
 * Errors:    memory; joints and inverse bind matrices that do not fit
 */
#ifndef GLIM_GLTF_SKIN_H
#define GLIM_GLTF_SKIN_H

#include "gltf/gltf_node.h"

/* Computes the matrix of each joint, from the mesh to the scene, after
 * gltf_nodes_place(). */
bool gltf_skin_read(const struct gltf_document *document,
                    const struct gltf_nodes *nodes, uint32_t skin,
                    struct affine **joints, uint32_t *joint_count,
                    struct error *err);

#endif
