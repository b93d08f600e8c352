// SPDX-License-Identifier: MIT
/*
 * gltf_animation.h - poses nodes and morph targets as an animation does at a
 * time
 *
 * Units:     seconds
 * Threads:   one
 * Errors:    samplers that do not fit; memory
 */
#ifndef GLIM_GLTF_ANIMATION_H
#define GLIM_GLTF_ANIMATION_H

#include "read/gltf/gltf_node.h"

/* Sets translations, rotations, scales and weights of the nodes before
 * gltf_nodes_place(). Times before the first key and after the last have their
 * poses. */
bool gltf_animation_pose(const struct gltf_document *document,
                         uint32_t animation, double time_s,
                         struct gltf_nodes *nodes, struct error *err);

#endif
