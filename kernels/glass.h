// SPDX-License-Identifier: MIT
/*
 * glass.h - solid glass, smooth and rough
 *
 * Exact Fresnel; rough faces after Walter et al. 2007 with visible normals,
 * scaled so that single scattering keeps all light (Turquin 2019, for
 * reflection and transmission together). That conserves energy, but is not
 * reciprocal.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine| and without
 *            the 1/eta^2 of a transmission
 */
#ifndef KERNELS_GLASS_H
#define KERNELS_GLASS_H

#include "kernels/bsdf_types.h"
#include "kernels/energy.h"
#include "kernels/fresnel.h"
#include "kernels/ggx.h"
#include "kernels/thin_film.h"

/* An index closer to 1 counts as matched: the half vector wo + eta wi would
 * cancel. */
#define ETA_MATCHED 1e-3f

/* Least albedo by which samples are scaled. Below, seen from inside glass
 * hardly denser than its surroundings, light stays lost, as single samples
 * would grow without bound. */
#define GLASS_ALBEDO_MIN 0.05f

static inline bool glass_is_index_matched(const struct bsdf *m)
{
    return fabsf(m->eta - 1.0f) < ETA_MATCHED;
}

/* Albedo of rough glass under any film: that of reflection or of transmission
 * alone, whichever is more. With it samples are scaled to at most all light,
 * and rough white glass with a film loses up to 4 %. */
static inline float glass_film_albedo(const struct bsdf *m, struct vec3 wo)
{
    float cos_t;
    float f = fresnel_dielectric(wo.z, m->eta, &cos_t);
    float reflected = 1.0f - ggx_albedo(wo.z, m->alpha).loss;
    float both = glass_albedo(wo.z, m->alpha, m->eta);
    float passed = f < 1.0f ? (both - f * reflected) / (1.0f - f) : reflected;

    return f_min(f_max(f_max(reflected, passed), both), 1.0f);
}

/* f |cosine| and the density of rough faces. */
static inline struct vec3 glass_terms(const struct bsdf *m, struct vec3 wo,
                                      struct vec3 wi, float *pdf)
{
    bool is_crossing = wi.z < 0.0f;
    struct vec3 h = half_vector(wo, is_crossing ? v3_scale(wi, m->eta) : wi);
    float mu_i = fabsf(wi.z);
    struct ggx g = {m->alpha, 1.0f};
    float t_o = ggx_root(wo, g);
    float t_i = ggx_root(wi, g);
    struct vec3 tint = is_crossing ? m->color : v3(1.0f, 1.0f, 1.0f);
    float o_dot_h, i_dot_h, cos_t, part, jacobian, gain;

    *pdf = 0.0f;
    if (h.z < 0.0f)
        h = v3_neg(h);
    o_dot_h = v3_dot(wo, h);
    i_dot_h = v3_dot(wi, h);
    if (!(o_dot_h > 0.0f) || (i_dot_h < 0.0f) != is_crossing)
        return v3(0.0f, 0.0f, 0.0f);
    if (is_crossing) {
        float d = i_dot_h + o_dot_h / m->eta;

        part = 1.0f - fresnel_cosines(o_dot_h, -i_dot_h, m->eta);
        jacobian = -i_dot_h / (d * d);
    } else {
        part = fresnel_dielectric(o_dot_h, m->eta, &cos_t);
        jacobian = 0.25f / o_dot_h;
    }
    if (has_film(m))
        tint =
            v3_mul(tint, film_tint(film_glass(m, o_dot_h, is_crossing), &part));
    *pdf = part * jacobian * 2.0f * o_dot_h * ggx_density(h, g) / (wo.z + t_o);
    /* G2 / G1, over a common denominator */
    gain = mu_i * (wo.z + t_o) / (wo.z * t_i + mu_i * t_o);
    gain /= f_max(has_film(m) ? glass_film_albedo(m, wo)
                              : glass_albedo(wo.z, m->alpha, m->eta),
                  GLASS_ALBEDO_MIN);
    return v3_scale(tint, *pdf * gain);
}

/* Factor of radiance that comes from wi: 1/eta^2 for transmission. */
static inline float glass_eta_scale(const struct bsdf *m, struct vec3 wi)
{
    return wi.z < 0.0f && !glass_is_index_matched(m) ? 1.0f / (m->eta * m->eta)
                                                     : 1.0f;
}

/* Chooses reflection or refraction at a face with normal h. */
static inline struct vec3 glass_reflect_or_refract(const struct bsdf *m,
                                                   struct vec3 wo,
                                                   struct vec3 h, float choice)
{
    float c = v3_dot(wo, h);
    float cos_t;
    float f = fresnel_dielectric(c, m->eta, &cos_t);

    if (has_film(m))
        f = mean_channel(film_glass(m, c, false));
    if (choice < f)
        return reflect_at(wo, h);
    /* unit length up to rounding, which is large at extreme indices */
    return v3_unit(v3_sub(v3_scale(v3_sub(v3_scale(h, c), wo), 1.0f / m->eta),
                          v3_scale(h, cos_t)));
}

static inline bool glass_sample_smooth(const struct bsdf *m, struct vec3 wo,
                                       float choice, struct bsdf_sample *s)
{
    struct vec3 wi = v3_neg(wo);
    float mean;

    if (!glass_is_index_matched(m))
        wi = glass_reflect_or_refract(m, wo, v3(0.0f, 0.0f, 1.0f), choice);
    sample_delta(s, wi, wi.z < 0.0f ? m->color : v3(1.0f, 1.0f, 1.0f));
    if (has_film(m) && !glass_is_index_matched(m))
        s->weight = v3_mul(s->weight,
                           film_tint(film_glass(m, wo.z, wi.z < 0.0f), &mean));
    s->eta_scale = glass_eta_scale(m, wi);
    return true;
}

/* Samples a direction; only those of smooth faces get their weights. */
static inline bool glass_direction(const struct bsdf *m, struct vec3 wo,
                                   struct vec2 u, float choice,
                                   struct bsdf_sample *s)
{
    struct ggx g = {m->alpha, 1.0f};
    struct vec3 h, wi;

    if (is_smooth(m) || glass_is_index_matched(m))
        return glass_sample_smooth(m, wo, choice, s);
    h = ggx_visible_normal(wo, g, 1.0f, u);
    if (!(v3_dot(wo, h) > 0.0f))
        return false;
    wi = glass_reflect_or_refract(m, wo, h, choice);
    /* reflections end above the surface, refractions below */
    if ((v3_dot(wi, h) > 0.0f) != (wi.z > 0.0f) || !(fabsf(wi.z) > COSINE_MIN))
        return false;
    return sample_direction(s, wi, glass_eta_scale(m, wi));
}

static inline bool glass_sample(const struct bsdf *m, struct vec3 wo,
                                struct vec2 u, float choice,
                                struct bsdf_sample *s)
{
    struct vec3 f;
    float pdf;

    if (!glass_direction(m, wo, u, choice, s))
        return false;
    if (s->is_delta)
        return true;
    f = glass_terms(m, wo, s->wi, &pdf);
    if (!sample_density(s, s->wi, f, pdf))
        return false;
    s->eta_scale = glass_eta_scale(m, s->wi);
    return true;
}

#endif
