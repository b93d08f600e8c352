// SPDX-License-Identifier: MIT
/*
 * ggx.h - the GGX distribution of microfacets: sampling, density, masking
 *
 * Height-correlated masking after Smith (Heitz 2014, JCGT 3:2); visible normals
 * by spherical caps (Dupuy and Benyoub 2023), bounded for reflection (Eto and
 * Tokuyoshi 2023). No expression suffers cancellation or divides by a cosine,
 * so that all hold at grazing angles and down to ALPHA_SMOOTH.
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

/* Distribution of normals D(h). */
static inline float ggx_density(struct vec3 h, float alpha)
{
    float a2 = alpha * alpha;
    float d = a2 * h.z * h.z + h.x * h.x + h.y * h.y;

    return a2 / (PI * d * d);
}

/* sqrt(alpha^2 + (1 - alpha^2) mu^2), of which Smith's Lambda is made, without
 * its division. */
static inline float ggx_root(float alpha, float mu)
{
    float a2 = alpha * alpha;

    return sqrtf(a2 + (1.0f - a2) * mu * mu);
}

/* Samples a microfacet normal visible from wo. A bound of 1 has all visible
 * normals; ggx_bound() leaves out some that reflect to below the surface. */
static inline struct vec3 ggx_visible_normal(struct vec3 wo, float alpha,
                                             float bound, struct vec2 u)
{
    struct vec3 s = v3_unit(v3(alpha * wo.x, alpha * wo.y, wo.z));
    float b = bound * s.z;
    float z = (1.0f - u.y) * (1.0f + b) - b;
    float r = sqrtf(f_max((1.0f - z) * (1.0f + z), 0.0f));
    struct vec2 turn = cos_sin_turns(u.x);
    struct vec3 c = v3(r * turn.x + s.x, r * turn.y + s.y, z + s.z);
    struct vec3 h = v3(alpha * c.x, alpha * c.y, f_max(c.z, 0.0f));
    float length = v3_length(h);

    if (!(length > 0.0f))
        return v3(0.0f, 0.0f, 1.0f);
    return v3_scale(h, 1.0f / length);
}

/* The bound for reflection, k of Eto and Tokuyoshi 2023. */
static inline float ggx_bound(struct vec3 wo, float alpha)
{
    float a2 = alpha * alpha;
    float reach = 1.0f + sqrtf(wo.x * wo.x + wo.y * wo.y);
    float r2 = reach * reach;

    return (1.0f - a2) * r2 / (r2 + a2 * wo.z * wo.z);
}

/* Samples a reflected direction with density ggx_reflection_pdf(). A direction
 * with z <= 0 is a rejected sample. */
static inline struct vec3 ggx_reflect(struct vec3 wo, float alpha,
                                      struct vec2 u)
{
    return reflect_at(wo,
                      ggx_visible_normal(wo, alpha, ggx_bound(wo, alpha), u));
}

static inline float ggx_reflection_pdf(struct vec3 wo, struct vec3 h,
                                       float alpha)
{
    return ggx_density(h, alpha) /
           (2.0f * (ggx_bound(wo, alpha) * wo.z + ggx_root(alpha, wo.z)));
}

/* f |cosine| of a reflection without its Fresnel factor: D G2 / (4 mu_o). */
static inline float ggx_reflection(struct vec3 wo, struct vec3 wi,
                                   struct vec3 h, float alpha)
{
    float t_o = ggx_root(alpha, wo.z);
    float t_i = ggx_root(alpha, wi.z);

    return ggx_density(h, alpha) * wi.z / (2.0f * (wo.z * t_i + wi.z * t_o));
}

#endif
