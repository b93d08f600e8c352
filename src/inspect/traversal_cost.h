// SPDX-License-Identifier: MIT
/*
 * traversal_cost.h - counts the box and triangle tests of camera rays
 *
 * Rays go through the binary tree with the plain query of traverse.h, which is
 * compiled here again with counters.
 *
 * Units:     tests
 * Threads:   one at a time; workers of the pool trace the rays
 */
#ifndef GLIM_TRAVERSAL_COST_H
#define GLIM_TRAVERSAL_COST_H

#include "base/thread_pool.h"
#include "kernels/types.h"

struct traversal_cost {
    uint32_t boxes, triangles;
};

/* Counts the tests of the ray through the centre of each pixel. The camera has
 * width x height pixels. Blocks. */
void traversal_cost_of_pixels(struct pool *pool, const struct world *world,
                              int width, int height,
                              struct traversal_cost *costs);

#endif
