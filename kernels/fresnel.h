// SPDX-License-Identifier: MIT
/*
 * fresnel.h - Fresnel reflectance of a smooth face
 *
 * Exact for dielectrics, Schlick's approximation (1994) for metals and coats.
 *
 * Units:     cosines to the face's normal, from 0 to 1
 */
#ifndef KERNELS_FRESNEL_H
#define KERNELS_FRESNEL_H

#include "kernels/vec.h"

static inline float schlick_weight(float cosine)
{
    float c = f_max(1.0f - cosine, 0.0f);
    float c2 = c * c;

    return c2 * c2 * c;
}

static inline struct vec3 fresnel_schlick(struct vec3 f0, float cosine)
{
    return v3_lerp(f0, v3(1.0f, 1.0f, 1.0f), schlick_weight(cosine));
}

/* Hemispherical mean of schlick_weight(), 2 int (1 - mu)^5 mu dmu. */
#define SCHLICK_MEAN (1.0f / 21.0f)

static inline struct vec3 fresnel_schlick_mean(struct vec3 f0)
{
    return v3_lerp(f0, v3(1.0f, 1.0f, 1.0f), SCHLICK_MEAN);
}

/* Reflectance of a dielectric face for unpolarised light, from the cosines on
 * both sides. */
static inline float fresnel_cosines(float c, float cos_t, float eta)
{
    float rs = (c - eta * cos_t) / (c + eta * cos_t);
    float rp = (eta * c - cos_t) / (eta * c + cos_t);

    return f_min(0.5f * (rs * rs + rp * rp), 1.0f);
}

/* The same from the cosine on one side. *cos_t is the cosine of the refracted
 * ray, or 0 for total reflection. */
static inline float fresnel_dielectric(float c, float eta, float *cos_t)
{
    float s2 = f_max((1.0f - c) * (1.0f + c), 0.0f) / (eta * eta);

    *cos_t = 0.0f;
    if (s2 >= 1.0f)
        return 1.0f;
    *cos_t = sqrtf(1.0f - s2);
    return fresnel_cosines(c, *cos_t, eta);
}

#endif
