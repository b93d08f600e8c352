// SPDX-License-Identifier: MIT
/*
 * bsdf.h - how surfaces scatter: diffuse, GGX metal, glass
 *
 * GGX with height-correlated masking (Heitz 2014), visible normals by
 * spherical caps (Dupuy and Benyoub 2023), bounded for reflection (Eto and
 * Tokuyoshi 2023); rough glass after Walter et al. 2007; exact Fresnel for
 * glass, Schlick's for metals.
 *
 * Units:     local frame, z along the shading normal on the eye's side; wo to
 *            the eye, wi to the light
 * Ownership: none
 * Threads:   none
 * Errors:    a sample without light is refused by the result
 */
#ifndef KERNELS_BSDF_H
#define KERNELS_BSDF_H

#include "kernels/sample.h"

/* A material where it was hit. */
struct bsdf {
    struct vec3 color;
    float alpha;
    float eta; /* index on the far side over the one on the eye's side */
    uint32_t kind;
};

struct bsdf_sample {
    struct vec3 wi;
    struct vec3 weight; /* f cosine / pdf, without eta_scale */
    float eta_scale;    /* radiance scaling 1/eta^2 of a crossing, else 1 */
};

static inline float schlick_weight(float cosine)
{
    float c = f_max(1.0f - cosine, 0.0f);
    float c2 = c * c;

    return c2 * c2 * c;
}

static inline struct vec3 fresnel_schlick(struct vec3 f0, float cosine)
{
    float s = schlick_weight(cosine);

    return v3(f0.x + (1.0f - f0.x) * s, f0.y + (1.0f - f0.y) * s,
              f0.z + (1.0f - f0.z) * s);
}

/* Unpolarised reflectance of a dielectric face; *cos_t is the cosine of the
 * refracted ray, 0 when all is reflected. */
static inline float fresnel_dielectric(float c, float eta, float *cos_t)
{
    float s2 = f_max(1.0f - c * c, 0.0f) / (eta * eta);
    float rs, rp;

    *cos_t = 0.0f;
    if (s2 >= 1.0f)
        return 1.0f;
    *cos_t = sqrtf(1.0f - s2);
    rs = (c - eta * *cos_t) / (c + eta * *cos_t);
    rp = (eta * c - *cos_t) / (eta * c + *cos_t);
    return f_min(0.5f * (rs * rs + rp * rp), 1.0f);
}

/* A microfacet normal seen from wo. bound is 1 for all that wo sees; less
 * keeps reflections above the surface. */
static inline struct vec3 ggx_visible_normal(struct vec3 wo, float alpha,
                                             float bound, struct vec2 u)
{
    struct vec3 s = v3_unit(v3(alpha * wo.x, alpha * wo.y, wo.z));
    float b = bound * s.z;
    float z = (1.0f - u.y) * (1.0f + b) - b;
    float r = sqrtf(f_max(1.0f - z * z, 0.0f));
    struct vec2 turn = cos_sin_turns(u.x);
    struct vec3 c = v3(r * turn.x + s.x, r * turn.y + s.y, z + s.z);
    struct vec3 h = v3(alpha * c.x, alpha * c.y, f_max(c.z, 0.0f));
    float length = v3_length(h);

    if (!(length > 0.0f))
        return v3(0.0f, 0.0f, 1.0f);
    return v3_scale(h, 1.0f / length);
}

/* sqrt(alpha^2 + (1 - alpha^2) mu^2), of Smith's Lambda without division. */
static inline float ggx_root(float alpha, float mu)
{
    float a2 = alpha * alpha;

    return sqrtf(a2 + (1.0f - a2) * mu * mu);
}

static inline bool metal_sample(const struct bsdf *m, struct vec3 wo,
                                struct vec2 u, struct bsdf_sample *s)
{
    float a2 = m->alpha * m->alpha;
    float reach, k, t_o, t_i, o_dot_h;
    struct vec3 h;

    s->eta_scale = 1.0f;
    if (!HAS(FEATURE_ROUGH) || m->alpha < ALPHA_SMOOTH) {
        s->wi = v3(-wo.x, -wo.y, wo.z);
        s->weight = fresnel_schlick(m->color, wo.z);
        return true;
    }
    reach = 1.0f + sqrtf(wo.x * wo.x + wo.y * wo.y);
    k = (1.0f - a2) * reach * reach / (reach * reach + a2 * wo.z * wo.z);
    h = ggx_visible_normal(wo, m->alpha, k, u);
    o_dot_h = v3_dot(wo, h);
    s->wi = v3_sub(v3_scale(h, 2.0f * o_dot_h), wo);
    if (!(s->wi.z > 0.0f))
        return false;
    t_o = ggx_root(m->alpha, wo.z);
    t_i = ggx_root(m->alpha, s->wi.z);
    s->weight =
        v3_scale(fresnel_schlick(m->color, o_dot_h),
                 s->wi.z * (k * wo.z + t_o) / (wo.z * t_i + s->wi.z * t_o));
    return true;
}

/* Reflection or refraction at a face with normal h, chosen by `choice`. */
static inline void glass_choose(const struct bsdf *m, struct vec3 wo,
                                struct vec3 h, float choice,
                                struct bsdf_sample *s)
{
    float c = v3_dot(wo, h);
    float cos_t;
    float f = fresnel_dielectric(c, m->eta, &cos_t);

    if (choice < f) {
        s->wi = v3_sub(v3_scale(h, 2.0f * c), wo);
        s->weight = v3(1.0f, 1.0f, 1.0f);
        s->eta_scale = 1.0f;
        return;
    }
    s->wi =
        v3_sub(v3_scale(h, c / m->eta - cos_t), v3_scale(wo, 1.0f / m->eta));
    s->weight = m->color;
    s->eta_scale = 1.0f / (m->eta * m->eta);
}

static inline bool glass_sample(const struct bsdf *m, struct vec3 wo,
                                struct vec2 u, float choice,
                                struct bsdf_sample *s)
{
    struct vec3 h = v3(0.0f, 0.0f, 1.0f);
    float mu_i, t_o, t_i;

    if (fabsf(m->eta - 1.0f) < 1e-3f) { /* wo + eta wi would cancel */
        s->wi = v3_neg(wo);
        s->weight = m->color;
        s->eta_scale = 1.0f;
        return true;
    }
    if (!HAS(FEATURE_ROUGH) || m->alpha < ALPHA_SMOOTH) {
        glass_choose(m, wo, h, choice, s);
        return true;
    }
    h = ggx_visible_normal(wo, m->alpha, 1.0f, u);
    if (!(v3_dot(wo, h) > 0.0f))
        return false;
    glass_choose(m, wo, h, choice, s);
    /* a reflection must end above the surface, a refraction below */
    if ((v3_dot(s->wi, h) > 0.0f) != (s->wi.z > 0.0f))
        return false;
    /* weight G2/G1, with both Lambdas over a common denominator */
    mu_i = fabsf(s->wi.z);
    t_o = ggx_root(m->alpha, wo.z);
    t_i = ggx_root(m->alpha, mu_i);
    s->weight =
        v3_scale(s->weight, mu_i * (wo.z + t_o) / (wo.z * t_i + mu_i * t_o));
    return true;
}

/* A sheet of no thickness: all reflections between its faces added up. */
static inline void thin_glass_sample(const struct bsdf *m, struct vec3 wo,
                                     float choice, struct bsdf_sample *s)
{
    float cos_t;
    float f = fresnel_dielectric(wo.z, m->eta, &cos_t);

    s->eta_scale = 1.0f;
    if (choice * (1.0f + f) < 2.0f * f) {
        s->wi = v3(-wo.x, -wo.y, wo.z);
        s->weight = v3(1.0f, 1.0f, 1.0f);
        return;
    }
    s->wi = v3_neg(wo);
    s->weight = m->color;
}

/* Draws wi; false if the light ends here. `choice` is for the lobe. */
static inline bool bsdf_sample(const struct bsdf *m, struct vec3 wo,
                               struct vec2 u, float choice,
                               struct bsdf_sample *s)
{
    if (m->kind == MATERIAL_DIFFUSE) {
        s->wi = cosine_hemisphere(u);
        s->weight = m->color;
        s->eta_scale = 1.0f;
        return s->wi.z > 0.0f;
    }
    if (HAS(FEATURE_METAL) && m->kind == MATERIAL_METAL)
        return metal_sample(m, wo, u, s);
    if (!HAS(FEATURE_GLASS))
        return false;
    if (m->kind == MATERIAL_GLASS)
        return glass_sample(m, wo, u, choice, s);
    thin_glass_sample(m, wo, choice, s);
    return true;
}

#endif
