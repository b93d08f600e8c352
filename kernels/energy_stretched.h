// SPDX-License-Identifier: MIT
/*
 * energy_stretched.h - directional albedos of facets with two widths
 *
 * The albedo also depends on the azimuth of the direction. Its tables have the
 * roughness, the stretch, the width of the facets in the plane of the direction
 * and the cosine as axes. They are within 0.6 % of the loss, and within 1 % of
 * Schlick's part; 0.04 % and 0.1 % in the mean. Directions are unit vectors.
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

/* Returns the width of the facets in the plane of direction w and the normal,
 * in units of alpha. It is that along y if w is the normal. */
static inline float stretched_width(struct vec3 w, float stretch)
{
    float x2 = w.x * w.x;
    float r2 = x2 + w.y * w.y;
    float share = r2 > 1e-20f ? x2 / r2 : 0.0f;
    float s2 = stretch * stretch;

    return sqrtf(s2 * share + (1.0f - share) / s2);
}

/* Axis of the azimuth: 0 where the width is that along y, 1 along x. stretch is
 * above 1. */
static inline float energy_axis_width(float width, float stretch)
{
    return (width - 1.0f / stretch) / (stretch - 1.0f / stretch);
}

/* Mean square of the two widths, in units of alpha. */
static inline float stretched_mean_square(float stretch)
{
    float s2 = stretch * stretch;

    return 0.5f * (s2 + 1.0f / s2);
}

/* Scale of the loss, which is that of isotropic facets with the width in the
 * plane of w near the horizon, and with the mean width near the normal. */
static inline float stretched_loss_scale(float mu, float alpha, float width,
                                         float stretch)
{
    float square = width * width * (1.0f - mu * mu) +
                   stretched_mean_square(stretch) * mu * mu;

    return ggx_loss_scale(mu, alpha * sqrtf(square));
}

/* ggx_albedo() of facets whose stretch is above 1. */
static inline struct ggx_albedo stretched_albedo(struct vec3 w, struct ggx g)
{
    float width = stretched_width(w, g.stretch);
    struct cubic_nodes a =
        cubic_nodes_around(energy_axis_alpha(g.alpha), STRETCHED_ALPHA_NODES);
    struct cubic_nodes s = cubic_nodes_around(energy_axis_stretch(g.stretch),
                                              STRETCHED_STRETCH_NODES);
    struct cubic_nodes p =
        cubic_nodes_around(energy_axis_width(width, g.stretch),
                           STRETCHED_WIDTH_NODES);
    struct cubic_nodes m =
        cubic_nodes_around(energy_axis_mu(w.z, g.alpha * width),
                           STRETCHED_MU_NODES);
    float loss = 0.0f, shift = 0.0f;

    for (uint32_t i = 0; i < 64; i++) {
        uint32_t plane =
            (a.first + i / 16) * STRETCHED_STRETCH_NODES + s.first + i / 4 % 4;
        uint32_t k = (plane * STRETCHED_WIDTH_NODES + p.first + i % 4) *
                         STRETCHED_MU_NODES +
                     m.first;
        float weight = a.w[i / 16] * s.w[i / 4 % 4] * p.w[i % 4];

        for (uint32_t j = 0; j < 4; j++) {
            loss += weight * m.w[j] * (float)stretched_losses[k + j];
            shift += weight * m.w[j] * (float)stretched_shifts[k + j];
        }
    }
    loss *= STRETCHED_LOSS_UNIT *
            stretched_loss_scale(w.z, g.alpha, width, g.stretch);
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

#endif
