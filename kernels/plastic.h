// SPDX-License-Identifier: MIT
/*
 * plastic.h - a clear GGX surface over a diffuse base
 *
 * The base is scaled by what the surface does not reflect on the way in and
 * out, (1 - E(mu_o)) (1 - E(mu_i)) / (1 - E_mean), with E the albedo of the
 * surface itself (Kelemen and Szirmay-Kalos 2001). So a white base reflects all
 * light under any surface, and the BSDF is reciprocal. The surface is on both
 * sides of a translucent base, and light that is transmitted is scaled
 * likewise.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine|
 */
#ifndef KERNELS_PLASTIC_H
#define KERNELS_PLASTIC_H

#include "kernels/diffuse.h"
#include "kernels/metal.h"

/* Reflectance at grazing incidence, F90. It falls with that at normal incidence
 * below 0.02, as no dielectric reflects less (Lagarde and de Rousiers 2014,
 * "Moving Frostbite to physically based rendering", 3.1). */
static inline float specular_grazing(struct vec3 f0)
{
    return f_min(50.0f * f_max(f0.x, f_max(f0.y, f0.z)), 1.0f);
}

/* Fresnel of the surface, F0 + (F90 - F0) weight, where `weight` is
 * schlick_weight() or its mean. */
static inline struct vec3 specular_fresnel(struct vec3 f0, float weight)
{
    float f90 = specular_grazing(f0);

    return v3_lerp(f0, v3(f90, f90, f90), weight);
}

/* Albedo of the surface, from the two parts of it: F0 (E - S) + F90 S. */
static inline struct vec3 specular_albedo_of(struct vec3 f0,
                                             struct ggx_albedo e)
{
    float part = 1.0f - e.loss - e.schlick;
    float grazing = specular_grazing(f0) * e.schlick;

    return v3(f0.x * part + grazing, f0.y * part + grazing,
              f0.z * part + grazing);
}

/* e: bsdf_albedo() in direction w. */
static inline struct vec3 specular_albedo(const struct bsdf *m, struct vec3 w,
                                          struct ggx_albedo e)
{
    if (is_smooth(m))
        return specular_fresnel(m->specular, schlick_weight(w.z));
    return specular_albedo_of(m->specular, e);
}

/* e: the mean of bsdf_albedo(). */
static inline struct vec3 specular_albedo_mean(const struct bsdf *m,
                                               struct ggx_albedo e)
{
    if (is_smooth(m))
        return specular_fresnel(m->specular, SCHLICK_MEAN);
    return specular_albedo_of(m->specular, e);
}

/* (1 - o) (1 - i) / (1 - mean), or 0 under a surface that reflects all light.
 */
static inline float base_scale(float o, float i, float mean)
{
    return mean < 1.0f ? (1.0f - o) * (1.0f - i) / (1.0f - mean) : 0.0f;
}

/* Probability to sample the surface: its share of the light, summed over the
 * channels. specular_o: specular_albedo() at wo. */
static inline float specular_probability(const struct bsdf *m,
                                         struct vec3 specular_o)
{
    float specular = specular_o.x + specular_o.y + specular_o.z;
    struct vec3 albedo = base_albedo(m);
    float base = albedo.x * (1.0f - specular_o.x) +
                 albedo.y * (1.0f - specular_o.y) +
                 albedo.z * (1.0f - specular_o.z);

    return specular + base > 0.0f ? specular / (specular + base) : 1.0f;
}

/* e: bsdf_albedos(). */
static inline struct vec3 plastic_terms(const struct bsdf *m, struct vec3 wo,
                                        struct vec3 wi,
                                        const struct facet_albedos *e,
                                        float *pdf)
{
    struct vec3 specular_o = specular_albedo(m, wo, e->o);
    struct vec3 specular_i = specular_albedo(m, base_side(m, wi), e->i);
    struct vec3 mean = specular_albedo_mean(m, e->mean);
    float chance = specular_probability(m, specular_o);
    struct vec3 share = v3(base_scale(specular_o.x, specular_i.x, mean.x),
                           base_scale(specular_o.y, specular_i.y, mean.y),
                           base_scale(specular_o.z, specular_i.z, mean.z));
    struct vec3 f =
        v3_scale(v3_mul(base_part(m, wi), share), base_cosine(m, wi));
    struct vec3 h;

    *pdf = (1.0f - chance) * base_pdf(m, wi);
    if (is_smooth(m) || is_behind(m, wi))
        return f;
    h = half_vector(wo, wi);
    *pdf += chance * ggx_reflection_pdf(wo, h, bsdf_facets(m));
    return v3_add(f, v3_scale(specular_fresnel(m->specular,
                                               schlick_weight(v3_dot(wo, h))),
                              ggx_reflection(wo, wi, h, bsdf_facets(m))));
}

/* Samples a direction; only that of a mirror gets its weight. o: bsdf_albedo()
 * at wo. */
static inline bool plastic_direction(const struct bsdf *m, struct vec3 wo,
                                     struct ggx_albedo o, struct vec2 u,
                                     float choice, struct bsdf_sample *s)
{
    struct vec3 specular_o = specular_albedo(m, wo, o);
    float chance = specular_probability(m, specular_o);
    struct vec3 wi;

    if (!(choice < chance))
        return base_direction(m, u, (choice - chance) / (1.0f - chance), &wi) &&
               sample_direction(s, wi, 1.0f);
    if (is_smooth(m))
        return sample_delta(s, v3(-wo.x, -wo.y, wo.z),
                            v3_scale(specular_o, 1.0f / chance));
    wi = ggx_reflect(wo, bsdf_facets(m), u);
    return wi.z > COSINE_MIN && sample_direction(s, wi, 1.0f);
}

static inline bool plastic_sample(const struct bsdf *m, struct vec3 wo,
                                  struct vec2 u, float choice,
                                  struct bsdf_sample *s)
{
    struct ggx_albedo o = bsdf_albedo(m, wo);
    struct facet_albedos e;
    struct vec3 f;
    float pdf;

    if (!plastic_direction(m, wo, o, u, choice, s))
        return false;
    if (s->is_delta)
        return true;
    e = bsdf_albedos(m, o, base_side(m, s->wi));
    f = plastic_terms(m, wo, s->wi, &e, &pdf);
    return sample_density(s, s->wi, f, pdf);
}

#endif
