// SPDX-License-Identifier: MIT
/*
 * sample.h - warps of the unit square to disk and hemisphere
 *
 * Units:     unit vectors around +z; densities per solid angle
 */
#ifndef KERNELS_SAMPLE_H
#define KERNELS_SAMPLE_H

#include "kernels/vec.h"

/* Maps the square to the unit disk concentrically (Shirley and Chiu 1997, "A
 * low distortion map between disk and square"). */
static inline struct vec2 disk_from_square(struct vec2 u)
{
    struct vec2 p = v2(2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f);
    bool is_high = !(fabsf(p.x) > fabsf(p.y));
    float radius, angle;

    p = v2_swap_if(is_high, p);
    radius = p.x;
    if (radius == 0.0f)
        return v2(0.0f, 0.0f);
    angle = PI * 0.25f * (p.y / radius);
    return v2_swap_if(is_high,
                      v2(radius * cos_small(angle), radius * sin_small(angle)));
}

/* A uniform direction of the cone around the unit vector n. `size` is 1 minus
 * the cosine of the cone's half angle, and the density 1 / (2 pi size). Narrow
 * cones keep their digits. */
static inline struct vec3 cone_around(struct vec3 n, float size, struct vec2 u)
{
    struct vec2 p = disk_from_square(u);
    float height = size * (p.x * p.x + p.y * p.y);
    float width = sqrtf(f_max(size * (2.0f - height), 0.0f));
    struct vec3 t, b;

    frame_around(n, &t, &b);
    return v3_unit_again(
        v3_add(v3_add(v3_scale(t, p.x * width), v3_scale(b, p.y * width)),
               v3_scale(n, 1.0f - height)));
}

static inline float cone_pdf(float size)
{
    return 1.0f / (2.0f * PI * size);
}

/* A direction of the hemisphere around +z with density cosine / pi. */
static inline struct vec3 cosine_hemisphere(struct vec2 u)
{
    struct vec2 p = disk_from_square(u);

    return v3(p.x, p.y, sqrtf(f_max(1.0f - p.x * p.x - p.y * p.y, 0.0f)));
}

/* A direction of the hemisphere around the unit vector n, with the same
 * density. */
static inline struct vec3 cosine_around(struct vec3 n, struct vec2 u)
{
    struct vec3 d = cosine_hemisphere(u), t, b;

    frame_around(n, &t, &b);
    return v3_unit_again(
        v3_add(v3_add(v3_scale(t, d.x), v3_scale(b, d.y)), v3_scale(n, d.z)));
}

#endif
