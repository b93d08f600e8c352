// SPDX-License-Identifier: MIT
/*
 * bsdf.h - BSDFs of all materials, by kind
 *
 * Functions take the BSDF, wo, then wi or random numbers. bsdf_terms() has
 * f |cosine| and the density together, for all lobes that are not deltas. Delta
 * lobes are sampled by bsdf_sample() only. Reflected directions lie above the
 * surface, transmitted ones below.
 *
 * Units:     local frame of bsdf_types.h; densities per solid angle
 * Errors:    bsdf_sample() returns false if no light is scattered; impossible
 *            directions are black
 */
#ifndef KERNELS_BSDF_H
#define KERNELS_BSDF_H

#include "kernels/principled.h"

/* True if the BSDF is Lambert's. Builds without other kinds need no test. */
static inline bool bsdf_is_lambert(const struct bsdf *m)
{
    return !HAS(FEATURE_ROUGH_DIFFUSE | FEATURE_METAL | FEATURE_GLASS |
                FEATURE_PLASTIC | FEATURE_PRINCIPLED) ||
           m->kind == MATERIAL_DIFFUSE;
}

/* True if the BSDF scatters nothing, like that of most lamps. */
static inline bool bsdf_is_black(const struct bsdf *m)
{
    return v3_is_zero(base_albedo(m)) &&
           (bsdf_is_lambert(m) || m->kind == MATERIAL_ROUGH_DIFFUSE);
}

static inline bool bsdf_is_principled(const struct bsdf *m)
{
    return HAS(FEATURE_PRINCIPLED) && m->kind == MATERIAL_PRINCIPLED;
}

/* True if rays refract into a solid. */
static inline bool bsdf_is_solid(const struct bsdf *m)
{
    if (bsdf_is_principled(m))
        return m->transmission > 0.0f && m->is_thin == 0;
    return HAS(FEATURE_GLASS) && m->kind == MATERIAL_GLASS;
}

static inline bool is_thin_glass(const struct bsdf *m)
{
    return HAS(FEATURE_GLASS) && m->kind == MATERIAL_THIN_GLASS;
}

/* True if all lobes are deltas: f is zero for any light sample. */
static inline bool bsdf_is_delta(const struct bsdf *m)
{
    if (bsdf_is_principled(m))
        return principled_is_delta(m);
    if (HAS(FEATURE_METAL) && m->kind == MATERIAL_METAL)
        return is_smooth(m);
    if (HAS(FEATURE_GLASS) && m->kind == MATERIAL_GLASS)
        return is_smooth(m) || glass_is_index_matched(m);
    if (HAS(FEATURE_PLASTIC) && m->kind == MATERIAL_PLASTIC)
        return is_smooth(m) && v3_is_zero(base_albedo(m));
    return is_thin_glass(m) && (!HAS(FEATURE_ROUGH_SHEETS) || is_smooth(m));
}

/* True if light goes through the surface, but not by a diffuse base. */
static inline bool bsdf_is_glass(const struct bsdf *m)
{
    if (bsdf_is_principled(m))
        return m->transmission > 0.0f;
    return bsdf_is_solid(m) || is_thin_glass(m);
}

/* True if f is not zero for directions below the surface. */
static inline bool bsdf_transmits(const struct bsdf *m)
{
    if (is_translucent(m))
        return true;
    if (bsdf_is_principled(m))
        return m->transmission > 0.0f && !principled_has_glass_delta(m);
    return bsdf_is_glass(m) && !bsdf_is_delta(m);
}

/* Returns f |cosine| without bsdf_eta_scale(); *pdf is the density of
 * bsdf_sample(). */
static inline struct vec3 bsdf_terms(const struct bsdf *m, struct vec3 wo,
                                     struct vec3 wi, float *pdf)
{
    struct facet_albedos e;

    *pdf = 0.0f;
    if (!(wo.z > COSINE_MIN && fabsf(wi.z) > COSINE_MIN) || bsdf_is_delta(m))
        return v3(0.0f, 0.0f, 0.0f);
    if (bsdf_is_principled(m))
        return principled_terms(m, wo, wi, pdf);
    if (HAS(FEATURE_GLASS) && m->kind == MATERIAL_GLASS)
        return glass_terms(m, wo, wi, pdf);
    if (HAS(FEATURE_ROUGH_SHEETS) && is_thin_glass(m)) {
        e = bsdf_albedos(m, bsdf_albedo(m, wo), v3_above(wi));
        return thin_terms(m, wo, wi, &e, pdf);
    }
    if (wi.z < 0.0f && !is_translucent(m))
        return v3(0.0f, 0.0f, 0.0f);
    if (bsdf_is_lambert(m))
        return lambert_terms(m, wi, pdf);
    if (HAS(FEATURE_ROUGH_DIFFUSE) && m->kind == MATERIAL_ROUGH_DIFFUSE)
        return eon_terms(m, wo, wi, pdf);
    e = bsdf_albedos(m, bsdf_albedo(m, wo), base_side(m, wi));
    if (HAS(FEATURE_METAL) && m->kind == MATERIAL_METAL)
        return metal_terms(m, m->color, wo, wi, &e, pdf);
    return plastic_terms(m, wo, wi, &e, pdf);
}

/* Factor of radiance from wi beside f: 1/eta^2 for transmission into glass
 * (Veach 1997, 5.2). */
static inline float bsdf_eta_scale(const struct bsdf *m, struct vec3 wi)
{
    return bsdf_is_solid(m) ? glass_eta_scale(m, wi) : 1.0f;
}

/* Samples a direction. Returns false if the light is absorbed. `choice` is the
 * random number that chooses the lobe. */
static inline bool bsdf_sample(const struct bsdf *m, struct vec3 wo,
                               struct vec2 u, float choice,
                               struct bsdf_sample *s)
{
    if (!(wo.z > COSINE_MIN))
        return false;
    if (bsdf_is_lambert(m))
        return lambert_sample(m, u, choice, s);
    if (bsdf_is_principled(m))
        return principled_sample(m, wo, u, choice, s);
    if (HAS(FEATURE_ROUGH_DIFFUSE) && m->kind == MATERIAL_ROUGH_DIFFUSE)
        return eon_sample(m, wo, u, choice, s);
    if (HAS(FEATURE_METAL) && m->kind == MATERIAL_METAL)
        return metal_sample(m, wo, u, choice, s);
    if (HAS(FEATURE_PLASTIC) && m->kind == MATERIAL_PLASTIC)
        return plastic_sample(m, wo, u, choice, s);
    if (HAS(FEATURE_GLASS) && m->kind == MATERIAL_GLASS)
        return glass_sample(m, wo, u, choice, s);
    return thin_sample(m, wo, u, choice, s);
}

#endif
