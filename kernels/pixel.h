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

/* Converts one channel of a sample. What sum_accepts() refuses counts as 0. */
static inline struct sum channel_sum(float x, uint32_t *bad, uint32_t *full)
{
    if (float_bits(x) > SUM_LARGE) { /* rare, and found with one comparison */
        if (!sum_accepts(x)) {
            *bad = 1;
            return sum_of(0.0f);
        }
        if (x > 0x1p62f)
            *full = 1;
    }
    return sum_of(x);
}

/* Returns false if one of the sums is saturated. */
static inline bool rgb_join(GLOBAL struct sum *sums, struct sum r, struct sum g,
                            struct sum b)
{
    uint64_t high =
        sum_put(&sums[0], r) | sum_put(&sums[1], g) | sum_put(&sums[2], b);

    if (!(high >> 63))
        return true;
    for (uint32_t c = 0; c < 3; c++)
        if (sums[c].hi >> 63)
            sum_saturate(&sums[c]);
    return false;
}

/* Adds a colour to three sums, and to those of the odd samples if it is of
 * one. */
static inline void rgb_add(GLOBAL struct sum *sums, GLOBAL struct sum *odd_sums,
                           bool is_odd, struct vec3 rgb, uint32_t *bad,
                           uint32_t *full)
{
    struct sum r = channel_sum(rgb.x, bad, full);
    struct sum g = channel_sum(rgb.y, bad, full);
    struct sum b = channel_sum(rgb.z, bad, full);

    if (!rgb_join(sums, r, g, b))
        *full = 1;
    if (is_odd)
        rgb_join(odd_sums, r, g, b);
}

/* Adds sample `index` to the three sums of its pixel, to those of its odd
 * samples if it is one, and to the tally. */
static inline void pixel_add(GLOBAL struct sum *sums,
                             GLOBAL struct sum *odd_sums, uint64_t index,
                             struct path_sample p, struct tally *t)
{
    uint32_t bad = 0;
    uint32_t full = 0;

    rgb_add(sums, odd_sums, (index & 1) != 0, p.radiance, &bad, &full);
    t->samples++;
    t->rays += p.rays;
    t->non_finite += bad;
    t->saturated += full;
    t->cut_paths += p.cut;
}

#endif
