// SPDX-License-Identifier: MIT
/*
 * traversal_cost.h - what camera rays cost: boxes and triangles that they are
 * tested with
 *
 * In the binary tree and by the plain query of traverse.h, which is compiled
 * here once more, with counters.
 *
 * Units:     tests
 * Threads:   one at a time; the pool's workers count
 */
#ifndef GLIM_TRAVERSAL_COST_H
#define GLIM_TRAVERSAL_COST_H

#include "base/thread_pool.h"
#include "kernels/types.h"

struct traversal_cost {
    uint32_t boxes, triangles;
};

/* The cost of the rays through the middles of all pixels of the world's
 * camera, which sees width x height of them. Blocks. */
void traversal_cost_of_pixels(struct pool *pool, const struct world *world,
                              int width, int height,
                              struct traversal_cost *costs);

#endif
