// SPDX-License-Identifier: MIT
/*
 * bvh8.h - the binary tree made eight children wide, for vector units
 *
 * A node's boxes are arrays of eight, so that one step tests all; up to four
 * triangles lie side by side in a block (Wald, Benthin and Boulos 2008,
 * "Getting rid of packets"). Which nodes of the binary tree become children
 * says bvh8_collapse.h.
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

/* A child is how far it is from the root in units of 32 bytes, times 8: so many
 * bytes are one shift of it away. With BVH8_LEAF it is a block, and the
 * lowest two bits say how many more follow it. */
#define BVH8_UNIT 32
#define BVH8_LEAF 4u
#define BVH8_MORE 3u

/* So many triangles can be below a leaf. */
#define BVH8_LEAF_TRIS ((BVH8_MORE + 1) * BLOCK_TRIS)

struct bvh8_node {
    /* near and far planes are picked by the ray's signs: [axis][low or high] */
    float planes[3][2][BVH8_CHILDREN]; /* no child: a box that nothing meets */
    uint32_t child[BVH8_CHILDREN]; /* no child: the last block, if it does */
};

_Static_assert(sizeof(struct bvh8_node) % BVH8_UNIT == 0, "see BVH8_UNIT");

/* Corners as [corner][axis][triangle]; NaN and NO_INDEX where there is none. */
struct tri_block {
    float corners[3][3][BLOCK_TRIS];
    uint32_t tri[BLOCK_TRIS];
};

_Static_assert(sizeof(struct tri_block) % BVH8_UNIT == 0, "see BVH8_UNIT");

struct bvh8 {
    struct bvh8_node *nodes; /* 0 is the root */
    uint32_t node_count;
    struct tri_block
        *blocks;          /* behind the nodes in the same memory; the last */
    uint32_t block_count; /* has no triangles */
};

/* What the CPU's samples read. Ray queries get the world, and find the tree
 * behind it. */
struct bvh8_world {
    struct world world; /* first */
    const struct bvh8 *tree;
};

/* The binary tree that it is made from. */
extern const struct bvh_leaves bvh8_leaves;

/* Tests of a block in visits of a node. Measured: flat from 0.7 to 1, where
 * memory grows. */
#define BVH8_BLOCK_COST 0.7f

/* The tree for which nodes and blocks cost a ray the least, of all that have
 * the binary one's boxes. Without a pool the caller's thread builds. */
bool bvh8_build(struct bvh8 *wide, const struct world *world, struct pool *pool,
                struct error *err);
uint64_t bvh8_bytes(const struct bvh8 *wide);

void bvh8_free(struct bvh8 *wide);

#endif
