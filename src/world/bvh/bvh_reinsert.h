// SPDX-License-Identifier: MIT
/*
 * bvh_reinsert.h - reinsertion: moves nodes of a tree to where they cost less
 *
 * Splits from the top down are greedy. Here a node is removed and inserted
 * beside another one, wherever the areas of the inner nodes become the smallest
 * (Bittner, Hapala and Havran 2013, "Fast insertion-based optimization of
 * bounding volume hierarchies"). The search for the place is that of Meister
 * and Bittner 2018, "Parallel reinsertion for bounding volume hierarchy
 * optimization". Only large nodes are moved, as the chance that a ray visits a
 * node is in proportion to its area, and every tree has few large ones.
 * Subtrees of the smallest of them move as a whole.
 *
 * The result depends on the tree only. Leaves do not change.
 *
 * Units:     normalised scene units
 * Ownership: the tree stays the caller's
 * Threads:   one
 * Errors:    memory: the tree is not changed then
 */
#ifndef GLIM_BVH_REINSERT_H
#define GLIM_BVH_REINSERT_H

#include <stdbool.h>

#include "world/bvh/bvh.h"

/* Nodes are depth-first before and after. Returns false if memory is out. */
bool bvh_reinsert(struct bvh *bvh);

#endif
