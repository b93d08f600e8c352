// SPDX-License-Identifier: MIT
/*
 * sheen.h - the sheen of cloth: fibres that stand off the surface
 *
 * Distribution of normals, and masking by a fit, of Estevez and Kulla 2017,
 * "Production friendly microfacet sheen BRDF". Reciprocal.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine|
 */
#ifndef KERNELS_SHEEN_H
#define KERNELS_SHEEN_H

#include "kernels/bsdf_types.h"
#include "kernels/energy.h"
#include "kernels/power.h"

/* The fit of Lambda's logarithm, from parameters of roughness 0 and 1. */
static inline float sheen_log_lambda(float cosine, float alpha)
{
    float s = (1.0f - alpha) * (1.0f - alpha);
    float a = 21.5473f + s * (25.3245f - 21.5473f);
    float b = 3.82987f + s * (3.32435f - 3.82987f);
    float c = 0.19823f + s * (0.16801f - 0.19823f);
    float d = -1.97760f + s * (-1.27393f + 1.97760f);
    float e = -4.32054f + s * (-4.85967f + 4.32054f);

    return a / (1.0f + b * f_pow(cosine, c)) + d * cosine + e;
}

static inline float sheen_lambda(float cosine, float alpha)
{
    return f_exp(cosine < 0.5f ? sheen_log_lambda(cosine, alpha)
                               : 2.0f * sheen_log_lambda(0.5f, alpha) -
                                     sheen_log_lambda(1.0f - cosine, alpha));
}

/* f |cosine| of white sheen: D / (4 mu_o (1 + Lambda_o + Lambda_i)). */
static inline float sheen_f(struct vec3 wo, struct vec3 wi, float alpha)
{
    struct vec3 h = half_vector(wo, wi);
    float sine = sqrtf(h.x * h.x + h.y * h.y);
    float d = (2.0f + 1.0f / alpha) * f_pow(sine, 1.0f / alpha) * (0.5f / PI);

    return d / (4.0f * wo.z *
                (1.0f + sheen_lambda(wo.z, alpha) + sheen_lambda(wi.z, alpha)));
}

/* Directions are uniform over the hemisphere. */
#define SHEEN_PDF (0.5f / PI)

static inline struct vec3 sheen_direction(struct vec2 u)
{
    return v3_around_z(u.y, u.x);
}

#endif
