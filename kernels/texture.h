// SPDX-License-Identifier: MIT
/*
 * texture.h - texture look-ups
 *
 * Units:     u to the right, v up with 0 at the bottom; colours are returned
 *            linear
 */
#ifndef KERNELS_TEXTURE_H
#define KERNELS_TEXTURE_H

#include "kernels/vec.h"

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
    c.alpha = (float)(bits >> 24) * (1.0f / 255.0f);
    return c;
}

/* Transformed texture coordinates, clamped to the centres of the border texels
 * if the texture is. */
static inline struct vec2 texture_uv(struct texture t, struct vec2 uv)
{
    float x = 0.5f / (float)t.width;
    float y = 0.5f / (float)t.height;

    uv.x = uv.x * t.scale.x + t.offset.x;
    uv.y = uv.y * t.scale.y + t.offset.y;
    if (t.is_clamped != 0) {
        uv.x = f_min(f_max(uv.x, x), 1.0f - x);
        uv.y = f_min(f_max(uv.y, y), 1.0f - y);
    }
    return uv;
}

/* Bilinear look-up. Texels are decoded to linear before they are interpolated.
 */
static inline struct rgba texture_at(const struct world *w, uint32_t index,
                                     struct vec2 uv)
{
    struct texture t = w->textures[index];
    struct footprint f;
    struct rgba a, b, c, d, mix;

    uv = texture_uv(t, uv);
    wrap_pair(uv.x, t.width, &f.x0, &f.x1, &f.fx);
    wrap_pair(1.0f - (uv.y - floorf(uv.y)), t.height, &f.y0, &f.y1, &f.fy);
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
static inline struct vec2 uv_at(const struct world *w, struct tri t,
                                struct hit h)
{
    struct vec2 a = w->uvs[t.vt[0]];
    struct vec2 b = w->uvs[t.vt[1]];
    struct vec2 c = w->uvs[t.vt[2]];

    return v2(h.b0 * a.x + h.b1 * b.x + h.b2 * c.x,
              h.b0 * a.y + h.b1 * b.y + h.b2 * c.y);
}

/* Returns the alpha of a texture, 1 if there is none. */
static inline float alpha_at(const struct world *w, uint32_t texture,
                             struct vec2 uv)
{
    return texture != NO_INDEX && w->textures[texture].has_alpha != 0
               ? texture_at(w, texture, uv).alpha
               : 1.0f;
}

/* True if any surface of the scene has coverage below 1. */
static inline bool has_coverage(const struct world *w)
{
    return HAS(FEATURE_COVERAGE) &&
           (w->settings.features & FEATURE_COVERAGE) != 0;
}

/* The opacity times the alphas of the colour texture and of the opacity
 * texture. */
static inline float opacity_at(const struct world *w, struct material m,
                               struct tri t, struct hit h)
{
    if (HAS(FEATURE_TEXTURES) && t.vt[0] != NO_INDEX &&
        (m.color_texture != NO_INDEX || m.opacity_texture != NO_INDEX)) {
        struct vec2 uv = uv_at(w, t, h);

        return m.opacity * alpha_at(w, m.color_texture, uv) *
               alpha_at(w, m.opacity_texture, uv);
    }
    return m.opacity;
}

/* The probability with which a hit stops a ray. */
static inline float coverage_at(const struct world *w, struct hit h)
{
    struct tri t = w->tris[h.tri];
    struct material m = w->materials[t.material];
    float opacity = opacity_at(w, m, t, h);

    if (m.cutoff > 0.0f)
        return opacity < m.cutoff ? 0.0f : 1.0f;
    return opacity;
}

#endif
