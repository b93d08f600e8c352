// SPDX-License-Identifier: MIT
/*
 * traversal_cost.h - counts the nodes and the blocks of triangles that camera
 * rays meet
 *
 * Rays go through the tree with the query of kernels/traverse.h, which is
 * compiled here again with counters. In a node the boxes of up to eight
 * children are tested at once, in a block up to four triangles.
 *
 * Units:     tests
 * Threads:   one at a time; workers of the pool trace the rays
 */
#ifndef GLIM_TRAVERSAL_COST_H
#define GLIM_TRAVERSAL_COST_H

#include "base/thread_pool.h"
#include "kernels/types.h"

struct traversal_cost {
    uint32_t nodes, blocks;
};

/* Counts the tests of the ray through the centre of each pixel. The camera has
 * width x height pixels. Blocks. */
void traversal_cost_of_pixels(struct pool *pool, const struct world *world,
                              int width, int height,
                              struct traversal_cost *costs);

#endif
