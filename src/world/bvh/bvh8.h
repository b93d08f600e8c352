// SPDX-License-Identifier: MIT
/*
 * bvh8.h - the tree of eight children a node, for vector units
 *
 * It is made from the binary tree. CPU and devices traverse the same bytes:
 * kernels/traverse.h. The boxes of a node's children are arrays of eight, so
 * that one step tests all. Up to four triangles lie side by side in a block.
 *
 *     one allocation, in units of 32 bytes
 *     +--------+--------+-----+---------+---------+-----+-------------+
 *     | node 0 | node 1 | ... | block 0 | block 1 | ... | empty block |
 *     +--------+--------+-----+---------+---------+-----+-------------+
 *     |
 *     +- planes[axis][low, high][8 children]
 *     +- child[8], each of them 32 bits:
 *            bits 3 to 31  distance from node 0 in units
 *            bit 2         BVH8_LEAF: it is a block, else a node
 *            bits 0 and 1  BVH8_MORE: further blocks of the leaf
 *
 * Units:     normalised scene units
 * Ownership: bvh8_free() frees; a zeroed struct is a tree without triangles
 * Threads:   bvh8_build() uses those of its pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH8_H
#define GLIM_BVH8_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "world/bvh/bvh.h"

_Static_assert(sizeof(struct bvh8_node) % BVH8_UNIT == 0, "see BVH8_UNIT");
_Static_assert(sizeof(struct tri_block) % BVH8_UNIT == 0, "see BVH8_UNIT");

/* Largest number of triangles in a leaf. */
#define BVH8_LEAF_TRIS ((BVH8_MORE + 1) * BVH8_BLOCK_TRIS)

struct bvh8 {
    struct bvh8_node *nodes; /* nodes[0] is the root */
    uint32_t node_count;
    struct tri_block *blocks; /* in the same allocation */
    uint32_t block_count;     /* with the empty one */
    size_t size_bytes;        /* of the allocation */
    bool lacks_copies;        /* of triangles, or of instances */
    /* With instances the tree above has the stand-ins of instance_trees.h, one
     * in a leaf, and the trees of meshes follow it in the allocation; see
     * struct world. Otherwise NULL. */
    uint32_t *roots;
    uint32_t root_count;
};

/* Parameters of the binary tree. */
extern const struct bvh_leaves bvh8_leaves;

/* Cost of a block in visits of a node. Measured: the same from 0.7 to 1, where
 * trees take more memory. */
#define BVH8_BLOCK_COST 0.7f

/* Builds the tree of least expected cost among those with the boxes of the
 * binary tree, or with instances such trees of all meshes. Without a pool the
 * calling thread builds. */
bool bvh8_build(struct bvh8 *wide, const struct world *world, struct pool *pool,
                struct error *err);

/* Lends the tree to a world, for ray queries. */
void bvh8_lend(const struct bvh8 *wide, struct world *world);

uint64_t bvh8_bytes(const struct bvh8 *wide);

void bvh8_free(struct bvh8 *wide);

#endif
