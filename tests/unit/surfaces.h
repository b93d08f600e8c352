// SPDX-License-Identifier: MIT
/*
 * surfaces.h - a surface of each kind
 *
 * Units:     cosines to the normal
 * Threads:   one
 */
#ifndef TESTS_SURFACES_H
#define TESTS_SURFACES_H

#include "tests/unit/check.h"

#include <math.h>

#include "kernels/bsdf.h"

static const float alphas[] = {5e-4f, 1e-3f, 1e-2f, 0.1f, 0.3f, 0.6f, 1.0f};
static const float cosines[] = {1.0f, 0.7f, 0.3f, 0.05f, 0.001f};
static const float etas[] = {1.5f, 1 / 1.5f, 1.33f, 2.4f, 1 / 2.4f};

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const struct vec3 white = {1, 1, 1};
static const struct vec3 gold = {1.0f, 0.78f, 0.34f};
static const struct vec3 brick = {0.6f, 0.3f, 0.1f};
static const struct vec3 strong = {0.08f, 0.05f, 0.02f};

/* Returns f |cosine| of bsdf_terms(). */
static inline struct vec3 surface_f(const struct bsdf *m, struct vec3 wo,
                                    struct vec3 wi)
{
    float pdf;

    return bsdf_terms(m, wo, wi, &pdf);
}

/* Returns the density of bsdf_terms(). */
static inline float surface_pdf(const struct bsdf *m, struct vec3 wo,
                                struct vec3 wi)
{
    float pdf;

    bsdf_terms(m, wo, wi, &pdf);
    return pdf;
}

/* Called for each surface that has a density, alpha and cosine. */
typedef void (*visit)(const struct bsdf *m, float mu);

static inline void at_all_cosines(visit f, const struct bsdf *m)
{
    for (size_t c = 0; c < COUNT(cosines); c++)
        f(m, cosines[c]);
}

static inline void at_all_reflections(visit f)
{
    struct bsdf m = {.color = brick, .eta = 1, .kind = MATERIAL_DIFFUSE};

    at_all_cosines(f, &m);
    m.kind = MATERIAL_ROUGH_DIFFUSE;
    for (m.alpha = 0.25f; m.alpha <= 1; m.alpha += 0.25f)
        at_all_cosines(f, &m);
    m = (struct bsdf){.color = brick,
                      .specular = strong,
                      .eta = 1,
                      .kind = MATERIAL_PLASTIC};
    at_all_cosines(f, &m); /* perfectly smooth */
    for (size_t a = 0; a < COUNT(alphas); a++) {
        m = (struct bsdf){.color = gold,
                          .alpha = alphas[a],
                          .eta = 1,
                          .kind = MATERIAL_METAL};
        at_all_cosines(f, &m);
        m = (struct bsdf){.color = brick,
                          .specular = strong,
                          .alpha = alphas[a],
                          .eta = 1,
                          .kind = MATERIAL_PLASTIC};
        at_all_cosines(f, &m);
    }
}

static inline void at_all_glasses(visit f)
{
    for (size_t e = 0; e < COUNT(etas); e++)
        for (size_t a = 0; a < COUNT(alphas); a++) {
            struct bsdf m = {.color = {0.9f, 0.8f, 0.7f},
                             .alpha = alphas[a],
                             .eta = etas[e],
                             .kind = MATERIAL_GLASS};

            at_all_cosines(f, &m);
        }
}

/* Rough sheets of glass. */
static inline void at_all_sheets(visit f, struct vec3 color)
{
    const float indices[] = {1, 1.5f, 2.4f, 1 / 1.33f};

    for (size_t e = 0; e < COUNT(indices); e++)
        for (size_t a = 0; a < COUNT(alphas); a++) {
            struct bsdf m = {.color = color,
                             .alpha = alphas[a],
                             .eta = indices[e],
                             .kind = MATERIAL_THIN_GLASS};

            at_all_cosines(f, &m);
        }
}

/* Returns a mixture with random parameters. Each of its lobes is absent, or
 * there is nothing else, once in four mixtures. */
static inline struct bsdf random_mixture(uint64_t *seed)
{
    float x[8];
    struct bsdf m = {.color = brick,
                     .specular = {0.04f, 0.04f, 0.04f},
                     .kind = MATERIAL_PRINCIPLED};

    for (int i = 0; i < 8; i++)
        x[i] = (float)check_random(seed);
    for (int i = 0; i < 3; i++) /* the weights */
        x[i] = x[i] < 0.25f ? 0 : x[i] > 0.75f ? 1 : 2 * x[i] - 0.5f;
    m.metalness = x[0];
    m.transmission = x[1];
    m.coat = x[2];
    m.alpha = x[3] < 0.2f ? 0 : 0.005f + x[3] * x[3];
    m.coat_alpha = x[4] < 0.5f ? 0 : 0.005f + (x[4] - 0.5f) * x[4];
    m.eta = x[5] < 0.5f ? 1.2f + x[6] : 1 / (1.2f + x[6]);
    m.specular = v3_scale(m.specular, 4 * x[7]);
    m.is_thin = x[3] * 10 - floorf(x[3] * 10) < 0.4f;
    if (m.is_thin != 0)
        m.eta = f_max(m.eta, 1 / m.eta);
    if (x[6] < 0.4f)
        m.anisotropy = 2.5f * x[6];
    if (x[7] < 0.4f) {
        m.sheen = v3_scale(white, 2.5f * x[7]);
        m.sheen_alpha =
            SHEEN_ALPHA_MIN + (1 - SHEEN_ALPHA_MIN) * (1 - x[4] * x[4]);
    }
    if (x[6] > 0.6f) {
        m.film = 2.5f * x[6] - 1.5f;
        m.film_ior = 1.2f + x[7];
        m.film_thickness = 1000 * x[5];
    }
    return m;
}

static inline void at_mixtures(visit f)
{
    uint64_t seed = 11;

    for (int i = 0; i < 40; i++) {
        struct bsdf m = random_mixture(&seed);

        f(&m, cosines[i % (int)COUNT(cosines)]);
        f(&m, 0.6f);
    }
}

/* Translucent surfaces of each kind: of little transmission, of half, and
 * without reflection. */
static inline void at_all_translucents(visit f, struct vec3 front,
                                       struct vec3 back)
{
    const float weights[] = {0.2f, 0.5f, 1};
    const uint32_t kinds[] = {MATERIAL_DIFFUSE, MATERIAL_ROUGH_DIFFUSE,
                              MATERIAL_PLASTIC, MATERIAL_PLASTIC};
    const float widths[] = {0, 0.5f, 0, 0.3f};

    for (size_t w = 0; w < COUNT(weights); w++)
        for (size_t k = 0; k < COUNT(kinds); k++) {
            struct bsdf m = {.color = front,
                             .specular = {0.04f, 0.04f, 0.04f},
                             .alpha = widths[k],
                             .eta = 1,
                             .kind = kinds[k],
                             .back_color = back,
                             .translucency = weights[w]};

            at_all_cosines(f, &m);
        }
}

/* Returns a mixture with random parameters and a translucent base, which is no
 * solid. */
static inline struct bsdf random_translucent_mixture(uint64_t *seed)
{
    struct bsdf m = random_mixture(seed);

    if (m.is_thin == 0)
        m.transmission = 0;
    m.back_color = gold;
    m.translucency = (float)check_random(seed);
    return m;
}

/* Seen along the normal, a grain would not be as symmetric as tests assume. */
static inline void at_translucent_mixtures(visit f)
{
    uint64_t seed = 12;

    for (int i = 0; i < 20; i++) {
        struct bsdf m = random_translucent_mixture(&seed);

        f(&m, cosines[1 + i % 4]);
        f(&m, 0.6f);
    }
}

static inline struct vec3 direction(float cosine)
{
    return v3(sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
}

/* Returns the mean weight of samples over the midpoints of side x side squares.
 * Multiples of the golden ratio choose the lobe. */
static inline struct vec3 sampled_albedo_from(const struct bsdf *m,
                                              struct vec3 wo, int side)
{
    double sum[3] = {0};

    for (int i = 0; i < side * side; i++) {
        struct vec2 u = v2((float)((i % side + 0.5) / side),
                           (float)((i / side + 0.5) / side));
        float choice = (float)fmod(i * 0.618033988749895, 1);
        struct bsdf_sample s;

        if (!bsdf_sample(m, wo, u, choice, &s))
            continue;
        sum[0] += (double)s.weight.x;
        sum[1] += (double)s.weight.y;
        sum[2] += (double)s.weight.z;
    }
    return v3((float)(sum[0] / side / side), (float)(sum[1] / side / side),
              (float)(sum[2] / side / side));
}

/* The same from direction(mu). */
static inline struct vec3 sampled_albedo(const struct bsdf *m, float mu,
                                         int side)
{
    return sampled_albedo_from(m, direction(mu), side);
}

/* Integrates f over the upper hemisphere, seen from direction(mu), by midpoints
 * in azimuth and in the root of the cosine. */
static inline double hemisphere_integral(
    double (*f)(const void *context, struct vec3 wo, struct vec3 wi),
    const void *context, float mu, int side)
{
    double sum = 0;

    for (int i = 0; i < side * side; i++) {
        double t = (i % side + 0.5) / side;
        double phi = M_PI * (i / side + 0.5) / side;
        double r = sqrt(1 - pow(t, 4));
        struct vec3 wi =
            v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)(t * t));

        sum += f(context, direction(mu), wi) * 4 * M_PI * t;
    }
    return sum / side / side;
}

#endif
