// SPDX-License-Identifier: MIT
/*
 * thin_film.h - reflectance of a surface under a thin transparent film
 *
 * Light is reflected by both faces of the film and between them, and interferes
 * (Airy's sum, as in Belcour and Barla 2017, "A practical extension to
 * microfacet theory for the modeling of varying iridescence"). A few
 * wavelengths are summed with the weights of linear Rec.709 in white light.
 * Up to 1000 nm, on bases of an index from 1.3 on, that is within 0.5 % of the
 * integral over the CIE observer, and within 0.01 % in the mean; up to 2000 nm
 * within 2 %. Films alone miss narrow resonances at grazing angles, by up to 6
 * %. A base of reflectance F0 is taken as a dielectric.
 *
 * Units:     thickness in nanometres; cosines to the normal in the air
 */
#ifndef KERNELS_THIN_FILM_H
#define KERNELS_THIN_FILM_H

#include "kernels/bsdf_types.h"
#include "kernels/fresnel.h"

#define FILM_WAVES 16

// clang-format off
/* Reciprocals of the wavelengths, evenly from 730 to 385 nm. */
CONSTANT float film_waves[FILM_WAVES] = {
    0.0014082236f, 0.0014849448f, 0.0015616661f, 0.0016383873f,
    0.0017151085f, 0.0017918297f, 0.001868551f, 0.0019452722f,
    0.0020219934f, 0.0020987146f, 0.0021754359f, 0.0022521571f,
    0.0023288783f, 0.0024055995f, 0.0024823208f, 0.002559042f,
};

/* Weights of the wavelengths for red, green and blue; the sum of each is 1. The
 * CIE 1931 observer and the matrix of IEC 61966-2-1. */
CONSTANT float film_weights[3 * FILM_WAVES] = {
    0.00463748f, 0.05083205f, 0.28503580f, 0.54823899f,
    0.36643001f, 0.05322710f, -0.11686489f, -0.13940274f,
    -0.07562079f, -0.03457910f, 0.00286932f, 0.02356077f,
    0.02275814f, 0.00703162f, 0.00149099f, 0.00035525f,
    -0.00064019f, -0.00684961f, -0.03254599f, -0.00920882f,
    0.16618064f, 0.31301567f, 0.32514553f, 0.21712205f,
    0.08807255f, 0.02439423f, -0.01651151f, -0.03153959f,
    -0.02670928f, -0.00789885f, -0.00164040f, -0.00038643f,
    -0.00004131f, -0.00047478f, -0.00342347f, -0.01348781f,
    -0.03122527f, -0.04126272f, -0.03240719f, 0.00159976f,
    0.06413832f, 0.18122522f, 0.29659128f, 0.29549909f,
    0.20966015f, 0.05872688f, 0.01205238f, 0.00282948f,
};
// clang-format on

/* Greatest reflectance of a base, as its refractive index is finite. */
#define FILM_F0_MAX 0.999999f

/* Least denominator of Airy's sum, which is 0 where all light is reflected. */
#define FILM_DIVISOR_MIN 1e-7f

/* Returns cos(2 pi turns) within 1e-5, as a Taylor series of the sine. */
static inline float film_cosine(float turns)
{
    float t = fabsf(turns - floorf(turns + 0.5f));
    float x = 2.0f * PI * (0.25f - t);
    float z = x * x;

    return x * (1.0f + z * (-1.0f / 6.0f + z * (1.0f / 120.0f +
                                                z * (-1.0f / 5040.0f +
                                                     z * (1.0f / 362880.0f)))));
}

/* Reflectance of one polarisation in a channel of colour. a, b: amplitudes that
 * the upper and the lower face reflect; cosines: of the phase between them, for
 * each wavelength. */
static inline float film_airy(float a, float b, const float *cosines,
                              uint32_t channel)
{
    float q = a * b;
    float passed = 0.0f;

    for (uint32_t i = 0; i < FILM_WAVES; i++)
        passed += film_weights[channel * FILM_WAVES + i] /
                  f_max(1.0f + q * (q + 2.0f * cosines[i]), FILM_DIVISOR_MIN);
    return 1.0f - (1.0f - a * a) * (1.0f - b * b) * passed;
}

/* Reflectance of a channel. c, c2: cosines in the air and in the film. */
static inline float film_channel(float f0, float c, float c2, float ior,
                                 const float *cosines, uint32_t channel)
{
    float root = sqrtf(f_min(f0, FILM_F0_MAX));
    float base = (1.0f + root) / (1.0f - root);
    float c3 = sqrtf(f_max(1.0f - (1.0f - c * c) / (base * base), 0.0f));
    float s = film_airy((c - ior * c2) / (c + ior * c2),
                        (ior * c2 - base * c3) / (ior * c2 + base * c3),
                        cosines, channel);
    float p = film_airy((ior * c - c2) / (ior * c + c2),
                        (base * c2 - ior * c3) / (base * c2 + ior * c3),
                        cosines, channel);

    return f_min(f_max(0.5f * (s + p), 0.0f), 1.0f);
}

/* Returns the reflectance at cosine c of a base whose reflectance in air at
 * normal incidence is f0, under a film of refractive index ior, 1 or more. */
static inline struct vec3 film_reflectance(struct vec3 f0, float ior,
                                           float thickness, float c)
{
    float c2 = sqrtf(f_max(1.0f - (1.0f - c * c) / (ior * ior), 0.0f));
    float way = 2.0f * ior * thickness * c2;
    float cosines[FILM_WAVES];

    for (uint32_t i = 0; i < FILM_WAVES; i++)
        cosines[i] = film_cosine(way * film_waves[i]);
    return v3(film_channel(f0.x, c, c2, ior, cosines, 0),
              film_channel(f0.y, c, c2, ior, cosines, 1),
              film_channel(f0.z, c, c2, ior, cosines, 2));
}

static inline bool has_film(const struct bsdf *m)
{
    return HAS(FEATURE_THIN_FILM) && m->film > 0.0f;
}

/* Returns what a face of glass reflects at cosine c on wo's side, or what it
 * transmits if is_crossing, where its film has full weight or less. */
static inline struct vec3 film_glass(const struct bsdf *m, float c,
                                     bool is_crossing)
{
    float root = (m->eta - 1.0f) / (m->eta + 1.0f);
    float f0 = root * root;
    float cos_t;
    float f = fresnel_dielectric(c, m->eta, &cos_t);
    struct vec3 r = v3(f, f, f);

    if (f < 1.0f)
        r = v3_lerp(r,
                    film_reflectance(v3(f0, f0, f0), m->film_ior,
                                     m->film_thickness,
                                     m->eta < 1.0f ? cos_t : c),
                    m->film);
    return is_crossing ? v3(1.0f - r.x, 1.0f - r.y, 1.0f - r.z) : r;
}

/* Divides the channels by their mean, which becomes *mean. Black stays so. */
static inline struct vec3 film_tint(struct vec3 r, float *mean)
{
    *mean = mean_channel(r);
    return *mean > 0.0f ? v3_scale(r, 1.0f / *mean) : r;
}

/* Returns the F0 of which Schlick's approximation with grazing reflectance f90
 * gives the reflectance r where schlick_weight() is `weight`, below 1. */
static inline float film_f0(float r, float f90, float weight)
{
    return f_max((r - f90 * weight) / (1.0f - weight), 0.0f);
}

#endif
