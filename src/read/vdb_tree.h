// SPDX-License-Identifier: MIT
/*
 * vdb_tree.h - reads the tree of an OpenVDB grid into bricks
 *
 * The tree has a root, nodes of 32^3 and of 16^3 children, and leaves of 8^3
 * voxels. A node that is missing is a tile: all of its voxels have one value.
 *
 * Units:     bytes, voxels
 * Ownership: the grid is for voxel_grid_free(), also after an error
 * Threads:   any
 * Errors:    a broken tree; more voxels than the file's size or the box allows
 */
#ifndef GLIM_VDB_TREE_H
#define GLIM_VDB_TREE_H

#include "read/vdb_bytes.h"
#include "scene/voxel_grid.h"

struct vdb_storage {
    uint32_t flags; /* of compression */
    bool is_half;   /* floats are saved as half floats */
};

/* Fills a zeroed grid, except its transform, from the reader's place on. */
bool vdb_tree_read(struct voxel_grid *grid, struct vdb_reader *reader,
                   struct vdb_storage storage);

#endif
