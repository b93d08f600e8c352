// SPDX-License-Identifier: MIT
/*
 * gltf_view.h - the cameras and the lights that the nodes of a document place
 *
 * Units:     radians; those of lights are decided by gltf_light_unit.h
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene
 * Errors:    memory; numbers out of range
 */
#ifndef GLIM_GLTF_VIEW_H
#define GLIM_GLTF_VIEW_H

#include "gltf/gltf_node.h"
#include "scene/scene.h"

/* Adds the cameras and lights of the visible nodes to the scene, after
 * gltf_nodes_place(). Cameras look at a point at distance 1. */
bool gltf_view_read(const struct gltf_document *document,
                    const struct gltf_nodes *nodes, struct scene *scene,
                    struct warnings *report, struct error *err);

#endif
