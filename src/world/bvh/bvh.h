// SPDX-License-Identifier: MIT
/*
 * bvh.h - the binary bounding volume hierarchy, of which bvh8.h makes the tree
 * of eight: binned SAH, stored depth-first
 *
 * Wald, Boulos and Shirley 2007, "Ray tracing deformable scenes using dynamic
 * bounding volume hierarchies"; Wald 2007 (binning); Pharr et al., PBR 4th
 * ed., 7.3; then reinsertion (bvh_reinsert.h). From some depth on nodes are
 * split in halves by count, so that no tree is deeper than the traversal's
 * stack.
 *
 * The tree does not depend on the number of threads.
 *
 * Units:     normalised scene units
 * Ownership: bvh_free() frees; a zeroed struct is a tree without triangles
 * Threads:   bvh_split() uses those of its pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH_H
#define GLIM_BVH_H

#include "base/error.h"
#include "base/thread_pool.h"
#include "kernels/types.h"

/* Nodes are stored depth-first: the left child of node i is node i + 1. */
struct node {
    struct vec3 lo;
    uint32_t next; /* inner node: right child; leaf: its first place in tris */
    struct vec3 hi;
    uint32_t count; /* inner node: 0; leaf: triangles */
};

struct bvh {
    struct node *nodes;
    uint32_t node_count;
    uint32_t *tris;     /* indices of triangles, in the order of the leaves */
    uint32_t tri_count; /* copies of triangles may have no leaf */
    uint32_t depth;     /* greatest depth of a leaf */
};

/* Parameters of leaves. A block is 1 << block_bits triangles that are tested at
 * once; they are never split. */
struct bvh_leaves {
    uint32_t block_bits;
    uint32_t large_bits; /* block_bits for large nodes, which many rays meet */
    float block_cost;    /* test of a block, in visits of a node */
    uint32_t most;       /* most triangles of a leaf */
};

/* Builds a tree by splits from the top down, with such leaves. Without a pool
 * the calling thread builds. */
bool bvh_split(struct bvh *bvh, const struct world *world,
               const struct bvh_leaves *leaves, struct pool *pool,
               struct error *err);

/* bvh_split(), then reinsertion. */
bool bvh_build_nodes(struct bvh *bvh, const struct world *world,
                     const struct bvh_leaves *leaves, struct pool *pool,
                     struct error *err);

void bvh_free(struct bvh *bvh);

#endif
