// SPDX-License-Identifier: MIT
/*
 * sky.h - radiance of the sky, and sampling of its image
 *
 * Directions are sampled from a table over the texels of the image
 * (world/light/sky_table.h) by inversion of its cdf, which keeps
 * stratification. They are uniform by solid angle within a texel.
 *
 * The table, world.sky_cdf, is an array of floats:
 *     height + 1             cdf over the rows, from 0 to 1
 *     height (width + 1)     cdf of each row over its columns
 *     height                 solid angle of a texel of each row
 *     height + 1             squared sine of half the polar angle at each edge
 *                            between rows
 *     SKY_STARTS + 1         for the cdf over the rows, and for each row over
 *     for each cdf           its columns: the interval in which k / SKY_STARTS
 *                            is (Chen and Asau 1974, "On generating random
 *                            variates from an empirical distribution")
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

/* Radiance of the sky without what exceeds a level: the mean of the channels is
 * at most that. */
static inline struct vec3 sky_below(float level, struct vec3 radiance)
{
    float mean = (radiance.x + radiance.y + radiance.z) * (1.0f / 3.0f);

    return mean > level ? v3_scale(radiance, level / mean) : radiance;
}

/* Squared sine of half the polar angle at the edge above a row. */
static inline float sky_edge_height(struct sky s, uint32_t row)
{
    float sine = cos_sin_turns(0.25f * (float)row / (float)s.height).y;

    return sine * sine;
}

/* Solid angle of a texel of this row. The difference of its edges' cosines is
 * written as a product, so that nothing cancels at the poles. */
static inline float sky_texel_angle(struct sky s, uint32_t row)
{
    float height = 1.0f / (float)s.height;
    float sine = cos_sin_turns(0.5f * ((float)row + 0.5f) * height).y;

    return 4.0f * PI / (float)s.width * sine * cos_sin_turns(0.25f * height).y;
}

/* Parts into which the starts of a cdf divide [0, 1]. A power of two, so that
 * the part of a float is exact. The search is 8 steps shorter. */
#define SKY_STARTS 256u

/* Index in sky_cdf of a row's cdf over its columns. For the row behind the last
 * it is the end of these. */
static inline uint32_t sky_row_cdf(struct sky s, uint32_t row)
{
    return s.height + 1u + row * (s.width + 1u);
}

/* Indices in sky_cdf of the solid angles, and of the squared sines. */
static inline uint32_t sky_angles(struct sky s)
{
    return sky_row_cdf(s, s.height);
}

static inline uint32_t sky_heights(struct sky s)
{
    return sky_angles(s) + s.height;
}

/* Index in sky_cdf of the starts of a cdf: 0 is that over the rows, row + 1
 * that of a row. For the one behind the last it is the length of sky_cdf. */
static inline uint32_t sky_starts(struct sky s, uint32_t cdf)
{
    return sky_heights(s) + s.height + 1u + cdf * (SKY_STARTS + 1u);
}

static inline uint32_t sky_table_length(struct sky s)
{
    return sky_starts(s, s.height + 1u);
}

/* Inverts a cdf whose ends from 0 to 1 begin at sky_cdf[first], and whose
 * starts begin at sky_cdf[starts]. Returns the last interval that begins at or
 * below u, and in *rest how far u is into it, in [0, 1]. Empty intervals are
 * never found. */
static inline uint32_t sky_cdf_find(const struct world *w, uint32_t first,
                                    uint32_t starts, float u, float *rest)
{
    uint32_t part = starts + (uint32_t)(u * (float)SKY_STARTS);
    uint32_t low = (uint32_t)w->sky_cdf[part];
    uint32_t n = (uint32_t)w->sky_cdf[part + 1u] - low + 1u;
    float begin;

    low += first;
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

/* A direction to a texel, uniform by solid angle. u is in [0, 1]. The world
 * must have a table. */
static inline struct vec3 sky_texel_direction(const struct world *w,
                                              uint32_t column, uint32_t row,
                                              struct vec2 u)
{
    struct sky s = w->settings.sky;
    bool is_below = 2u * row >= s.height;
    struct vec2 turn = cos_sin_turns(((float)column + u.x) / (float)s.width);
    float low, high, haversine, radius, y;
    struct vec3 d;

    /* the height is computed as the squared sine of half the angle to the
     * nearer pole, as the cosine has no digits left there */
    if (is_below) {
        row = s.height - 1u - row;
        u.y = 1.0f - u.y;
    }
    low = w->sky_cdf[sky_heights(s) + row];
    high = w->sky_cdf[sky_heights(s) + row + 1u];
    haversine = low + (high - low) * u.y;
    radius = 2.0f * sqrtf(haversine * (1.0f - haversine));
    y = 1.0f - 2.0f * haversine;
    d = v3(-radius * turn.y, is_below ? -y : y, radius * turn.x);
    return v3(s.rotation_cos * d.x + s.rotation_sin * d.z, d.y,
              s.rotation_cos * d.z - s.rotation_sin * d.x);
}

/* Samples a direction with density sky_table_pdf(). u is in [0, 1). The world
 * must have a table. */
static inline struct vec3 sky_sample(const struct world *w, struct vec2 u)
{
    struct sky s = w->settings.sky;
    float right, down;
    uint32_t row = sky_cdf_find(w, 0, sky_starts(s, 0), u.y, &down);
    uint32_t column = sky_cdf_find(w, sky_row_cdf(s, row),
                                   sky_starts(s, row + 1u), u.x, &right);

    return sky_texel_direction(w, column, row, v2(right, down));
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
           w->sky_cdf[sky_angles(s) + row];
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
