// SPDX-License-Identifier: MIT
/*
 * bvh.h - bounding volume hierarchy: binned SAH, flattened depth-first
 *
 * Wald, Boulos and Shirley 2007; Wald 2007 (binning); Pharr et al., PBR 4th
 * ed., 7.3; then as bvh_reinsert.h says. Far down, nodes are split in halves by
 * count, so that no tree is deeper than the traversal's stack.
 *
 * The same triangles give the same tree, whatever the number of threads.
 *
 * Units:     normalised scene units
 * Ownership: bvh_free() frees; a zeroed struct is a tree without triangles
 * Threads:   bvh_build() uses those of its pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH_H
#define GLIM_BVH_H

#include "base/error.h"
#include "base/thread_pool.h"
#include "kernels/types.h"

struct bvh {
    struct node *nodes;
    uint32_t node_count;
    uint32_t *tris;             /* numbers, as the leaves have them */
    struct leaf_tri *leaf_tris; /* the same with corners, or NULL */
    uint32_t leaf_tri_count;
    uint32_t depth; /* no leaf is deeper */
};

/* What the leaves are to be: 1 << block_bits triangles are tested at once, and
 * are never parted. */
struct bvh_leaves {
    uint32_t block_bits;
    uint32_t large_bits; /* in nodes that many rays meet, as if so many were */
    float block_cost;    /* in visits of a node */
    uint32_t most;       /* triangles; more are split whatever it costs */
};

/* The tree for queries that test one triangle after the other, with leaf_tris.
 * Without a pool the caller's thread builds. */
bool bvh_build(struct bvh *bvh, const struct world *world, struct pool *pool,
               struct error *err);

/* The tree by splits from the top down, for such leaves. */
bool bvh_split(struct bvh *bvh, const struct world *world,
               const struct bvh_leaves *leaves, struct pool *pool,
               struct error *err);

/* The tree alone: splits, and then as bvh_reinsert.h says. */
bool bvh_build_nodes(struct bvh *bvh, const struct world *world,
                     const struct bvh_leaves *leaves, struct pool *pool,
                     struct error *err);

uint64_t bvh_bytes(const struct bvh *bvh);

void bvh_free(struct bvh *bvh);

#endif
