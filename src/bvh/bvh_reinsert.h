// SPDX-License-Identifier: MIT
/*
 * bvh_reinsert.h - moves nodes of a tree to where they cost less
 *
 * Splits from the top down are greedy: what they part stays apart. Here a node
 * is taken out and put back beside another one, wherever the inner nodes' areas
 * become the smallest (Bittner, Hapala and Havran 2013, "Fast insertion-based
 * optimization of bounding volume hierarchies"); the search for that place is
 * the one of Meister and Bittner 2018, "Parallel reinsertion for bounding
 * volume hierarchy optimization". Only large nodes are moved, as a ray meets a
 * node as often as that is large, and there are few of them in any tree; what
 * is below the smallest of them moves as a whole.
 *
 * The same tree becomes the same tree; leaves stay what they are.
 *
 * Units:     normalised scene units
 * Ownership: the tree stays the caller's
 * Threads:   one
 * Errors:    memory: the tree is as it was then
 */
#ifndef GLIM_BVH_REINSERT_H
#define GLIM_BVH_REINSERT_H

#include <stdbool.h>

#include "bvh/bvh.h"

/* Nodes lie depth-first before and after. False if memory is out. */
bool bvh_reinsert(struct bvh *bvh);

#endif
