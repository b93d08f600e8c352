// SPDX-License-Identifier: MIT
/*
 * bvh.h - bounding volume hierarchy: binned SAH, flattened depth-first
 *
 * Wald, Boulos and Shirley 2007; Wald 2007 (binning); Pharr et al., PBR 4th
 * ed., 7.3. Below BVH_SAH_DEPTH nodes are split in halves by count, so that no
 * tree is deeper than the traversal's stack.
 *
 * Units:     normalised scene units
 * Ownership: bvh_free() frees; a zeroed struct is a tree without triangles
 * Threads:   one thread builds; read only after
 * Errors:    memory
 */
#ifndef GLIM_BVH_H
#define GLIM_BVH_H

#include "glim/util.h"
#include "kernels/types.h"

struct bvh {
    struct node *nodes;
    uint32_t node_count;
    struct leaf_tri *leaf_tris;
    uint32_t leaf_tri_count;
    uint32_t depth;
};

bool bvh_build(struct bvh *bvh, const struct world *world, struct error *err);
void bvh_free(struct bvh *bvh);

#endif
