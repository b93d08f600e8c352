// SPDX-License-Identifier: MIT
/*
 * diffuse.h - smooth and rough diffuse surfaces
 *
 * Lambert's law, and the energy-preserving Oren-Nayar model (EON) of
 * Portsmouth, Kutz and Hill 2024, whose roughness is `alpha`. Directions are
 * drawn by the cosine in both.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine|
 */
#ifndef KERNELS_DIFFUSE_H
#define KERNELS_DIFFUSE_H

#include "kernels/bsdf_types.h"
#include "kernels/sample.h"

/* Constants of EON: 1/2 - 2/(3 pi) and 2/3 - 28/(15 pi). */
#define EON_C1 0.287793409f
#define EON_C2 0.0724882125f

static inline float cosine_pdf(struct vec3 wi)
{
    return f_max(wi.z, 0.0f) * (1.0f / PI);
}

static inline struct vec3 lambert_terms(const struct bsdf *m, struct vec3 wi,
                                        float *pdf)
{
    *pdf = cosine_pdf(wi);
    return v3_scale(m->color, *pdf);
}

static inline bool lambert_sample(const struct bsdf *m, struct vec2 u,
                                  struct bsdf_sample *s)
{
    s->wi = cosine_hemisphere(u);
    s->weight = m->color; /* f |cosine| / pdf without the division */
    s->pdf = cosine_pdf(s->wi);
    s->eta_scale = 1.0f;
    s->is_delta = false;
    return s->wi.z > COSINE_MIN;
}

/* c1 - g(mu), clamped at 0. The single-scattering albedo of EON is (1 + r
 * g(mu)) / (1 + c1 r), and 1 minus that is eon_gap() r / (1 + c1 r). The fit of
 * g is within 1e-3. */
static inline float eon_gap(float mu)
{
    float m = 1.0f - mu;
    float g =
        m * (0.0571085289f +
             m * (0.491881867f + m * (-0.332181442f + m * 0.0714429953f)));

    return f_max(EON_C1 - g, 0.0f);
}

static inline struct vec3 eon_terms(const struct bsdf *m, struct vec3 wo,
                                    struct vec3 wi, float *pdf)
{
    float r = m->alpha;
    float a = 1.0f / (1.0f + EON_C1 * r);
    float s = v3_dot(wo, wi) - wo.z * wi.z;
    float t = s > 0.0f ? f_max(wi.z, wo.z) : 1.0f;
    float single = a * (1.0f + r * s / t);
    /* (1 - E_o) (1 - E_i) / (1 - E_mean), without the subtractions */
    float multiple = a * r * eon_gap(wo.z) * eon_gap(wi.z) / (EON_C1 - EON_C2);
    float mean = a * (1.0f + EON_C2 * r);
    struct vec3 rho = m->color;
    struct vec3 echo = v3(rho.x * mean / (1.0f - rho.x * (1.0f - mean)),
                          rho.y * mean / (1.0f - rho.y * (1.0f - mean)),
                          rho.z * mean / (1.0f - rho.z * (1.0f - mean)));

    *pdf = cosine_pdf(wi);
    return v3_mul(v3_scale(rho, *pdf),
                  v3_add(v3(single, single, single), v3_scale(echo, multiple)));
}

static inline bool eon_sample(const struct bsdf *m, struct vec3 wo,
                              struct vec2 u, struct bsdf_sample *s)
{
    struct vec3 wi = cosine_hemisphere(u);
    float pdf;
    struct vec3 f = eon_terms(m, wo, wi, &pdf);

    return wi.z > COSINE_MIN && sample_density(s, wi, f, pdf);
}

#endif
