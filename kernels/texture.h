// SPDX-License-Identifier: MIT
/*
 * texture.h - texture look-ups
 *
 * Units:     u to the right, v up with 0 at the bottom; colours are returned
 *            linear
 */
#ifndef KERNELS_TEXTURE_H
#define KERNELS_TEXTURE_H

#include "kernels/instance.h"

struct rgba {
    struct vec3 color;
    float alpha;
};

/* The footprint of a bilinear look-up: four texels, and the weights of the
 * right and the lower ones. */
struct footprint {
    uint32_t x0, x1, y0, y1;
    float fx, fy;
};

/* True if the texture has one of these flags, in builds that know them. */
static inline bool texture_has(struct texture t, uint32_t flags)
{
    return HAS(FEATURE_TEXTURE_OPTIONS) && (t.flags & flags) != 0;
}

/* The column at u in a row of n texels that repeats, its right neighbour, and
 * the neighbour's weight. u is taken as 1 if it is infinite or NaN, as
 * coordinates beyond the range of float may be. */
static inline void wrap_pair(float u, uint32_t n, uint32_t *a, uint32_t *b,
                             float *fraction)
{
    float x = f_min(u - floorf(u), 1.0f) * (float)n - 0.5f;
    float whole = floorf(x);
    int32_t i = (int32_t)whole;

    *fraction = x - whole;
    *a = i < 0 ? n - 1u : (uint32_t)i < n ? (uint32_t)i : n - 1u;
    *b = *a + 1u < n ? *a + 1u : 0u;
}

/* The texel of column i, from -1 to 2 n, of a row of n texels that is followed
 * by its mirror image. */
static inline uint32_t mirrored(int32_t i, uint32_t n)
{
    uint32_t k = i < 0 ? 0u : (uint32_t)i;

    k = k < 2u * n ? k : 0u;
    return k < n ? k : 2u * n - 1u - k;
}

/* wrap_pair() for rows that may be mirrored or without interpolation, by flags
 * of which those of the other axis are removed. */
static inline void wrap_pair_by(uint32_t flags, float u, uint32_t n,
                                uint32_t *a, uint32_t *b, float *fraction)
{
    bool is_nearest = (flags & TEXTURE_NEAREST) != 0;
    float middle = is_nearest ? 0.0f : 0.5f;
    float x, whole;

    if ((flags & (TEXTURE_MIRROR_U | TEXTURE_MIRROR_V)) != 0) {
        x = f_min(u - 2.0f * floorf(0.5f * u), 2.0f) * (float)n - middle;
        whole = floorf(x);
        *a = mirrored((int32_t)whole, n);
        *b = mirrored((int32_t)whole + 1, n);
        *fraction = x - whole;
    } else if (is_nearest) {
        x = f_min(u - floorf(u), 1.0f) * (float)n;
        *a = (uint32_t)x < n ? (uint32_t)x : 0u;
    } else {
        wrap_pair(u, n, a, b, fraction);
    }
    if (is_nearest) {
        *b = *a;
        *fraction = 0.0f;
    }
}

/* The lowest bit of the channel in a texel that its number is. */
static inline uint32_t texture_shift(struct texture t)
{
    return (8u * t.channel + 24u) & 31u;
}

static inline struct rgba texel(const struct world *w, struct texture t,
                                uint32_t x, uint32_t y)
{
    uint32_t bits = w->texels[t.first + y * t.width + x];
    struct rgba c;

    if (t.is_data != 0)
        c.color = v3_scale(v3((float)(bits & 255u), (float)(bits >> 8 & 255u),
                              (float)(bits >> 16 & 255u)),
                           1.0f / 255.0f);
    else
        c.color = v3(w->linear_of_srgb[bits & 255u],
                     w->linear_of_srgb[bits >> 8 & 255u],
                     w->linear_of_srgb[bits >> 16 & 255u]);
    if (HAS(FEATURE_TEXTURE_OPTIONS))
        bits = bits >> texture_shift(t) << 24;
    c.alpha = (float)(bits >> 24) * (1.0f / 255.0f);
    return c;
}

/* Transformed texture coordinates, clamped to the centres of the border texels
 * if the texture is. Builds without FEATURE_TEXTURE_OPTIONS have textures that
 * are clamped on both axes or on none. */
static inline struct vec2 texture_uv(struct texture t, struct vec2 uv)
{
    float x = 0.5f / (float)t.width;
    float y = 0.5f / (float)t.height;

    if (texture_has(t, TEXTURE_ROTATED)) {
        float u = uv.x * t.scale.x;
        float v = uv.y * t.scale.y;

        uv.x = u * t.rotation.x - v * t.rotation.y + t.offset.x;
        uv.y = u * t.rotation.y + v * t.rotation.x + t.offset.y;
    } else {
        uv.x = uv.x * t.scale.x + t.offset.x;
        uv.y = uv.y * t.scale.y + t.offset.y;
    }
    if (HAS(FEATURE_TEXTURE_OPTIONS)) {
        if ((t.flags & TEXTURE_CLAMP_U) != 0)
            uv.x = f_min(f_max(uv.x, x), 1.0f - x);
        if ((t.flags & TEXTURE_CLAMP_V) != 0)
            uv.y = f_min(f_max(uv.y, y), 1.0f - y);
    } else if ((t.flags & TEXTURE_CLAMP) != 0) {
        uv.x = f_min(f_max(uv.x, x), 1.0f - x);
        uv.y = f_min(f_max(uv.y, y), 1.0f - y);
    }
    return uv;
}

/* The texels around transformed coordinates. */
static inline struct footprint texture_footprint(struct texture t,
                                                 struct vec2 uv)
{
    struct footprint f;
    bool is_mirrored = texture_has(t, TEXTURE_MIRROR_V);
    float v = 1.0f - (is_mirrored ? uv.y : uv.y - floorf(uv.y));

    if (texture_has(t, TEXTURE_MIRROR_U | TEXTURE_MIRROR_V | TEXTURE_NEAREST)) {
        wrap_pair_by(t.flags & ~TEXTURE_MIRROR_V, uv.x, t.width, &f.x0, &f.x1,
                     &f.fx);
        wrap_pair_by(t.flags & ~TEXTURE_MIRROR_U, v, t.height, &f.y0, &f.y1,
                     &f.fy);
    } else {
        wrap_pair(uv.x, t.width, &f.x0, &f.x1, &f.fx);
        wrap_pair(v, t.height, &f.y0, &f.y1, &f.fy);
    }
    return f;
}

/* Bilinear look-up. Texels are decoded to linear before they are interpolated.
 */
static inline struct rgba texture_at(const struct world *w, uint32_t index,
                                     struct vec2 uv)
{
    struct texture t = w->textures[index];
    struct footprint f = texture_footprint(t, texture_uv(t, uv));
    struct rgba a, b, c, d, mix;

    a = texel(w, t, f.x0, f.y0);
    b = texel(w, t, f.x1, f.y0);
    c = texel(w, t, f.x0, f.y1);
    d = texel(w, t, f.x1, f.y1);
    mix.color = v3_lerp(v3_lerp(a.color, b.color, f.fx),
                        v3_lerp(c.color, d.color, f.fx), f.fy);
    a.alpha += (b.alpha - a.alpha) * f.fx;
    c.alpha += (d.alpha - c.alpha) * f.fx;
    mix.alpha = a.alpha + (c.alpha - a.alpha) * f.fy;
    return mix;
}

/* Interpolated texture coordinates of a hit. Its triangle has some. */
static inline struct vec2 uv_of(GLOBAL const struct vec2 *uvs, struct tri t,
                                struct hit h)
{
    struct vec2 a = uvs[t.vt[0]];
    struct vec2 b = uvs[t.vt[1]];
    struct vec2 c = uvs[t.vt[2]];

    return v2(h.b0 * a.x + h.b1 * b.x + h.b2 * c.x,
              h.b0 * a.y + h.b1 * b.y + h.b2 * c.y);
}

static inline bool has_second_uvs(const struct world *w)
{
    return HAS(FEATURE_TEXTURE_OPTIONS) && w->settings.uv2_count > 0u;
}

/* True if a texture is looked up by the second texture coordinates. */
static inline bool uses_second_uvs(const struct world *w, uint32_t texture)
{
    return has_second_uvs(w) &&
           (w->textures[texture].flags & TEXTURE_SECOND_UVS) != 0;
}

/* Texture coordinates of a hit, of the set that the texture uses. */
static inline struct vec2 texture_uv_at(const struct world *w, uint32_t texture,
                                        struct tri t, struct hit h)
{
    return uses_second_uvs(w, texture) ? uv_of(w->uvs2, t, h)
                                       : uv_of(w->uvs, t, h);
}

/* Returns the alpha of a texture at a hit with uv, 1 if there is none. */
static inline float alpha_at(const struct world *w, uint32_t texture,
                             struct tri t, struct hit h, struct vec2 uv)
{
    if (texture == NO_INDEX || w->textures[texture].has_alpha == 0)
        return 1.0f;
    if (uses_second_uvs(w, texture))
        uv = uv_of(w->uvs2, t, h);
    return texture_at(w, texture, uv).alpha;
}

/* True if any surface of the scene has coverage below 1. */
static inline bool has_coverage(const struct world *w)
{
    return HAS(FEATURE_COVERAGE) &&
           (w->settings.features & FEATURE_COVERAGE) != 0;
}

/* The opacity times the alphas of the opacity texture and, unless it has the
 * same image, of the colour texture. */
static inline float opacity_at(const struct world *w,
                               GLOBAL const struct material *m, struct tri t,
                               struct hit h)
{
    if (HAS(FEATURE_TEXTURES) && t.vt[0] != NO_INDEX &&
        (m->color_texture != NO_INDEX || m->opacity_texture != NO_INDEX)) {
        struct vec2 uv = uv_of(w->uvs, t, h);

        uint32_t color = m->color_is_opaque != 0u ? NO_INDEX : m->color_texture;

        return m->opacity * alpha_at(w, color, t, h, uv) *
               alpha_at(w, m->opacity_texture, t, h, uv);
    }
    return m->opacity;
}

/* The alpha of the vertices at a hit. */
static inline float vertex_alpha(const struct world *w, struct tri t,
                                 struct hit h)
{
    return w->alphas[t.v[0]] * h.b0 + w->alphas[t.v[1]] * h.b1 +
           w->alphas[t.v[2]] * h.b2;
}

/* The probability with which a hit stops a ray. */
static inline float coverage_at(const struct world *w, struct hit h)
{
    struct tri t = tri_at(w, h.tri, instance_of(w, h.tri));
    GLOBAL const struct material *m = &w->materials[t.material];
    float opacity = opacity_at(w, m, t, h);

    if (HAS(FEATURE_VERTEX_ALPHAS) && w->settings.alpha_count > 0u)
        opacity *= vertex_alpha(w, t, h);
    if (m->cutoff > 0.0f)
        return opacity < m->cutoff ? 0.0f : 1.0f;
    return opacity;
}

#endif
