// SPDX-License-Identifier: MIT
/*
 * bvh8_collapse.h - chooses which nodes of the binary tree become children of a
 * node of eight
 *
 * The choice of least cost by the surface area heuristic (Ylitie, Karras and
 * Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed
 * wide BVHs", 3.1): from the leaves up, the least cost of everything below a
 * node when it takes n places in its parent.
 *
 * Units:     normalised scene units; costs are visits of a node, times its area
 * Ownership: bvh8_collapse_free() frees; the binary tree stays the caller's and
 *            must outlive the struct
 * Threads:   bvh8_collapse_init() uses those of the pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH8_COLLAPSE_H
#define GLIM_BVH8_COLLAPSE_H

#include <stdbool.h>
#include <stdint.h>

#include "bvh/bvh8.h"

struct bvh8_cost {
    uint32_t tri_count;
    float costs[BVH8_CHILDREN]; /* [n - 1]: with at most n places */
};

struct bvh8_collapse {
    const struct bvh *bvh;
    struct bvh8_cost *costs; /* of each node */
    uint32_t leaf_tris;      /* most triangles of a leaf */
};

static inline uint32_t bvh8_blocks(uint32_t tri_count)
{
    return (tri_count + BLOCK_TRIS - 1) / BLOCK_TRIS;
}

/* Computes the costs for a tree with at least one node, whose leaves may have
 * so many triangles. Returns false if memory is out. */
bool bvh8_collapse_init(struct bvh8_collapse *f, const struct bvh *bvh,
                        uint32_t leaf_tris, struct pool *pool);

/* Returns true if the node is to be a leaf. */
bool bvh8_collapse_leaf(const struct bvh8_collapse *f, uint32_t node);

/* Finds the children of a node, in their order. Returns their count. */
uint32_t bvh8_collapse_children(const struct bvh8_collapse *f, uint32_t node,
                                uint32_t children[BVH8_CHILDREN]);

void bvh8_collapse_free(struct bvh8_collapse *f);

#endif
