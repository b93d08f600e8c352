// SPDX-License-Identifier: MIT
/*
 * gltf_mesh.h - the meshes of a document, placed by its nodes
 *
 * Each primitive is a mesh of the scene, and each node that shows it an
 * instance. Meshes that joints or the weights of a node bend are added anew.
 * Each node with a mesh is an object, named after the node or its mesh.
 *
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene, and those of its pool
 * Errors:    memory; accessors, indices and skins that do not fit
 */
#ifndef GLIM_GLTF_MESH_H
#define GLIM_GLTF_MESH_H

#include "read/gltf/gltf_node.h"
#include "scene/scene.h"

/* Adds the meshes of the visible nodes to a scene without triangles, after
 * gltf_nodes_place(). */
bool gltf_meshes_add(const struct gltf_document *document,
                     const struct gltf_nodes *nodes, struct scene *scene,
                     struct warnings *report, struct error *err);

#endif
