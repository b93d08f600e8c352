// SPDX-License-Identifier: MIT
/*
 * targets.h - the order of the numbers of samples that pixels are to have
 *
 * Adaptive sampling (picture/adaptive.h) has two targets for each cell of 2 x 2
 * pixels: that of its upper left pixel, the pilot, and that of the others.
 */
#ifndef KERNELS_TARGETS_H
#define KERNELS_TARGETS_H

#include "kernels/dialect.h"

/* Index of the target of pixel (x, y) of a film. */
static inline uint32_t target_index(uint32_t x, uint32_t y, uint32_t width)
{
    uint32_t cell = (y >> 1) * ((width + 1) >> 1) + (x >> 1);

    return 2 * cell + ((x | y) & 1);
}

#endif
