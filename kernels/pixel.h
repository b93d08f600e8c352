// SPDX-License-Identifier: MIT
/*
 * pixel.h - adds samples to the sums of their pixel
 *
 * Units:     radiance
 * Threads:   one owner for each pixel
 * Errors:    NaN, infinite and negative channels count as 0 and are counted
 */
#ifndef KERNELS_PIXEL_H
#define KERNELS_PIXEL_H

#include "kernels/path_types.h"
#include "kernels/sum.h"

/* Counters of some samples, fewer than 2^20, which the film adds up. */
struct tally {
    uint32_t samples;
    uint32_t rays;
    uint32_t non_finite; /* samples with a NaN, infinite or negative channel */
    uint32_t saturated;  /* samples with a channel above 2^62, which counts as
                            2^62, or above what its sum has room for */
    uint32_t cut_paths;  /* paths that ended at PATH_HARD_STOP */
};

/* The bits of 2^62. Larger numbers, infinity, NaN and all negative numbers have
 * higher bits. */
#define SUM_LARGE 0x5e800000u

/* Adds one channel of a sample. What sum_accepts() refuses counts as 0. */
static inline void channel_add(GLOBAL struct sum *sum, float x, uint32_t *bad,
                               uint32_t *full)
{
    if (float_bits(x) > SUM_LARGE) { /* rare, and found with one comparison */
        if (!sum_accepts(x)) {
            *bad = 1;
            return;
        }
        if (x > 0x1p62f)
            *full = 1;
    }
    if (!sum_add(sum, x))
        *full = 1;
}

static inline void rgb_add(GLOBAL struct sum *sums, struct vec3 rgb,
                           uint32_t *bad, uint32_t *full)
{
    channel_add(&sums[0], rgb.x, bad, full);
    channel_add(&sums[1], rgb.y, bad, full);
    channel_add(&sums[2], rgb.z, bad, full);
}

/* Adds sample `index` to the three sums of its pixel, to those of its odd
 * samples if it is one, and to the tally. */
static inline void pixel_add(GLOBAL struct sum *sums,
                             GLOBAL struct sum *odd_sums, uint64_t index,
                             struct path_sample p, struct tally *t)
{
    uint32_t bad = 0;
    uint32_t full = 0;

    rgb_add(sums, p.radiance, &bad, &full);
    if ((index & 1) != 0)
        rgb_add(odd_sums, p.radiance, &bad, &full);
    t->samples++;
    t->rays += p.rays;
    t->non_finite += bad;
    t->saturated += full;
    t->cut_paths += p.cut;
}

#endif
