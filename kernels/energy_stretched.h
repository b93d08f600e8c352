// SPDX-License-Identifier: MIT
/*
 * energy_stretched.h - directional albedos of facets with two widths
 *
 * The albedo also depends on the azimuth of the direction. Its table has the
 * roughness, the stretch, the width of the facets in the plane of the direction
 * and the cosine as axes. It is within 0.5 % of the loss, and within 0.6 % of
 * Schlick's part; 0.03 % in the mean. Directions are unit vectors.
 *
 * Units:     local frame, z along the normal
 */
#ifndef KERNELS_ENERGY_STRETCHED_H
#define KERNELS_ENERGY_STRETCHED_H

#include "kernels/energy.h"
#include "kernels/ggx.h"
#include "kernels/power.h"

/* 2 / log2 10: the greatest stretch is the root of 10. */
#define STRETCH_LOG_SCALE 0.602059991f

/* Axis of the stretch, the logarithm of the ratio of the widths. */
static inline float energy_axis_stretch(float stretch)
{
    return f_log2(stretch) * STRETCH_LOG_SCALE;
}

/* Returns the square of the width of the facets in the plane of direction w and
 * the normal, in units of alpha. It is that along y if w is the normal. */
static inline float stretched_width_square(struct vec3 w, float stretch)
{
    float x2 = w.x * w.x;
    float r2 = x2 + w.y * w.y;
    float share = r2 > 1e-20f ? x2 / r2 : 0.0f;
    float s2 = stretch * stretch;

    return s2 * share + (1.0f - share) / s2;
}

/* Axis of the azimuth, the logarithm of the width: 0 where it is that along y,
 * 1 along x. stretch is above 1. */
static inline float energy_axis_width(float width_square, float stretch)
{
    return 0.5f + 0.25f * f_log2(width_square) / f_log2(stretch);
}

/* Mean square of the two widths, in units of alpha. */
static inline float stretched_mean_square(float stretch)
{
    float s2 = stretch * stretch;

    return 0.5f * (s2 + 1.0f / s2);
}

/* Scale of the loss, by the mean of the two widths. It does not fall towards
 * the horizon, where the loss falls at a cosine that depends on both widths. */
static inline float stretched_loss_scale(float mu, float alpha, float stretch)
{
    float square = alpha * alpha * stretched_mean_square(stretch);
    float sum = mu + sqrtf(square);

    return square / (sum * sum);
}

/* ggx_albedo() of facets whose stretch is above 1. */
static inline struct ggx_albedo stretched_albedo(struct vec3 w, struct ggx g)
{
    float square = stretched_width_square(w, g.stretch);
    struct quadratic_nodes a =
        quadratic_nodes_around(energy_axis_alpha(g.alpha),
                               STRETCHED_ALPHA_NODES);
    struct quadratic_nodes s =
        quadratic_nodes_around(energy_axis_stretch(g.stretch),
                               STRETCHED_STRETCH_NODES);
    struct quadratic_nodes p =
        quadratic_nodes_around(energy_axis_width(square, g.stretch),
                               STRETCHED_WIDTH_NODES);
    struct cubic_nodes m =
        cubic_nodes_around(energy_axis_mu(w.z, g.alpha * sqrtf(square)),
                           STRETCHED_MU_NODES);
    uint32_t first =
        ((a.first * STRETCHED_STRETCH_NODES + s.first) * STRETCHED_WIDTH_NODES +
         p.first) *
            STRETCHED_MU_NODES +
        m.first;
    float sums[8] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    float loss = 0.0f, shift = 0.0f;

    /* compilers vectorise the inner loop; the cast to int is for gcc 12 */
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = 0; j < 3; j++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t row =
                    (i * STRETCHED_STRETCH_NODES + j) * STRETCHED_WIDTH_NODES +
                    k;
                uint32_t at = 2u * (first + row * STRETCHED_MU_NODES);
                float weight = a.w[i] * s.w[j] * p.w[k];

                for (uint32_t l = 0; l < 8; l++)
                    sums[l] += weight * (float)(int)stretched_albedos[at + l];
            }
    for (uint32_t j = 0; j < 4; j++) {
        loss += m.w[j] * sums[2 * j];
        shift += m.w[j] * sums[2 * j + 1];
    }
    loss *= STRETCHED_LOSS_UNIT * stretched_loss_scale(w.z, g.alpha, g.stretch);
    shift = shift * STRETCHED_SHIFT_UNIT - STRETCHED_SHIFT_MIN;
    return ggx_albedo_of(w.z, f_min(f_max(loss, 0.0f), 1.0f), shift);
}

/* ggx_albedo_mean() of facets whose stretch is above 1. */
static inline struct ggx_albedo stretched_albedo_mean(struct ggx g)
{
    struct cubic_nodes a =
        cubic_nodes_around(energy_axis_alpha(g.alpha), STRETCHED_MEAN_NODES);
    struct cubic_nodes s = cubic_nodes_around(energy_axis_stretch(g.stretch),
                                              STRETCHED_MEAN_STRETCH_NODES);
    struct ggx_albedo e = {0.0f, 0.0f};

    for (uint32_t i = 0; i < 16; i++) {
        uint32_t k =
            (a.first + i / 4) * STRETCHED_MEAN_STRETCH_NODES + s.first + i % 4;
        float weight = a.w[i / 4] * s.w[i % 4];

        e.loss += weight * stretched_mean_losses[k];
        e.schlick += weight * stretched_mean_schlicks[k];
    }
    e.loss *= g.alpha * g.alpha * stretched_mean_square(g.stretch);
    return e;
}

static inline bool is_stretched(struct ggx g)
{
    return HAS(FEATURE_ANISOTROPY) && g.stretch > 1.0f;
}

/* Albedos of any facets in direction w, and their hemispherical means. */
static inline struct ggx_albedo facets_albedo(struct vec3 w, struct ggx g)
{
    return is_stretched(g) ? stretched_albedo(w, g) : ggx_albedo(w.z, g.alpha);
}

static inline struct ggx_albedo facets_albedo_mean(struct ggx g)
{
    return is_stretched(g) ? stretched_albedo_mean(g)
                           : ggx_albedo_mean(g.alpha);
}

/* Albedos of the facets of a surface at wo and wi, and their mean. */
struct facet_albedos {
    struct ggx_albedo o, i, mean;
};

/* o: the albedos at wo, which callers keep for all wi. */
static inline struct facet_albedos
facet_albedos_at(struct ggx_albedo o, struct vec3 wi, struct ggx g)
{
    struct facet_albedos e = {o, facets_albedo(wi, g), facets_albedo_mean(g)};

    return e;
}

#endif
