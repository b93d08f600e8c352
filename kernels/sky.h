// SPDX-License-Identifier: MIT
/*
 * sky.h - radiance of the sky, and sampling of its image
 *
 * Directions are sampled from a table over the texels of the image
 * (light/sky_table.h) by inversion of its cdf, which keeps stratification. They
 * are uniform by solid angle within a texel.
 *
 * Units:     radiance; densities per solid angle
 */
#ifndef KERNELS_SKY_H
#define KERNELS_SKY_H

#include "kernels/texture.h"

/* Position of direction d in the image, both in [0, 1]. The middle column is
 * -z, u grows towards +x, v from +y down. */
static inline struct vec2 sky_uv(struct sky s, struct vec3 d)
{
    float x = s.rotation_cos * d.x - s.rotation_sin * d.z;
    float z = s.rotation_sin * d.x + s.rotation_cos * d.z;

    return v2(0.5f + atan2_rad(x, -z) * (0.5f / PI),
              atan2_rad(sqrtf(x * x + z * z), d.y) * (1.0f / PI));
}

/* Radiance of the image at uv, bilinear and finite. Columns repeat, rows are
 * clamped at the poles. */
static inline struct vec3 sky_image_at(const struct world *w, struct vec2 uv)
{
    struct sky s = w->settings.sky;
    struct footprint f;
    struct vec3 top, bottom;
    float y, whole;

    wrap_pair(uv.x, s.width, &f.x0, &f.x1, &f.fx);
    y = uv.y * (float)s.height - 0.5f;
    whole = floorf(y);
    f.fy = y - whole;
    f.y0 = whole < 0.0f ? 0u : (uint32_t)whole;
    f.y1 = whole < 0.0f ? 0u : f.y0 + 1u;
    if (f.y0 >= s.height)
        f.y0 = s.height - 1u;
    if (f.y1 >= s.height)
        f.y1 = s.height - 1u;
    top = v3_lerp(w->sky_texels[f.y0 * s.width + f.x0],
                  w->sky_texels[f.y0 * s.width + f.x1], f.fx);
    bottom = v3_lerp(w->sky_texels[f.y1 * s.width + f.x0],
                     w->sky_texels[f.y1 * s.width + f.x1], f.fx);
    return v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX),
                  v3_mul(v3_lerp(top, bottom, f.fy), s.color));
}

/* Radiance from direction d if nothing occludes it. */
static inline struct vec3 sky_radiance(const struct world *w, struct vec3 d)
{
    struct sky s = w->settings.sky;

    if (!HAS(FEATURE_SKY_IMAGE) || s.width == 0)
        return s.color;
    return sky_image_at(w, sky_uv(s, d));
}

/* Solid angle of a texel of this row. The difference of its edges' cosines is
 * written as a product, so that nothing cancels at the poles. */
static inline float sky_texel_angle(struct sky s, uint32_t row)
{
    float height = 1.0f / (float)s.height;
    float sine = cos_sin_turns(0.5f * ((float)row + 0.5f) * height).y;

    return 4.0f * PI / (float)s.width * sine * cos_sin_turns(0.25f * height).y;
}

/* Inverts a cdf of n intervals, whose n + 1 ends from 0 to 1 begin at
 * sky_cdf[first]. Returns the last interval that begins at or below u, and in
 * *rest how far u is into it, in [0, 1]. Empty intervals are never found. */
static inline uint32_t sky_cdf_find(const struct world *w, uint32_t first,
                                    uint32_t n, float u, float *rest)
{
    uint32_t low = first;
    float begin;

    while (n > 1) {
        uint32_t jump = n / 2;

        if (w->sky_cdf[low + jump] <= u)
            low += jump;
        n -= jump;
    }
    begin = w->sky_cdf[low];
    *rest = f_min((u - begin) / (w->sky_cdf[low + 1] - begin), 1.0f);
    return low - first;
}

/* Index in sky_cdf of a row's cdf over its columns. These follow the cdf over
 * the rows. For the row behind the last it is the length of sky_cdf. */
static inline uint32_t sky_row_cdf(struct sky s, uint32_t row)
{
    return s.height + 1u + row * (s.width + 1u);
}

/* Samples a direction with density sky_table_pdf(). The world must have a
 * table. */
static inline struct vec3 sky_sample(const struct world *w, struct vec2 u)
{
    struct sky s = w->settings.sky;
    float right, down, low, high, haversine, radius, y;
    uint32_t row = sky_cdf_find(w, 0, s.height, u.y, &down);
    uint32_t column =
        sky_cdf_find(w, sky_row_cdf(s, row), s.width, u.x, &right);
    bool is_below = 2u * row >= s.height;
    struct vec2 turn = cos_sin_turns(((float)column + right) / (float)s.width);
    struct vec3 d;

    /* the height is computed as the squared sine of half the angle to the
     * nearer pole, as the cosine has no digits left there */
    if (is_below) {
        row = s.height - 1u - row;
        down = 1.0f - down;
    }
    low = cos_sin_turns(0.25f * (float)row / (float)s.height).y;
    high = cos_sin_turns(0.25f * (float)(row + 1u) / (float)s.height).y;
    low *= low;
    high *= high;
    haversine = low + (high - low) * down;
    radius = 2.0f * sqrtf(haversine * (1.0f - haversine));
    y = 1.0f - 2.0f * haversine;
    d = v3(-radius * turn.y, is_below ? -y : y, radius * turn.x);
    return v3(s.rotation_cos * d.x + s.rotation_sin * d.z, d.y,
              s.rotation_cos * d.z - s.rotation_sin * d.x);
}

/* True if the world has a table for sky_sample(). */
static inline bool sky_has_table(const struct world *w)
{
    return HAS(FEATURE_SKY_IMAGE) && w->settings.sky_cdf_count > 0;
}

/* Density of sky_sample() at a direction, given its position uv in the image.
 */
static inline float sky_table_pdf(const struct world *w, struct vec2 uv)
{
    struct sky s = w->settings.sky;
    uint32_t row = (uint32_t)(uv.y * (float)s.height);
    uint32_t column = (uint32_t)(uv.x * (float)s.width);
    uint32_t first;

    row = row < s.height ? row : s.height - 1u;
    column = column < s.width ? column : s.width - 1u;
    first = sky_row_cdf(s, row) + column;
    return (w->sky_cdf[row + 1] - w->sky_cdf[row]) *
           (w->sky_cdf[first + 1] - w->sky_cdf[first]) /
           sky_texel_angle(s, row);
}

/* sky_radiance() and the density of sky_sample() at the unit vector d. The
 * world must have a table. */
static inline struct vec3 sky_terms(const struct world *w, struct vec3 d,
                                    float *pdf)
{
    struct vec2 uv = sky_uv(w->settings.sky, d);

    *pdf = sky_table_pdf(w, uv);
    return sky_image_at(w, uv);
}

#endif
