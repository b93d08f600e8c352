// SPDX-License-Identifier: MIT
/*
 * diffuse.h - smooth and rough diffuse surfaces, opaque and translucent
 *
 * Lambert's law, and the energy-preserving Oren-Nayar model (EON) of
 * Portsmouth, Kutz and Hill 2024, whose roughness is `alpha`. Directions are
 * drawn by the cosine in both.
 *
 * A translucent base, such as paper, is a mixture: with the weight
 * `translucency` it transmits by Lambert's law with the albedo back_color, and
 * otherwise it reflects as an opaque base does.
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

/* ---- the base: reflection and transmission ---- */

static inline bool is_translucent(const struct bsdf *m)
{
    return HAS(FEATURE_TRANSLUCENT) && m->translucency > 0.0f;
}

/* True if wi is below a translucent base, which transmits its light. */
static inline bool is_behind(const struct bsdf *m, struct vec3 wi)
{
    return is_translucent(m) && wi.z < 0.0f;
}

/* Mirrors wi to above a translucent base. */
static inline struct vec3 base_side(const struct bsdf *m, struct vec3 wi)
{
    return is_translucent(m) ? v3_above(wi) : wi;
}

/* Albedo of reflection. */
static inline struct vec3 base_front(const struct bsdf *m)
{
    return is_translucent(m) ? v3_scale(m->color, 1.0f - m->translucency)
                             : m->color;
}

/* Albedo of transmission by a translucent base. */
static inline struct vec3 base_back(const struct bsdf *m)
{
    return v3_scale(m->back_color, m->translucency);
}

/* Albedo of both. */
static inline struct vec3 base_albedo(const struct bsdf *m)
{
    return is_translucent(m) ? v3_add(base_front(m), base_back(m)) : m->color;
}

/* Albedo of the part that sends light from wi to the eye. */
static inline struct vec3 base_part(const struct bsdf *m, struct vec3 wi)
{
    return is_behind(m, wi) ? base_back(m) : base_front(m);
}

/* Lambert's f |cosine| of albedo 1. */
static inline float base_cosine(const struct bsdf *m, struct vec3 wi)
{
    return cosine_pdf(base_side(m, wi));
}

/* Least share of the light by which the transmission is sampled, so that no
 * quotient of densities overflows. Below, only light samples find it. */
#define CROSSING_MIN 1e-6f

/* Probability that base_direction() samples the transmission. */
static inline float base_crossing(const struct bsdf *m)
{
    float front = v3_max_component(base_front(m));
    float back = v3_max_component(base_back(m));

    return back > CROSSING_MIN * (front + back) ? back / (front + back) : 0.0f;
}

/* Probability that base_direction() samples the part of wi. */
static inline float base_chance(const struct bsdf *m, struct vec3 wi)
{
    if (!is_translucent(m))
        return 1.0f;
    return is_behind(m, wi) ? base_crossing(m) : 1.0f - base_crossing(m);
}

/* Density of base_direction(). */
static inline float base_pdf(const struct bsdf *m, struct vec3 wi)
{
    return base_cosine(m, wi) * base_chance(m, wi);
}

/* Samples a direction by the cosine. Returns false if it is rejected. */
static inline bool base_direction(const struct bsdf *m, struct vec2 u,
                                  float choice, struct vec3 *wi)
{
    bool is_high;

    *wi = cosine_hemisphere(u);
    is_high = wi->z > COSINE_MIN;
    if (is_translucent(m) && choice < base_crossing(m))
        wi->z = -wi->z;
    return is_high;
}

/* ---- Lambert's law ---- */

static inline struct vec3 lambert_terms(const struct bsdf *m, struct vec3 wi,
                                        float *pdf)
{
    *pdf = base_pdf(m, wi);
    return v3_scale(base_part(m, wi), base_cosine(m, wi));
}

static inline bool lambert_sample(const struct bsdf *m, struct vec2 u,
                                  float choice, struct bsdf_sample *s)
{
    bool is_high = base_direction(m, u, choice, &s->wi);

    /* f |cosine| / pdf without the cosine */
    s->weight = v3_scale(base_part(m, s->wi), 1.0f / base_chance(m, s->wi));
    s->pdf = base_pdf(m, s->wi);
    s->eta_scale = 1.0f;
    s->is_delta = false;
    return is_high;
}

/* ---- EON ---- */

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
    float r = m->alpha, cosine = base_cosine(m, wi);
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

    if (is_behind(m, wi))
        return lambert_terms(m, wi, pdf);
    *pdf = base_pdf(m, wi);
    if (is_translucent(m))
        cosine *= 1.0f - m->translucency;
    if (HAS(FEATURE_SUBSURFACE))
        cosine *= 1.0f + f_min(m->subsurface, 0.0f);
    return v3_mul(v3_scale(rho, cosine),
                  v3_add(v3(single, single, single), v3_scale(echo, multiple)));
}

static inline bool eon_sample(const struct bsdf *m, struct vec3 wo,
                              struct vec2 u, float choice,
                              struct bsdf_sample *s)
{
    struct vec3 wi, f;
    float pdf;

    if (!base_direction(m, u, choice, &wi))
        return false;
    f = eon_terms(m, wo, wi, &pdf);
    return sample_density(s, wi, f, pdf);
}

#endif
