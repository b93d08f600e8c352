// SPDX-License-Identifier: MIT
/*
 * attenuation.h - light absorbed along its way through a solid
 *
 * The law of Beer and Lambert: over a distance t the radiance falls by
 * exp(-sigma t), with an absorption coefficient sigma for each channel. A ray
 * is in a solid if it left one of its faces on the inner side, or if it left
 * something that is in the solid. Solids are not nested: a ray that leaves a
 * solid is in air.
 *
 * Units:     lengths in normalised scene units, sigma in their inverse
 */
#ifndef KERNELS_ATTENUATION_H
#define KERNELS_ATTENUATION_H

#include "kernels/power.h"
#include "kernels/surface_point.h"

/* Returns the share of the radiance that is left after a distance, which is
 * FLOAT_MAX for the sky. */
static inline struct vec3 transmittance(struct vec3 sigma, float distance)
{
    return v3(f_exp(-sigma.x * distance), f_exp(-sigma.y * distance),
              f_exp(-sigma.z * distance));
}

/* Returns radiance that has come a distance through a medium. */
static inline struct vec3 attenuated(struct vec3 radiance, struct vec3 medium,
                                     float distance)
{
    if (v3_is_zero(medium))
        return radiance;
    return v3_mul(radiance, transmittance(medium, distance));
}

/* Returns the absorption of the medium of a ray that leaves a surface at the
 * cosine z to its normal, where the path has arrived through `medium`. */
static inline struct vec3 medium_beyond(const struct material *m,
                                        const struct bsdf *b,
                                        const struct surface_point *v, float z,
                                        struct vec3 medium)
{
    if (!bsdf_is_solid(b))
        return medium;
    return (z > 0.0f) == v->is_outside ? v3(0.0f, 0.0f, 0.0f) : m->attenuation;
}

#endif
