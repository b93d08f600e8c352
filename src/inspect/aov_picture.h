// SPDX-License-Identifier: MIT
/*
 * aov_picture.h - what the camera's rays find first, for pictures of numbers
 *
 * By the plain query of traverse.h in the binary tree.
 *
 * Units:     as enum sample_kind says
 * Threads:   one at a time; the pool's workers trace
 */
#ifndef GLIM_AOV_PICTURE_H
#define GLIM_AOV_PICTURE_H

#include "base/thread_pool.h"
#include "kernels/types.h"

/* What the world's settings ask for, no light, of the surfaces behind the
 * middles of all pixels of the world's camera, which sees width x height of
 * them: 3 numbers a pixel. Blocks. */
void aov_of_pixels(struct pool *pool, const struct world *world, int width,
                   int height, float *numbers);

#endif
