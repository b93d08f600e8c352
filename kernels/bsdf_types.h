// SPDX-License-Identifier: MIT
/*
 * bsdf_types.h - a BSDF at a surface point, and a sample of it
 *
 * Units:     local frame, z along the shading normal on the eye's side; wo to
 *            the eye, wi to the light, both unit vectors
 */
#ifndef KERNELS_BSDF_TYPES_H
#define KERNELS_BSDF_TYPES_H

#include "kernels/ggx.h"

/* Least cosine of a direction to the normal. Directions closer to the surface
 * do not scatter, so that no square or quotient of cosines underflows. */
#define COSINE_MIN 1e-15f

struct bsdf {
    struct vec3 color;    /* albedo; reflectance of a metal; tint of glass */
    struct vec3 specular; /* plastic: its face's reflectance, as in materials */
    float alpha;          /* GGX roughness; EON roughness for rough diffuse */
    float eta;     /* refractive index of the far side over that of wo's side */
    uint32_t kind; /* enum material_kind */
    float metalness, transmission, coat, coat_alpha; /* principled.h */
    struct vec3 sheen;
    float sheen_alpha;
    float anisotropy; /* of metal, plastic and sheets, 0 to 1 along x */
    uint32_t is_thin; /* 1: the glass of a mixture is a thin sheet */
    float film;       /* weight of a thin film on a mixture: thin_film.h */
    float film_ior, film_thickness; /* refractive index; nanometres */
    struct vec3 coat_normal;        /* unit; zero: that of the base */
    float subsurface; /* share of the base that is a walk; below 0: minus the
                         share that walks have taken. subsurface.h */
    struct vec3 back_color; /* albedo of diffuse transmission: diffuse.h */
    float translucency;     /* its weight in the diffuse base */
};

/* The widths of a highlight have the ratio 1 - ANISOTROPY_SHARE anisotropy. */
#define ANISOTROPY_SHARE 0.9f

/* Returns the microfacets of metal, plastic and sheets. The widths have the
 * ratio of Burley 2012, "Physically based shading at Disney", B.1. */
static inline struct ggx bsdf_facets(const struct bsdf *m)
{
    struct ggx g = {m->alpha, 1.0f};

    if (HAS(FEATURE_ANISOTROPY) && m->anisotropy > 0.0f)
        g.stretch = 1.0f / sqrtf(1.0f - ANISOTROPY_SHARE * m->anisotropy);
    return g;
}

struct bsdf_sample {
    struct vec3 wi;
    struct vec3 weight; /* f |cosine| / pdf, without eta_scale */
    float pdf;          /* per solid angle; 0 where is_delta */
    float eta_scale;    /* 1/eta^2 for a transmission into glass, else 1 */
    bool is_delta;      /* a delta lobe was sampled */
};

static inline float mean_channel(struct vec3 c)
{
    return (c.x + c.y + c.z) * (1.0f / 3.0f);
}

/* Mirrors directions below the surface to above it. */
static inline struct vec3 v3_above(struct vec3 w)
{
    return v3(w.x, w.y, fabsf(w.z));
}

/* True if the surface is smooth, so that its specular lobes are deltas. */
static inline bool is_smooth(const struct bsdf *m)
{
    return !HAS(FEATURE_ROUGH) || m->alpha < ALPHA_SMOOTH;
}

/* Fills the sample of a delta lobe. Always returns true. */
static inline bool sample_delta(struct bsdf_sample *s, struct vec3 wi,
                                struct vec3 weight)
{
    s->wi = wi;
    s->weight = weight;
    s->pdf = 0.0f;
    s->eta_scale = 1.0f;
    s->is_delta = true;
    return true;
}

/* Fills the direction of a sample of a rough lobe, but not its weight and
 * density. Always returns true. */
static inline bool sample_direction(struct bsdf_sample *s, struct vec3 wi,
                                    float eta_scale)
{
    s->wi = wi;
    s->eta_scale = eta_scale;
    s->is_delta = false;
    return true;
}

/* Fills a sample from f |cosine| and the density. Returns false if the density
 * is 0. */
static inline bool sample_density(struct bsdf_sample *s, struct vec3 wi,
                                  struct vec3 f, float pdf)
{
    if (!(pdf > 0.0f))
        return false;
    s->weight = v3_scale(f, 1.0f / pdf);
    s->pdf = pdf;
    return sample_direction(s, wi, 1.0f);
}

#endif
