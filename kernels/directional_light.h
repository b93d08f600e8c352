// SPDX-License-Identifier: MIT
/*
 * directional_light.h - directional lights, and the choice between them and the
 * sky
 *
 * All light from infinity shares its light samples by the irradiance that the
 * receiver would have without occlusion, so that no sample is spent on a sun
 * behind the surface. Discs are sampled uniformly.
 *
 * Units:     irradiance, radiance, densities per solid angle
 */
#ifndef KERNELS_DIRECTIONAL_LIGHT_H
#define KERNELS_DIRECTIONAL_LIGHT_H

#include "kernels/light_tree.h"
#include "kernels/sample.h"

static inline bool has_directional_lights(const struct world *w)
{
    return HAS(FEATURE_DIRECTIONAL_LIGHTS) &&
           w->settings.directional_light_count > 0;
}

/* Importance of a directional light for a receiver. It is above 0 where any
 * part of its disc is above the horizon. */
static inline float directional_importance(const struct world *w, uint32_t i,
                                           const struct receiver *r)
{
    float cosine = v3_dot(w->directional_lights[i].d, r->n);

    if (r->transmits)
        cosine = fabsf(cosine);
    return w->directional_lights[i].power *
           f_max(cosine + w->directional_lights[i].sine, 0.0f);
}

/* Importance of all light from infinity: of the sky and of directional
 * lights. */
static inline float infinite_importance(const struct world *w,
                                        const struct receiver *r)
{
    float sum = w->settings.sky_power;

    for (uint32_t i = 0; i < w->settings.directional_light_count; i++)
        sum += directional_importance(w, i, r);
    return sum;
}

/* Probability that a light sample is of the part of light from infinity that
 * has this importance. */
static inline float infinite_pmf(const struct world *w,
                                 const struct receiver *r, float importance)
{
    return importance > 0.0f ? w->settings.sky_share *
                                   (importance / infinite_importance(w, r))
                             : 0.0f;
}

/* Probability that a light sample is of the sky. */
static inline float sky_pmf(const struct world *w, const struct receiver *r)
{
    return has_directional_lights(w) ? infinite_pmf(w, r, w->settings.sky_power)
                                     : w->settings.sky_share;
}

/* Probability that a light sample is of directional light i. */
static inline float directional_pmf(const struct world *w, uint32_t i,
                                    const struct receiver *r)
{
    return infinite_pmf(w, r, directional_importance(w, i, r));
}

/* Chooses between the sky and directional lights by a number in [0, 1). Returns
 * a light, or NO_INDEX for the sky. */
static inline uint32_t infinite_choose(const struct world *w,
                                       const struct receiver *r, float u)
{
    float rest = u * infinite_importance(w, r) - w->settings.sky_power;
    uint32_t chosen = NO_INDEX;

    for (uint32_t i = 0;
         i < w->settings.directional_light_count && rest >= 0.0f; i++) {
        float importance = directional_importance(w, i, r);

        rest -= importance;
        if (importance > 0.0f)
            chosen = i;
    }
    return chosen;
}

/* Density of directions to the disc of a light. */
static inline float directional_pdf(const struct world *w, uint32_t i,
                                    const struct receiver *r)
{
    return directional_pmf(w, i, r) * cone_pdf(w->directional_lights[i].size);
}

/* True if the unit vector d leads to the disc of light i. The length of a chord
 * keeps the digits that the cosine of a small angle has lost. */
static inline bool disc_meets(const struct world *w, uint32_t i, struct vec3 d)
{
    struct vec3 chord = v3_sub(d, w->directional_lights[i].d);

    return v3_dot(chord, chord) <= 2.0f * w->directional_lights[i].size;
}

#endif
