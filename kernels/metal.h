// SPDX-License-Identifier: MIT
/*
 * metal.h - mirrors and rough metals that conserve energy
 *
 * GGX reflection with Schlick's Fresnel, and a lobe for multiple scattering
 * between facets after Kulla and Conty 2017, with the colour of Hill 2018.
 * Reciprocal; white metal reflects all light.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine|
 */
#ifndef KERNELS_METAL_H
#define KERNELS_METAL_H

#include "kernels/bsdf_types.h"
#include "kernels/energy_stretched.h"
#include "kernels/fresnel.h"

/* Share of the light lost by single scattering that multiple scattering
 * returns, for a channel. */
static inline float multiscatter_color(float f0_mean, float loss_mean)
{
    return f0_mean * f0_mean * (1.0f - loss_mean) /
           (1.0f - f0_mean * loss_mean);
}

/* Width of the multiscatter lobe. The lobe is (1 - E_i) mu_i, about 1 / mu_i
 * down to alpha. It is sampled by its cosine with density b (1 + b) / (mu_i +
 * b)^2, whose weights stay below 1 / b; those of cosine_hemisphere() reach 1 /
 * alpha^2. */
static inline float multiscatter_width(float alpha)
{
    return sqrtf(alpha);
}

static inline struct vec3 multiscatter_direction(float alpha, struct vec2 u)
{
    float b = multiscatter_width(alpha);

    return v3_around_z(b * u.y / (1.0f + b - u.y), u.x);
}

static inline float multiscatter_pdf(struct vec3 wi, float alpha)
{
    float b = multiscatter_width(alpha);

    return b * (1.0f + b) / ((wi.z + b) * (wi.z + b)) * (0.5f / PI);
}

/* f |cosine| of the multiscatter lobe of white facets. */
static inline float multiscatter_f(struct vec3 wi,
                                   const struct facet_albedos *e)
{
    return e->o.loss * e->i.loss / e->mean.loss * wi.z * (1.0f / PI);
}

/* Returns the albedos of the surface's facets in direction w. Smooth surfaces,
 * which lose nothing, do not use them. */
static inline struct ggx_albedo bsdf_albedo(const struct bsdf *m, struct vec3 w)
{
    struct ggx_albedo none = {0.0f, 0.0f};

    return is_smooth(m) ? none : facets_albedo(w, bsdf_facets(m));
}

/* Returns the albedos of the facets at wo, which are o, and at wi. */
static inline struct facet_albedos
bsdf_albedos(const struct bsdf *m, struct ggx_albedo o, struct vec3 wi)
{
    struct facet_albedos none = {{0.0f, 0.0f}, {0.0f, 0.0f}, {0.0f, 0.0f}};

    return is_smooth(m) ? none : facet_albedos_at(o, wi, bsdf_facets(m));
}

/* color: reflectance at normal incidence; e: bsdf_albedos(). The loss at wo is
 * also the probability to sample the multiscatter lobe. */
static inline struct vec3 metal_terms(const struct bsdf *m, struct vec3 color,
                                      struct vec3 wo, struct vec3 wi,
                                      const struct facet_albedos *e, float *pdf)
{
    struct vec3 h = half_vector(wo, wi);
    struct ggx g = bsdf_facets(m);
    float loss_o = e->o.loss;
    float loss_mean = e->mean.loss;
    struct vec3 f = fresnel_schlick_mean(color);
    struct vec3 single = v3_scale(fresnel_schlick(color, v3_dot(wo, h)),
                                  ggx_reflection(wo, wi, h, g));
    struct vec3 multiple = v3_scale(v3(multiscatter_color(f.x, loss_mean),
                                       multiscatter_color(f.y, loss_mean),
                                       multiscatter_color(f.z, loss_mean)),
                                    multiscatter_f(wi, e));

    *pdf = (1.0f - loss_o) * ggx_reflection_pdf(wo, h, g) +
           loss_o * multiscatter_pdf(wi, m->alpha);
    return v3_add(single, multiple);
}

/* Samples a direction; only that of a mirror gets its weight. is_multiple: from
 * the multiscatter lobe, with the probability of the loss at wo. */
static inline bool metal_direction(const struct bsdf *m, struct vec3 color,
                                   struct vec3 wo, struct vec2 u,
                                   bool is_multiple, struct bsdf_sample *s)
{
    struct vec3 wi;

    if (is_smooth(m))
        return sample_delta(s, v3(-wo.x, -wo.y, wo.z),
                            fresnel_schlick(color, wo.z));
    wi = is_multiple ? multiscatter_direction(m->alpha, u)
                     : ggx_reflect(wo, bsdf_facets(m), u);
    return wi.z > COSINE_MIN && sample_direction(s, wi, 1.0f);
}

static inline bool metal_sample(const struct bsdf *m, struct vec3 wo,
                                struct vec2 u, float choice,
                                struct bsdf_sample *s)
{
    struct ggx_albedo o = bsdf_albedo(m, wo);
    struct facet_albedos e;
    struct vec3 f;
    float pdf;

    if (!metal_direction(m, m->color, wo, u, choice < o.loss, s))
        return false;
    if (s->is_delta)
        return true;
    e = bsdf_albedos(m, o, s->wi);
    f = metal_terms(m, m->color, wo, s->wi, &e, &pdf);
    return sample_density(s, s->wi, f, pdf);
}

#endif
