// SPDX-License-Identifier: MIT
/*
 * surface_sums.h - sums of the first surfaces of a pixel's samples
 *
 * Units:     radiance, normalised scene units; albedos and normals as whole
 *            numbers of 16 bits
 * Threads:   one owner for each pixel
 */
#ifndef KERNELS_SURFACE_SUMS_H
#define KERNELS_SURFACE_SUMS_H

#include "kernels/first_surface.h"
#include "kernels/pixel.h"

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
