// SPDX-License-Identifier: MIT
/*
 * bsdf_types.h - a material where it was hit, and a direction drawn from it
 *
 * Units:     local frame, z along the shading normal on the eye's side; wo to
 *            the eye, wi to the light, both unit vectors
 */
#ifndef KERNELS_BSDF_TYPES_H
#define KERNELS_BSDF_TYPES_H

#include "kernels/vec.h"

/* Directions closer to the surface than this have no digits left: nothing
 * scatters from or to them, and no square or quotient of cosines vanishes. */
#define COSINE_MIN 1e-15f

struct bsdf {
    struct vec3 color; /* albedo; reflectance of a metal; tint of glass */
    struct vec3 coat;  /* plastic: the coat's reflectance at normal incidence */
    float alpha;       /* GGX; of rough diffuse the roughness */
    float eta; /* index on the far side over the one on the eye's side */
    uint32_t kind;
};

struct bsdf_sample {
    struct vec3 wi;
    struct vec3 weight; /* f |cosine| / pdf, without eta_scale */
    float pdf;          /* per solid angle; 0 where is_delta */
    float eta_scale;    /* radiance scaling 1/eta^2 of a crossing, else 1 */
    bool is_delta;      /* no other way to sample would find this direction */
};

/* The surface has no microfacets. */
static inline bool is_smooth(const struct bsdf *m)
{
    return !HAS(FEATURE_ROUGH) || m->alpha < ALPHA_SMOOTH;
}

/* A direction without a density. True for the callers' last line. */
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

/* A direction with f |cosine| and its density; false if it has none. */
static inline bool sample_density(struct bsdf_sample *s, struct vec3 wi,
                                  struct vec3 f, float pdf)
{
    if (!(pdf > 0.0f))
        return false;
    s->wi = wi;
    s->weight = v3_scale(f, 1.0f / pdf);
    s->pdf = pdf;
    s->eta_scale = 1.0f;
    s->is_delta = false;
    return true;
}

#endif
