// SPDX-License-Identifier: MIT
/*
 * pixel.h - how a sample enters the sums of its pixel
 *
 * Units:     radiance
 * Threads:   one owner for each pixel
 * Errors:    none: what is no number, infinite or negative counts as 0
 */
#ifndef KERNELS_PIXEL_H
#define KERNELS_PIXEL_H

#include "kernels/path_types.h"
#include "kernels/sum.h"

/* What some samples, fewer than 2^20, add to the counters of a film. */
struct tally {
    uint32_t samples;
    uint32_t rays;
    uint32_t non_finite; /* NaN, Inf or negative: count as 0 */
    uint32_t saturated;  /* above 2^62: count as 2^62 */
    uint32_t cut_paths;  /* ended at the hard stop */
};

/* The bits of 2^62. Above are those of larger numbers, of infinity and NaN, and
 * of all that is negative. */
#define SUM_LARGE 0x5e800000u

/* Adds one channel of a sample; what sum_accepts() refuses counts as 0. */
static inline void channel_add(GLOBAL struct sum *sum, float x, uint32_t *bad,
                               uint32_t *full)
{
    if (float_bits(x) > SUM_LARGE) { /* rare: one comparison for all */
        if (!sum_accepts(x)) {
            *bad = 1;
            return;
        }
        if (x > 0x1p62f)
            *full = 1;
    }
    sum_add(sum, x);
}

/* Adds a sample to the three sums of its pixel and to the tally. */
static inline void pixel_add(GLOBAL struct sum *sums, struct path_sample p,
                             struct tally *t)
{
    uint32_t bad = 0;
    uint32_t full = 0;

    channel_add(&sums[0], p.radiance.x, &bad, &full);
    channel_add(&sums[1], p.radiance.y, &bad, &full);
    channel_add(&sums[2], p.radiance.z, &bad, &full);
    t->samples++;
    t->rays += p.rays;
    t->non_finite += bad;
    t->saturated += full;
    t->cut_paths += p.cut;
}

#endif
