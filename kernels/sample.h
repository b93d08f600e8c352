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
    float angle;

    if (a == 0.0f && b == 0.0f)
        return v2(0.0f, 0.0f);
    if (fabsf(a) > fabsf(b)) {
        angle = PI * 0.25f * (b / a);
        return v2(a * cos_small(angle), a * sin_small(angle));
    }
    angle = PI * 0.25f * (a / b);
    return v2(b * sin_small(angle), b * cos_small(angle));
}

/* Density cosine / pi. */
static inline struct vec3 cosine_hemisphere(struct vec2 u)
{
    struct vec2 p = disk_from_square(u);

    return v3(p.x, p.y, sqrtf(f_max(1.0f - p.x * p.x - p.y * p.y, 0.0f)));
}

#endif
