// SPDX-License-Identifier: MIT
/*
 * sample.h - warps of the unit square
 *
 * Units:     unit vectors around +z; densities per solid angle
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef KERNELS_SAMPLE_H
#define KERNELS_SAMPLE_H

#include "kernels/vec.h"

/* Concentric map of the square to the unit disk (Shirley and Chiu 1997). */
static inline struct vec2 disk_from_square(struct vec2 u)
{
    float a = 2.0f * u.x - 1.0f;
    float b = 2.0f * u.y - 1.0f;
    bool is_wide = fabsf(a) > fabsf(b);
    float radius = f_pick(is_wide, a, b);
    float angle = PI * 0.25f * (f_pick(is_wide, b, a) / radius);
    float along = radius * cos_small(angle);
    float across = radius * sin_small(angle);

    if (radius == 0.0f)
        return v2(0.0f, 0.0f);
    return v2(f_pick(is_wide, along, across), f_pick(is_wide, across, along));
}

/* Density cosine / pi. */
static inline struct vec3 cosine_hemisphere(struct vec2 u)
{
    struct vec2 p = disk_from_square(u);

    return v3(p.x, p.y, sqrtf(f_max(1.0f - p.x * p.x - p.y * p.y, 0.0f)));
}

/* The same around the unit vector n. */
static inline struct vec3 cosine_around(struct vec3 n, struct vec2 u)
{
    struct vec3 d = cosine_hemisphere(u), t, b;

    frame_around(n, &t, &b);
    return v3_unit(
        v3_add(v3_add(v3_scale(t, d.x), v3_scale(b, d.y)), v3_scale(n, d.z)));
}

#endif
