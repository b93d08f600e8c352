// SPDX-License-Identifier: MIT
/*
 * aov_picture.h - pictures of the first hit: normals, depth, materials
 *
 * Rays go through the binary tree with the plain query of traverse.h.
 *
 * Units:     as in enum sample_kind
 * Threads:   one at a time; workers of the pool trace the rays
 */
#ifndef GLIM_AOV_PICTURE_H
#define GLIM_AOV_PICTURE_H

#include "base/thread_pool.h"
#include "kernels/types.h"

/* Fills 3 numbers for each pixel: the sample kind in the world's settings,
 * which must not be light, at the first hit of the ray through the pixel's
 * centre. The camera has width x height pixels. Blocks. */
void aov_of_pixels(struct pool *pool, const struct world *world, int width,
                   int height, float *numbers);

#endif
