// SPDX-License-Identifier: MIT
/*
 * bvh8_collapse.h - which nodes of the binary tree become children of a wide one
 *
 * The cheapest choice by the surface area heuristic (Ylitie, Karras and Laine
 * 2017, "Efficient incoherent ray traversal on GPUs through compressed wide
 * BVHs", 3.1): from the leaves up, what it costs to have a node, and what is
 * below it, as so many children.
 *
 * Units:     normalised scene units; costs are visits of a node, times its area
 * Ownership: wide_fits_free() frees; a zeroed struct is none; the binary tree
 *            stays the caller's, who keeps it
 * Threads:   wide_fits_init() uses those of the pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH8_COLLAPSE_H
#define GLIM_BVH8_COLLAPSE_H

#include "bvh/bvh8.h"

struct wide_fit {
    uint32_t tri_count;
    float costs[WIDE_CHILDREN]; /* [n - 1]: as n children, or fewer */
};

struct wide_fits {
    const struct bvh *bvh;
    struct wide_fit *fits; /* of each of its nodes */
};

static inline uint32_t wide_blocks(uint32_t tri_count)
{
    return (tri_count + BLOCK_TRIS - 1) / BLOCK_TRIS;
}

/* For a tree that has nodes. False if memory is out. */
bool wide_fits_init(struct wide_fits *f, const struct bvh *bvh,
                    struct pool *pool);

/* Whether it is best as blocks of triangles. */
bool wide_fits_leaf(const struct wide_fits *f, uint32_t node);

/* The children of what becomes a wide node, in the order in which they are to
 * be; their count. */
uint32_t wide_fits_children(const struct wide_fits *f, uint32_t node,
                            uint32_t children[WIDE_CHILDREN]);

void wide_fits_free(struct wide_fits *f);

#endif
