// SPDX-License-Identifier: MIT
/*
 * sample_share.h - the numbers of samples of pixels with adaptive sampling
 *
 * All pixels have the same number of samples at first. Each later one is for a
 * share of SHARE_ONE in the mean: a pixel of twice that gets twice the samples.
 */
#ifndef KERNELS_SAMPLE_SHARE_H
#define KERNELS_SAMPLE_SHARE_H

#include "kernels/dialect.h"

#define SHARE_ONE 4096u
#define SHARE_MAX (4u * SHARE_ONE)

/* Samples of each pixel before shares count. */
#define ADAPTIVE_FIRST 16u

/* Returns the samples of a pixel when the mean of all is `mean`. */
static inline uint64_t share_samples(uint32_t share, uint64_t mean)
{
    if (mean <= ADAPTIVE_FIRST)
        return mean;
    return ADAPTIVE_FIRST +
           ((mean - ADAPTIVE_FIRST) * share + SHARE_ONE / 2) / SHARE_ONE;
}

#endif
