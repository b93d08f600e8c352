// SPDX-License-Identifier: MIT
/*
 * thin_glass.h - sheets of glass without thickness, smooth and rough
 *
 * All reflections between the two faces are summed: R = 2 F / (1 + F). Light is
 * not refracted, so that the transmitted lobe of a rough sheet is the mirror
 * image of its reflected lobe below the surface. Light that single scattering
 * loses is reflected and transmitted by lobes after Kulla and Conty 2017, in
 * the proportion of the mean R. Reciprocal; a white sheet keeps all light. A
 * thin film is on both faces; a sheet of index 1 is a film alone, like a soap
 * bubble.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine|
 */
#ifndef KERNELS_THIN_GLASS_H
#define KERNELS_THIN_GLASS_H

#include "kernels/glass.h"
#include "kernels/metal.h"

/* Reflectance of a sheet whose faces reflect f. */
static inline float thin_reflectance(float f)
{
    return 2.0f * f / (1.0f + f);
}

/* The same at the hemispherical mean of Fresnel's f, by the fits of Kulla and
 * Conty 2017. */
static inline float thin_reflectance_mean(float eta)
{
    float f =
        eta < 1.0f
            ? 0.997118f + eta * (0.1014f - eta * (0.965241f + 0.130607f * eta))
            : (eta - 1.0f) / (4.08567f + 1.00071f * eta);

    return thin_reflectance(f_min(f_max(f, 0.0f), 1.0f));
}

static inline float thin_facet_reflectance(const struct bsdf *m, struct vec3 wo,
                                           struct vec3 h)
{
    float cos_t;

    return thin_reflectance(fresnel_dielectric(v3_dot(wo, h), m->eta, &cos_t));
}

/* e: bsdf_albedos() for wi above the surface. */
/* Returns what a sheet with a film reflects at cosine c, or what it transmits
 * if is_crossing. */
static inline struct vec3 thin_film(const struct bsdf *m, float c,
                                    bool is_crossing)
{
    struct vec3 r = film_glass(m, c, false);

    if (!glass_is_index_matched(m))
        r = v3(thin_reflectance(r.x), thin_reflectance(r.y),
               thin_reflectance(r.z));
    return is_crossing ? v3(1.0f - r.x, 1.0f - r.y, 1.0f - r.z) : r;
}

static inline struct vec3 thin_terms(const struct bsdf *m, struct vec3 wo,
                                     struct vec3 wi,
                                     const struct facet_albedos *e, float *pdf)
{
    struct ggx g = bsdf_facets(m);
    struct vec3 up = v3_above(wi);
    struct vec3 h = half_vector(wo, up);
    float loss_o = e->o.loss;
    float single = thin_facet_reflectance(m, wo, h);
    float multiple = thin_reflectance_mean(m->eta);
    struct vec3 tint = v3(1.0f, 1.0f, 1.0f);
    struct vec3 film = tint;

    if (wi.z < 0.0f) {
        single = 1.0f - single;
        multiple = 1.0f - multiple;
        tint = m->color;
    }
    if (has_film(m))
        film = film_tint(thin_film(m, v3_dot(wo, h), wi.z < 0.0f), &single);
    *pdf = (1.0f - loss_o) * single * ggx_reflection_pdf(wo, h, g) +
           loss_o * multiple * multiscatter_pdf(up, m->alpha);
    if (has_film(m))
        return v3_add(v3_scale(v3_mul(tint, film),
                               single * ggx_reflection(wo, up, h, g)),
                      v3_scale(tint, multiple * multiscatter_f(up, e)));
    return v3_scale(tint, single * ggx_reflection(wo, up, h, g) +
                              multiple * multiscatter_f(up, e));
}

/* Chooses the side of a sheet that reflects r. Returns false if the sample is
 * rejected. */
static inline bool thin_choose_side(float r, float choice, struct vec3 *wi)
{
    if (!(wi->z > COSINE_MIN))
        return false;
    if (!(choice < r))
        wi->z = -wi->z;
    return true;
}

static inline bool thin_direction_rough(const struct bsdf *m, struct vec3 wo,
                                        struct ggx_albedo o, struct vec2 u,
                                        float choice, struct bsdf_sample *s)
{
    struct ggx g = bsdf_facets(m);
    struct vec3 wi;
    float r;

    if (choice < o.loss) {
        choice /= o.loss;
        wi = multiscatter_direction(m->alpha, u);
        r = thin_reflectance_mean(m->eta);
    } else {
        choice = (choice - o.loss) / (1.0f - o.loss);
        wi = ggx_reflect(wo, g, u);
        r = has_film(m)
                ? mean_channel(
                      thin_film(m, v3_dot(wo, half_vector(wo, wi)), false))
                : thin_facet_reflectance(m, wo, half_vector(wo, wi));
    }
    return thin_choose_side(r, choice, &wi) && sample_direction(s, wi, 1.0f);
}

/* Samples a smooth sheet with a film. */
static inline bool thin_direction_film(const struct bsdf *m, struct vec3 wo,
                                       float choice, struct bsdf_sample *s)
{
    bool is_crossing = !(choice < mean_channel(thin_film(m, wo.z, false)));
    float mean;
    struct vec3 tint = film_tint(thin_film(m, wo.z, is_crossing), &mean);

    if (is_crossing)
        return sample_delta(s, v3_neg(wo), v3_mul(tint, m->color));
    return sample_delta(s, v3(-wo.x, -wo.y, wo.z), tint);
}

/* Samples a direction; only those of smooth sheets get their weights. o:
 * bsdf_albedo() at wo. */
static inline bool thin_direction(const struct bsdf *m, struct vec3 wo,
                                  struct ggx_albedo o, struct vec2 u,
                                  float choice, struct bsdf_sample *s)
{
    float cos_t;
    float f;

    if (HAS(FEATURE_ROUGH_SHEETS) && !is_smooth(m))
        return thin_direction_rough(m, wo, o, u, choice, s);
    if (has_film(m))
        return thin_direction_film(m, wo, choice, s);
    f = fresnel_dielectric(wo.z, m->eta, &cos_t);
    if (choice * (1.0f + f) < 2.0f * f)
        return sample_delta(s, v3(-wo.x, -wo.y, wo.z), v3(1.0f, 1.0f, 1.0f));
    return sample_delta(s, v3_neg(wo), m->color);
}

static inline bool thin_sample(const struct bsdf *m, struct vec3 wo,
                               struct vec2 u, float choice,
                               struct bsdf_sample *s)
{
    struct ggx_albedo o = {0.0f, 0.0f};
    struct facet_albedos e;
    struct vec3 f;
    float pdf;

    if (HAS(FEATURE_ROUGH_SHEETS))
        o = bsdf_albedo(m, wo);
    if (!thin_direction(m, wo, o, u, choice, s))
        return false;
    if (s->is_delta)
        return true;
    e = bsdf_albedos(m, o, v3_above(s->wi));
    f = thin_terms(m, wo, s->wi, &e, &pdf);
    return sample_density(s, s->wi, f, pdf);
}

#endif
