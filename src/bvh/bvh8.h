// SPDX-License-Identifier: MIT
/*
 * bvh8.h - the tree of eight children a node, for vector units
 *
 * It is made from the binary tree. The boxes of a node's children are arrays of
 * eight, so that one step tests all. Up to four triangles lie side by side in a
 * block (Wald, Benthin and Boulos 2008, "Getting rid of packets").
 * bvh8_collapse.h chooses which nodes of the binary tree become children.
 *
 *     root                     nodes                blocks
 *     +------------------+     +------+------+... +-------+-------+...+-------+
 *     | planes[axis]     |     |  1   |  2   |      |   0   |   1   |   | empty
 * | |   [low, high][8] |     +------+------+...   +-------+-------+...+-------+
 *     | child[8] --------+----> byte offset from the root, in units of 32,
 * times 8
 *     +------------------+      (BVH8_LEAF: blocks follow, BVH8_MORE: how many)
 *
 * Nodes and blocks are in one allocation, first all nodes and then all blocks.
 *
 * Units:     normalised scene units
 * Ownership: bvh8_free() frees; a zeroed struct is a tree without triangles
 * Threads:   bvh8_build() uses those of its pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH8_H
#define GLIM_BVH8_H

#include <stdbool.h>
#include <stdint.h>

#include "bvh/bvh.h"

#define BVH8_CHILDREN 8
#define BLOCK_TRIS    4

/* A child is its distance from the root in units of 32 bytes, times 8, so that
 * one shift makes it a byte offset. With BVH8_LEAF it is a block, and the
 * lowest two bits are the number of further blocks of the leaf, which follow
 * it. */
#define BVH8_UNIT 32
#define BVH8_LEAF 4u
#define BVH8_MORE 3u

/* Most triangles of a leaf. */
#define BVH8_LEAF_TRIS ((BVH8_MORE + 1) * BLOCK_TRIS)

struct bvh8_node {
    /* the signs of a ray choose near and far planes; [axis][low or high] */
    float planes[3][2][BVH8_CHILDREN]; /* no child: infinite */
    uint32_t child[BVH8_CHILDREN];     /* no child: the empty block */
};

_Static_assert(sizeof(struct bvh8_node) % BVH8_UNIT == 0, "see BVH8_UNIT");

/* Triangles of a leaf, with their corners as [corner][axis][triangle]. NaN and
 * NO_INDEX fill the places of missing triangles. */
struct tri_block {
    float corners[3][3][BLOCK_TRIS];
    uint32_t tri[BLOCK_TRIS];
};

_Static_assert(sizeof(struct tri_block) % BVH8_UNIT == 0, "see BVH8_UNIT");

struct bvh8 {
    struct bvh8_node *nodes; /* nodes[0] is the root */
    uint32_t node_count;
    struct tri_block
        *blocks;          /* behind the nodes in their allocation; the last */
    uint32_t block_count; /* is empty */
};

/* The world of the CPU's ray queries, which get a pointer to its first member.
 */
struct bvh8_world {
    struct world world; /* first member */
    const struct bvh8 *tree;
};

/* Parameters of the binary tree. */
extern const struct bvh_leaves bvh8_leaves;

/* Cost of a block in visits of a node. Measured: the same from 0.7 to 1, where
 * trees take more memory. */
#define BVH8_BLOCK_COST 0.7f

/* Builds the tree of least expected cost among those with the boxes of the
 * binary tree. Without a pool the calling thread builds. */
bool bvh8_build(struct bvh8 *wide, const struct world *world, struct pool *pool,
                struct error *err);
uint64_t bvh8_bytes(const struct bvh8 *wide);

void bvh8_free(struct bvh8 *wide);

#endif
