// SPDX-License-Identifier: MIT
/*
 * bvh8_collapse.h - which nodes of the binary tree become children of a wide
 * one
 *
 * The cheapest choice by the surface area heuristic (Ylitie, Karras and Laine
 * 2017, "Efficient incoherent ray traversal on GPUs through compressed wide
 * BVHs", 3.1): from the leaves up, what it costs to have a node, and what is
 * below it, as so many children.
 *
 * Units:     normalised scene units; costs are visits of a node, times its area
 * Ownership: bvh8_collapse_free() frees; a zeroed struct is none; the binary
 * tree stays the caller's, who keeps it Threads:   bvh8_collapse_init() uses
 * those of the pool; read only after Errors:    memory
 */
#ifndef GLIM_BVH8_COLLAPSE_H
#define GLIM_BVH8_COLLAPSE_H

#include <stdbool.h>
#include <stdint.h>

#include "bvh/bvh8.h"

struct bvh8_cost {
    uint32_t tri_count;
    float costs[BVH8_CHILDREN]; /* [n - 1]: as n children, or fewer */
};

struct bvh8_collapse {
    const struct bvh *bvh;
    struct bvh8_cost *costs; /* of each of its nodes */
};

static inline uint32_t bvh8_blocks(uint32_t tri_count)
{
    return (tri_count + BLOCK_TRIS - 1) / BLOCK_TRIS;
}

/* For a tree that has nodes. False if memory is out. */
bool bvh8_collapse_init(struct bvh8_collapse *f, const struct bvh *bvh,
                        struct pool *pool);

/* Whether it is best as blocks of triangles. */
bool bvh8_collapse_leaf(const struct bvh8_collapse *f, uint32_t node);

/* The children of what becomes a wide node, in the order in which they are to
 * be; their count. */
uint32_t bvh8_collapse_children(const struct bvh8_collapse *f, uint32_t node,
                                uint32_t children[BVH8_CHILDREN]);

void bvh8_collapse_free(struct bvh8_collapse *f);

#endif
