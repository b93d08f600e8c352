// SPDX-License-Identifier: MIT
/*
 * ggx.h - the GGX distribution of microfacets: sampling, density, masking
 *
 * Height-correlated masking after Smith (Heitz 2014, JCGT 3:2); visible normals
 * by spherical caps (Dupuy and Benyoub 2023), bounded for reflection (Eto and
 * Tokuyoshi 2023). No expression suffers cancellation or divides by a cosine,
 * so that all hold at grazing angles and down to ALPHA_SMOOTH. A distribution
 * that is stretched along x has the widths alpha * stretch and alpha / stretch
 * along x and y.
 *
 * Units:     local frame, z along the normal; densities per solid angle
 */
#ifndef KERNELS_GGX_H
#define KERNELS_GGX_H

#include "kernels/vec.h"

static inline struct vec3 reflect_at(struct vec3 wo, struct vec3 h)
{
    return v3_sub(v3_scale(h, 2.0f * v3_dot(wo, h)), wo);
}

/* Unit half vector of wo and wi. If they are opposite it is +z. */
static inline struct vec3 half_vector(struct vec3 wo, struct vec3 wi)
{
    struct vec3 h = v3_add(wo, wi);
    float length = v3_length(h);

    if (!(length > 1e-18f))
        return v3(0.0f, 0.0f, 1.0f);
    return v3_scale(h, 1.0f / length);
}

struct ggx {
    float alpha;
    float stretch; /* 1 or more; builds without anisotropy take it as 1 */
};

/* Returns v with x and y multiplied by the widths along them, in units of
 * alpha. */
static inline struct vec3 ggx_stretched(struct ggx g, struct vec3 v)
{
    return HAS(FEATURE_ANISOTROPY) ? v3(v.x * g.stretch, v.y / g.stretch, v.z)
                                   : v;
}

/* Distribution of normals D(h). */
static inline float ggx_density(struct vec3 h, struct ggx g)
{
    float a2 = g.alpha * g.alpha;
    float d;

    if (HAS(FEATURE_ANISOTROPY))
        h = v3(h.x / g.stretch, h.y * g.stretch, h.z);
    d = a2 * h.z * h.z + h.x * h.x + h.y * h.y;

    return a2 / (PI * d * d);
}

/* sqrt(alpha^2 + (1 - alpha^2) w.z^2), of which Smith's Lambda is made, without
 * its division. */
static inline float ggx_root(struct vec3 w, struct ggx g)
{
    float a2 = g.alpha * g.alpha;

    if (HAS(FEATURE_ANISOTROPY) && g.stretch != 1.0f) {
        struct vec3 s = ggx_stretched(g, w);

        return sqrtf(a2 * (s.x * s.x + s.y * s.y) + w.z * w.z);
    }
    return sqrtf(a2 + (1.0f - a2) * w.z * w.z);
}

/* Samples a microfacet normal visible from wo. A bound of 1 has all visible
 * normals; ggx_bound() leaves out some that reflect to below the surface. */
static inline struct vec3 ggx_visible_normal(struct vec3 wo, struct ggx g,
                                             float bound, struct vec2 u)
{
    float alpha = g.alpha;
    struct vec3 at = ggx_stretched(g, wo);
    struct vec3 s = v3_unit(v3(alpha * at.x, alpha * at.y, wo.z));
    float b = bound * s.z;
    float z = (1.0f - u.y) * (1.0f + b) - b;
    struct vec3 c = v3_add(v3_around_z(z, u.x), s);
    struct vec3 wide = ggx_stretched(g, c);
    struct vec3 h = v3(alpha * wide.x, alpha * wide.y, f_max(c.z, 0.0f));
    float length = v3_length(h);

    if (!(length > 0.0f))
        return v3(0.0f, 0.0f, 1.0f);
    return v3_scale(h, 1.0f / length);
}

/* The bound for reflection, k of Eto and Tokuyoshi 2023. */
static inline float ggx_bound(struct vec3 wo, struct ggx g)
{
    /* the width across */
    float least = HAS(FEATURE_ANISOTROPY) ? g.alpha / g.stretch : g.alpha;
    float a2 = least * least;
    float reach = 1.0f + sqrtf(wo.x * wo.x + wo.y * wo.y);
    float r2 = reach * reach;

    return (1.0f - a2) * r2 / (r2 + a2 * wo.z * wo.z);
}

/* Samples a reflected direction with density ggx_reflection_pdf(). A direction
 * with z <= 0 is a rejected sample. */
static inline struct vec3 ggx_reflect(struct vec3 wo, struct ggx g,
                                      struct vec2 u)
{
    return reflect_at(wo, ggx_visible_normal(wo, g, ggx_bound(wo, g), u));
}

static inline float ggx_reflection_pdf(struct vec3 wo, struct vec3 h,
                                       struct ggx g)
{
    return ggx_density(h, g) /
           (2.0f * (ggx_bound(wo, g) * wo.z + ggx_root(wo, g)));
}

/* f |cosine| of a reflection without its Fresnel factor: D G2 / (4 mu_o). */
static inline float ggx_reflection(struct vec3 wo, struct vec3 wi,
                                   struct vec3 h, struct ggx g)
{
    float t_o = ggx_root(wo, g);
    float t_i = ggx_root(wi, g);

    return ggx_density(h, g) * wi.z / (2.0f * (wo.z * t_i + wi.z * t_o));
}

#endif
