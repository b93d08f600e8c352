// SPDX-License-Identifier: MIT
/*
 * principled.h - mixtures of metal, plastic and glass under a coat and sheen
 *
 * The base is metal by its metalness; the rest is glass by its transmission,
 * and plastic otherwise. Solid glass is tinted by the root of the colour at
 * each crossing, so that a pane has the colour, as a thin sheet has. A coat of
 * refractive index 1.5 lies over the base, with a normal of its own if bumps or
 * maps give it one, and sheen over both. What a layer reflects, E(wo), those
 * below lose: they are scaled by 1 - E(wo), as in the surfaces of other
 * renderers (Georgiev et al. 2019, "Autodesk Standard Surface"). A thin film
 * between base and coat changes the colours of metal and of plastic's face to
 * those with its reflectance seen from wo. All of this conserves energy, but is
 * not reciprocal. Light that the diffuse base transmits into a solid changes
 * its radiance as that through glass does.
 *
 * Units:     local frame of bsdf_types.h; f comes times |cosine|
 */
#ifndef KERNELS_PRINCIPLED_H
#define KERNELS_PRINCIPLED_H

#include "kernels/glass.h"
#include "kernels/plastic.h"
#include "kernels/sheen.h"
#include "kernels/thin_film.h"
#include "kernels/thin_glass.h"

/* Reflectance of the coat at normal incidence. */
#define COAT_F0 0.04f

enum lobe {
    LOBE_SHEEN,
    LOBE_COAT,
    LOBE_METAL,
    LOBE_PLASTIC,
    LOBE_GLASS,
    LOBES
};

/* The lobes of a mixture, as seen from wo. */
struct lobes {
    struct ggx_albedo facets; /* of the base: bsdf_albedo() */
    struct vec3 metal;        /* its colour at normal incidence */
    float weight[LOBES];      /* factors of their f */
    float chance[LOBES]; /* probabilities to sample them; all are 0 if black */
    /* of principled_choose(): */
    uint32_t chosen; /* LOBES if all are black */
    float choice;    /* random number for the lobe */
};

static inline bool has_sheen(const struct bsdf *m)
{
    return HAS(FEATURE_SHEEN) && !v3_is_zero(m->sheen);
}

/* ---- the coat ---- */

static inline bool has_coat_normal(const struct bsdf *m)
{
    return HAS(FEATURE_COAT_NORMALS) && !v3_is_zero(m->coat_normal);
}

/* Returns a direction in the frame of the coat, whose z is its normal. */
static inline struct vec3 to_coat(const struct bsdf *m, struct vec3 d)
{
    struct vec3 t, b;

    if (!has_coat_normal(m))
        return d;
    frame_around(m->coat_normal, &t, &b);
    return v3(v3_dot(d, t), v3_dot(d, b), v3_dot(d, m->coat_normal));
}

static inline struct vec3 from_coat(const struct bsdf *m, struct vec3 d)
{
    struct vec3 t, b;

    if (!has_coat_normal(m))
        return d;
    frame_around(m->coat_normal, &t, &b);
    return v3_unit_again(v3_add(v3_add(v3_scale(t, d.x), v3_scale(b, d.y)),
                                v3_scale(m->coat_normal, d.z)));
}

/* Returns the coat as a BSDF of its own. */
static inline struct bsdf principled_coat(const struct bsdf *m)
{
    struct bsdf coat = *m;

    coat.specular = v3(COAT_F0, COAT_F0, COAT_F0);
    coat.alpha = m->coat_alpha;
    coat.anisotropy = 0.0f;
    return coat;
}

static inline struct bsdf principled_glass(const struct bsdf *m)
{
    struct bsdf glass = *m;

    if (m->is_thin != 0)
        return glass;
    glass.color = v3(sqrtf(m->color.x), sqrtf(m->color.y), sqrtf(m->color.z));
    return glass;
}

/* Least cosine for which the reflectance of a film is computed. Below, that of
 * any surface goes to 1, and F0 would have large errors. */
#define FILM_COSINE_MIN 0.05f

/* Returns the colour of metal under the film as seen from wo. At grazing angles
 * it reflects at least what Schlick's approximation has for black. */
static inline struct vec3 film_metal(const struct bsdf *m, struct vec3 wo)
{
    float c = f_max(wo.z, FILM_COSINE_MIN);
    float weight = schlick_weight(c);
    struct vec3 r =
        v3_lerp(fresnel_schlick(m->color, c),
                film_reflectance(m->color, m->film_ior, m->film_thickness, c),
                m->film);

    return v3(film_f0(r.x, 1.0f, weight), film_f0(r.y, 1.0f, weight),
              film_f0(r.z, 1.0f, weight));
}

/* Returns the mixture with the reflectance of plastic's face under the film as
 * seen from wo. It may bring specular_grazing() below 1. */
static inline struct bsdf film_plastic(const struct bsdf *m, struct vec3 wo)
{
    struct bsdf plastic = *m;
    float c = f_max(wo.z, FILM_COSINE_MIN);
    float weight = schlick_weight(c);
    struct vec3 r = v3_lerp(specular_fresnel(m->specular, weight),
                            film_reflectance(m->specular, m->film_ior,
                                             m->film_thickness, c),
                            m->film);
    float f90 =
        f_min(50.0f * v3_max_component(r) / (1.0f + 49.0f * weight), 1.0f);

    plastic.specular = v3(film_f0(r.x, f90, weight), film_f0(r.y, f90, weight),
                          film_f0(r.z, f90, weight));
    return plastic;
}

/* True if there are no facets but those of solid glass. */
static inline bool principled_is_solid(const struct bsdf *m)
{
    return m->metalness == 0.0f && m->transmission == 1.0f && m->is_thin == 0;
}

/* True if walks have taken a share of the base: subsurface.h. */
static inline bool has_walks(const struct bsdf *m)
{
    return HAS(FEATURE_SUBSURFACE) && m->subsurface < 0.0f;
}

/* Returns the plastic with what walks leave of its base. */
static inline struct bsdf principled_rest(const struct bsdf *m)
{
    struct bsdf plastic = *m;

    plastic.color = v3_scale(m->color, 1.0f + m->subsurface);
    return plastic;
}

/* Returns an estimate of the plastic's albedo. */
static inline float principled_plastic_albedo(const struct bsdf *m,
                                              struct vec3 wo,
                                              struct ggx_albedo facets)
{
    struct vec3 e = specular_albedo(m, wo, facets);
    struct bsdf rest;

    if (has_walks(m)) {
        rest = principled_rest(m);
        m = &rest;
    }
    return mean_channel(
        v3_add(e,
               v3_mul(base_albedo(m), v3(1.0f - e.x, 1.0f - e.y, 1.0f - e.z))));
}

static inline struct lobes principled_lobes(const struct bsdf *m,
                                            struct vec3 wo)
{
    struct lobes l;
    struct vec3 seen = to_coat(m, wo);
    float below = 1.0f, sum = 0.0f;

    l.metal = has_film(m) ? film_metal(m, wo) : m->color;
    l.facets.loss = 0.0f;
    l.facets.schlick = 0.0f;
    if (!principled_is_solid(m))
        l.facets = bsdf_albedo(m, wo);
    l.weight[LOBE_SHEEN] = 1.0f; /* its colour is in the lobe */
    l.chance[LOBE_SHEEN] = 0.0f;
    if (has_sheen(m)) {
        l.chance[LOBE_SHEEN] =
            v3_max_component(m->sheen) * sheen_albedo(wo.z, m->sheen_alpha);
        below -= l.chance[LOBE_SHEEN];
    }
    l.weight[LOBE_COAT] = 0.0f;
    l.chance[LOBE_COAT] = 0.0f;
    if (m->coat > 0.0f && (!has_coat_normal(m) || seen.z > COSINE_MIN)) {
        struct bsdf coat = principled_coat(m);

        l.weight[LOBE_COAT] = below * m->coat;
        l.chance[LOBE_COAT] =
            l.weight[LOBE_COAT] *
            specular_albedo(&coat, seen, bsdf_albedo(&coat, seen)).x;
        below -= l.chance[LOBE_COAT];
    }
    l.weight[LOBE_METAL] = below * m->metalness;
    below -= l.weight[LOBE_METAL];
    l.weight[LOBE_GLASS] = below * m->transmission;
    l.weight[LOBE_PLASTIC] = below - l.weight[LOBE_GLASS];
    l.chance[LOBE_METAL] =
        l.weight[LOBE_METAL] * mean_channel(fresnel_schlick(l.metal, wo.z));
    l.chance[LOBE_GLASS] = l.weight[LOBE_GLASS];
    l.chance[LOBE_PLASTIC] = 0.0f;
    if (l.weight[LOBE_PLASTIC] > 0.0f)
        l.chance[LOBE_PLASTIC] =
            l.weight[LOBE_PLASTIC] * principled_plastic_albedo(m, wo, l.facets);
    for (int i = 0; i < LOBES; i++)
        sum += l.chance[i];
    for (int i = 0; i < LOBES; i++)
        l.chance[i] = sum > 0.0f ? l.chance[i] / sum : 0.0f;
    return l;
}

static inline bool principled_has_glass_delta(const struct bsdf *m)
{
    return is_smooth(m) || (m->is_thin == 0 && glass_is_index_matched(m));
}

/* True if all lobes are deltas. */
static inline bool principled_is_delta(const struct bsdf *m)
{
    struct bsdf coat = principled_coat(m);
    float dielectric = 1.0f - m->metalness;

    if (has_sheen(m) || (m->coat > 0.0f && !is_smooth(&coat)))
        return false;
    if (!is_smooth(m) && (m->metalness > 0.0f || m->transmission < 1.0f ||
                          !principled_has_glass_delta(m)))
        return false;
    return !(dielectric * (1.0f - m->transmission) > 0.0f) ||
           (has_walks(m) && m->subsurface == -1.0f) ||
           v3_is_zero(base_albedo(m));
}

/* Adds weight * f of a lobe to *sum, and its share of the density to *pdf. */
static inline void principled_add(const struct lobes *l, uint32_t lobe,
                                  struct vec3 f, float lobe_pdf,
                                  struct vec3 *sum, float *pdf)
{
    *sum = v3_add(*sum, v3_scale(f, l->weight[lobe]));
    *pdf += l->chance[lobe] * lobe_pdf;
}

static inline void principled_add_coat(const struct bsdf *m,
                                       const struct lobes *l, struct vec3 wo,
                                       struct vec3 wi, struct vec3 *sum,
                                       float *pdf)
{
    struct bsdf coat = principled_coat(m);
    struct vec3 h, f;

    if (is_smooth(&coat))
        return;
    if (has_coat_normal(m)) {
        wo = to_coat(m, wo);
        wi = to_coat(m, wi);
        if (!(wi.z > COSINE_MIN))
            return;
    }
    h = half_vector(wo, wi);
    f = v3_scale(specular_fresnel(coat.specular, schlick_weight(v3_dot(wo, h))),
                 ggx_reflection(wo, wi, h, bsdf_facets(&coat)));
    principled_add(l, LOBE_COAT, f,
                   ggx_reflection_pdf(wo, h, bsdf_facets(&coat)), sum, pdf);
}

/* f |cosine| and density of all lobes that are not deltas. */
static inline struct vec3 principled_terms_of(const struct bsdf *m,
                                              const struct lobes *l,
                                              struct vec3 wo, struct vec3 wi,
                                              float *pdf)
{
    struct vec3 sum = v3(0.0f, 0.0f, 0.0f), f;
    struct facet_albedos e;
    float lobe_pdf;
    bool is_above = !is_behind(m, wi);

    *pdf = 0.0f;
    if (!principled_is_solid(m))
        e = bsdf_albedos(m, l->facets, v3_above(wi));
    if (l->weight[LOBE_GLASS] > 0.0f && !principled_has_glass_delta(m)) {
        struct bsdf glass = principled_glass(m);

        f = m->is_thin != 0 ? thin_terms(&glass, wo, wi, &e, &lobe_pdf)
                            : glass_terms(&glass, wo, wi, &lobe_pdf);
        principled_add(l, LOBE_GLASS, f, lobe_pdf, &sum, pdf);
    }
    if (wi.z < 0.0f && !is_translucent(m))
        return sum;
    if (is_above && has_sheen(m)) {
        f = v3_scale(m->sheen, sheen_f(wo, wi, m->sheen_alpha));
        principled_add(l, LOBE_SHEEN, f, SHEEN_PDF, &sum, pdf);
    }
    if (is_above && l->weight[LOBE_COAT] > 0.0f)
        principled_add_coat(m, l, wo, wi, &sum, pdf);
    if (is_above && l->weight[LOBE_METAL] > 0.0f && !is_smooth(m)) {
        f = metal_terms(m, l->metal, wo, wi, &e, &lobe_pdf);
        principled_add(l, LOBE_METAL, f, lobe_pdf, &sum, pdf);
    }
    if (l->weight[LOBE_PLASTIC] > 0.0f) {
        struct bsdf rest;

        if (has_walks(m)) {
            rest = principled_rest(m);
            m = &rest;
        }
        f = plastic_terms(m, wo, wi, &e, &lobe_pdf);
        principled_add(l, LOBE_PLASTIC, f, lobe_pdf, &sum, pdf);
    }
    return sum;
}

static inline struct vec3 principled_terms(const struct bsdf *m, struct vec3 wo,
                                           struct vec3 wi, float *pdf)
{
    struct bsdf plastic;
    struct lobes l;

    if (has_film(m)) {
        plastic = film_plastic(m, wo);
        m = &plastic;
    }
    l = principled_lobes(m, wo);
    return principled_terms_of(m, &l, wo, wi, pdf);
}

/* Chooses a lobe by a random number. */
static inline void principled_choose(struct lobes *l, float choice)
{
    l->chosen = LOBES;
    for (uint32_t i = 0; i < LOBES; i++) {
        if (!(l->chance[i] > 0.0f))
            continue;
        l->chosen = i;
        if (choice < l->chance[i]) {
            choice /= l->chance[i];
            break;
        }
        choice -= l->chance[i]; /* of the last lobe by rounding only */
    }
    l->choice = choice;
}

static inline bool coat_direction(const struct bsdf *m, struct vec3 wo,
                                  struct vec2 u, struct bsdf_sample *s)
{
    struct bsdf coat = principled_coat(m);
    struct vec3 wi;

    wo = to_coat(m, wo);
    if (is_smooth(&coat)) {
        wi = from_coat(m, v3(-wo.x, -wo.y, wo.z));
        return wi.z > COSINE_MIN &&
               sample_delta(s, wi,
                            specular_fresnel(coat.specular,
                                             schlick_weight(wo.z)));
    }
    wi = ggx_reflect(wo, bsdf_facets(&coat), u);
    if (!(wi.z > COSINE_MIN))
        return false;
    wi = from_coat(m, wi);
    return wi.z > COSINE_MIN && sample_direction(s, wi, 1.0f);
}

/* Samples a direction from the chosen lobe; only those of deltas get their
 * weights. */
static inline bool principled_direction(const struct bsdf *m,
                                        const struct lobes *l, struct vec3 wo,
                                        struct vec2 u, struct bsdf_sample *s)
{
    struct bsdf glass, rest;

    if (l->chosen == LOBE_SHEEN) {
        sample_direction(s, sheen_direction(u), 1.0f);
        return s->wi.z > COSINE_MIN;
    }
    if (l->chosen == LOBE_METAL)
        return metal_direction(m, l->metal, wo, u, l->choice < l->facets.loss,
                               s);
    if (l->chosen == LOBE_PLASTIC) {
        if (has_walks(m)) {
            rest = principled_rest(m);
            m = &rest;
        }
        if (!plastic_direction(m, wo, l->facets, u, l->choice, s))
            return false;
        if (is_translucent(m) && m->transmission > 0.0f && m->is_thin == 0)
            s->eta_scale = glass_eta_scale(m, s->wi);
        return true;
    }
    if (l->chosen == LOBE_GLASS) {
        glass = principled_glass(m);
        return m->is_thin != 0
                   ? thin_direction(&glass, wo, l->facets, u, l->choice, s)
                   : glass_direction(&glass, wo, u, l->choice, s);
    }
    return coat_direction(m, wo, u, s);
}

static inline bool principled_sample(const struct bsdf *m, struct vec3 wo,
                                     struct vec2 u, float choice,
                                     struct bsdf_sample *s)
{
    struct bsdf plastic;
    struct lobes l;
    float eta_scale;
    struct vec3 f;
    float pdf;

    if (has_film(m)) {
        plastic = film_plastic(m, wo);
        m = &plastic;
    }
    l = principled_lobes(m, wo);
    principled_choose(&l, choice);
    if (l.chosen == LOBES || !principled_direction(m, &l, wo, u, s))
        return false;
    if (s->is_delta) {
        s->weight =
            v3_scale(s->weight, l.weight[l.chosen] / l.chance[l.chosen]);
        return true;
    }
    eta_scale = s->eta_scale;
    f = principled_terms_of(m, &l, wo, s->wi, &pdf);
    if (!sample_density(s, s->wi, f, pdf))
        return false;
    s->eta_scale = eta_scale;
    return true;
}

#endif
