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

/* f |cosine| of the multiscatter lobe of white facets. loss_o: the loss of
 * single scattering at wo. */
static inline float multiscatter_f(struct vec3 wi, float loss_o, struct ggx g)
{
    return loss_o * facets_albedo(wi, g).loss / facets_albedo_mean(g).loss *
           wi.z * (1.0f / PI);
}

/* Returns the light that single scattering loses, which is also the probability
 * to sample the multiscatter lobe. */
static inline float metal_loss(const struct bsdf *m, struct vec3 wo)
{
    return facets_albedo(wo, bsdf_facets(m)).loss;
}

/* loss_o: metal_loss() at wo. */
static inline struct vec3 metal_terms(const struct bsdf *m, struct vec3 wo,
                                      struct vec3 wi, float loss_o, float *pdf)
{
    struct vec3 h = half_vector(wo, wi);
    struct ggx g = bsdf_facets(m);
    float loss_mean = facets_albedo_mean(g).loss;
    struct vec3 f = fresnel_schlick_mean(m->color);
    struct vec3 single = v3_scale(fresnel_schlick(m->color, v3_dot(wo, h)),
                                  ggx_reflection(wo, wi, h, g));
    struct vec3 multiple = v3_scale(v3(multiscatter_color(f.x, loss_mean),
                                       multiscatter_color(f.y, loss_mean),
                                       multiscatter_color(f.z, loss_mean)),
                                    multiscatter_f(wi, loss_o, g));

    *pdf = (1.0f - loss_o) * ggx_reflection_pdf(wo, h, g) +
           loss_o * multiscatter_pdf(wi, m->alpha);
    return v3_add(single, multiple);
}

static inline bool metal_sample(const struct bsdf *m, struct vec3 wo,
                                struct vec2 u, float choice,
                                struct bsdf_sample *s)
{
    struct vec3 wi, f;
    float loss_o, pdf;

    if (is_smooth(m))
        return sample_delta(s, v3(-wo.x, -wo.y, wo.z),
                            fresnel_schlick(m->color, wo.z));
    loss_o = metal_loss(m, wo);
    wi = choice < loss_o ? multiscatter_direction(m->alpha, u)
                         : ggx_reflect(wo, bsdf_facets(m), u);
    if (!(wi.z > COSINE_MIN))
        return false;
    f = metal_terms(m, wo, wi, loss_o, &pdf);
    return sample_density(s, wi, f, pdf);
}

#endif
