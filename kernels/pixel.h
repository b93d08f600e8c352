// SPDX-License-Identifier: MIT
/*
 * pixel.h - adds samples and their first surfaces to the sums of their pixel
 *
 * Units:     radiance, normalised scene units; albedos and normals as whole
 *            numbers of 16 bits
 * Threads:   one owner for each pixel
 * Errors:    NaN, infinite and negative channels count as 0 and are counted
 */
#ifndef KERNELS_PIXEL_H
#define KERNELS_PIXEL_H

#include "kernels/first_surface.h"
#include "kernels/path_types.h"
#include "kernels/sum.h"

/* ---- light ---- */

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

/* ---- first surfaces ---- */

/* Samples of a pixel whose features are added, the first by their indices, so
 * that sums have 32 bits. Many fewer suffice for an exact mean. */
#define SURFACE_SAMPLES_MAX 65536u

/* The largest albedo, and the largest component of a normal, as numbers. */
#define SURFACE_ONE 65535.0f

struct surface_sums {
    /* direct light, and the part of it that is seen, of all samples and of odd
     * ones: parts of the film's sums */
    struct sum direct[3];
    struct sum odd_direct[3];
    struct sum seen[3];
    struct sum odd_seen[3];
    struct sum depth;
    struct sum depth_square;
    uint32_t albedo[3];
    uint32_t normal[3];     /* of (1 + n) / 2 */
    uint32_t albedo_square; /* mean of the components' squares */
    uint32_t count;         /* samples that were added to features, */
    uint32_t hit_count;     /* and those that have some */
    uint32_t seen_count;    /* samples with light that is seen, or black sky */
};

static inline void surface_clear(GLOBAL struct surface_sums *sums)
{
    const struct sum zero = {0, 0};

    for (uint32_t c = 0; c < 3; c++) {
        sums->direct[c] = sums->odd_direct[c] = zero;
        sums->seen[c] = sums->odd_seen[c] = zero;
        sums->albedo[c] = sums->normal[c] = 0;
    }
    sums->depth = sums->depth_square = zero;
    sums->albedo_square = sums->count = sums->hit_count = sums->seen_count = 0;
}

/* Returns the number of 16 bits for x in [0, 1]. */
static inline uint32_t surface_number(float x)
{
    return (uint32_t)(f_max(f_min(x, 1.0f), 0.0f) * SURFACE_ONE + 0.5f);
}

static inline void surface_add_vector(GLOBAL uint32_t *sums, struct vec3 v)
{
    sums[0] += surface_number(v.x);
    sums[1] += surface_number(v.y);
    sums[2] += surface_number(v.z);
}

static inline void surface_add_features(GLOBAL struct surface_sums *sums,
                                        struct first_surface s)
{
    float depth = f_min(s.depth, 0x1p30f);

    sums->count++;
    if (s.state == SURFACE_AHEAD)
        return;
    sums->hit_count++;
    surface_add_vector(sums->albedo, s.albedo);
    sums->albedo_square +=
        surface_number(v3_dot(s.albedo, s.albedo) * (1.0f / 3.0f));
    surface_add_vector(sums->normal,
                       v3_scale(v3_add(s.normal, v3(1.0f, 1.0f, 1.0f)), 0.5f));
    sum_add(&sums->depth, depth);
    sum_add(&sums->depth_square, depth * depth);
}

/* Adds the first surface of sample `index`. Channels of its radiance that count
 * as 0 have no direct light either. */
static inline void surface_add(GLOBAL struct surface_sums *sums, uint64_t index,
                               struct first_surface s, struct vec3 radiance)
{
    bool is_odd = (index & 1) != 0;
    uint32_t bad = 0, full = 0;

    if (!sum_accepts(radiance.x))
        s.direct.x = s.seen.x = 0.0f;
    if (!sum_accepts(radiance.y))
        s.direct.y = s.seen.y = 0.0f;
    if (!sum_accepts(radiance.z))
        s.direct.z = s.seen.z = 0.0f;
    if (s.seen.x + s.seen.y + s.seen.z > 0.0f || !(s.depth > 0.0f))
        sums->seen_count++;
    rgb_add(sums->direct, sums->odd_direct, is_odd, s.direct, &bad, &full);
    rgb_add(sums->seen, sums->odd_seen, is_odd, s.seen, &bad, &full);
    if (index < SURFACE_SAMPLES_MAX)
        surface_add_features(sums, s);
}

#endif
