// SPDX-License-Identifier: MIT
/*
 * gltf_node.h - the tree of nodes
 *
 * gltf_nodes_read() reads poses at rest, an animation may change them, and
 * gltf_nodes_place() computes the matrices. Trees of any depth need no
 * recursion.
 *
 * Units:     those of the file
 * Ownership: gltf_nodes_free(); a zeroed struct is empty
 * Threads:   one
 * Errors:    a node that is no number of the file, or that is in the tree twice
 */
#ifndef GLIM_GLTF_NODE_H
#define GLIM_GLTF_NODE_H

#include "base/geometry.h"
#include "read/gltf/gltf_value.h"

#define GLTF_NAME_BYTES 256

struct gltf_node {
    double translation[3];
    double rotation[4]; /* x, y, z, w */
    double scale[3];
    struct affine matrix; /* instead of the three, if has_matrix */
    bool has_matrix;
    bool is_hidden;
    uint32_t mesh, skin, camera, light; /* or NO_INDEX */
    uint32_t parent, first_child, next_sibling;
    struct affine world; /* set by gltf_nodes_place() */
    double *weights;     /* of an animation; NULL: those of the file */
    uint32_t weight_count;
};

struct gltf_nodes {
    struct gltf_node *items;
    uint32_t count;
    uint32_t *visible; /* those of the scene, parents first, in order */
    uint32_t visible_count;
};

/* Reads all nodes. */
bool gltf_nodes_read(const struct gltf_document *document,
                     struct gltf_nodes *nodes, struct error *err);

/* Returns the name of a node, else that of the mesh or camera it shows: many
 * nodes may copy this one, so it is cut to the bytes of `cut`, which must
 * outlive *name. */
bool gltf_node_name(const struct gltf_value *node,
                    const struct gltf_value *shown, char cut[GLTF_NAME_BYTES],
                    const char **name, struct error *err);

/* Computes the matrices of all nodes, and lists the nodes that the scene of
 * this number shows. NO_INDEX: the file's default scene, else its first, else
 * all roots. */
bool gltf_nodes_place(const struct gltf_document *document, uint32_t scene,
                      struct gltf_nodes *nodes, struct error *err);

/* Makes the matrix of translation, rotation and scale. A rotation of length 0
 * is none. */
struct affine gltf_matrix(const double translation[3], const double rotation[4],
                          const double scale[3]);

void gltf_nodes_free(struct gltf_nodes *nodes);

#endif
