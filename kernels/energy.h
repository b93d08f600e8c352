// SPDX-License-Identifier: MIT
/*
 * energy.h - directional albedos of GGX surfaces for single scattering
 *
 * Multiple scattering between microfacets is computed from what they lack of 1.
 * The tables (`make tables`) are interpolated with cubics: linear tables of
 * 16^3 miss the albedo of rough glass by 2 %, of 24^2 x 31 by 1 %. These are
 * within 0.3 % (within 1 % seen from inside glass of an index below 1.1, where
 * most light is lost).
 *
 * Units:     mu: cosine to the normal, in [0, 1]; alpha from ALPHA_SMOOTH on
 */
#ifndef KERNELS_ENERGY_H
#define KERNELS_ENERGY_H

#include "kernels/energy_tables.h"
#include "kernels/vec.h"

/* sqrt(ALPHA_SMOOTH) */
#define ROOT_SMOOTH 0.0223606798f

/* Four neighbouring nodes along an axis of a table, with their weights. */
struct cubic_nodes {
    uint32_t first;
    float w[4];
};

/* Weights of Lagrange's cubic through the nodes around t, in [0, 1] along the
 * axis. */
static inline struct cubic_nodes cubic_nodes_around(float t, uint32_t count)
{
    float x = f_min(f_max(t, 0.0f), 1.0f) * (float)(count - 1u);
    float first = f_min(f_max(floorf(x) - 1.0f, 0.0f), (float)(count - 4u));
    float a = x - first;
    float b = a - 1.0f;
    float c = a - 2.0f;
    float d = a - 3.0f;
    struct cubic_nodes n;

    n.first = (uint32_t)first;
    n.w[0] = b * c * d * (-1.0f / 6.0f);
    n.w[1] = a * c * d * 0.5f;
    n.w[2] = a * b * d * -0.5f;
    n.w[3] = a * b * c * (1.0f / 6.0f);
    return n;
}

/* Three neighbouring nodes, likewise. */
struct quadratic_nodes {
    uint32_t first;
    float w[3];
};

/* Weights of Lagrange's parabola through the nodes nearest to t. */
static inline struct quadratic_nodes quadratic_nodes_around(float t,
                                                            uint32_t count)
{
    float x = f_min(f_max(t, 0.0f), 1.0f) * (float)(count - 1u);
    float first = f_min(f_max(floorf(x - 0.5f), 0.0f), (float)(count - 3u));
    float a = x - first;
    float b = a - 1.0f;
    float c = a - 2.0f;
    struct quadratic_nodes n;

    n.first = (uint32_t)first;
    n.w[0] = b * c * 0.5f;
    n.w[1] = -a * c;
    n.w[2] = a * b * 0.5f;
    return n;
}

/* Axis of mu. Albedos change fast for mu below about alpha, and for glass
 * around the critical angle: the axis is dense in both. */
static inline float energy_axis_mu(float mu, float alpha)
{
    float near = sqrtf(mu * (1.0f + alpha) / (mu + alpha));

    return mu + 0.7f * (near - mu);
}

static inline float energy_axis_alpha(float alpha)
{
    return (sqrtf(alpha) - ROOT_SMOOTH) / (1.0f - ROOT_SMOOTH);
}

/* Axis of all refractive indices: 0 and 1 at the ends, 1/2 at eta 1, and dense
 * around that. */
static inline float energy_axis_eta(float eta)
{
    float g = (eta - 1.0f) / (eta + 1.0f);
    float s = sqrtf(fabsf(g));

    return 0.5f + 0.5f * (g < 0.0f ? -s : s);
}

/* Scale of the loss, which falls by powers of ten where alpha is small. The
 * table holds the ratio to it. */
static inline float ggx_loss_scale(float mu, float alpha)
{
    float s = mu + alpha;

    return mu * alpha * alpha / (s * s * s);
}

/* Albedos of a reflecting surface. loss: 1 - albedo when every facet reflects
 * all light; schlick: albedo when a facet reflects (1 - cosine)^5. */
struct ggx_albedo {
    float loss;
    float schlick;
};

/* Returns the albedos, where visible facets have a mean cosine of about
 * mu + shift. */
static inline struct ggx_albedo ggx_albedo_of(float mu, float loss, float shift)
{
    struct ggx_albedo e;
    float c = f_max(1.0f - mu - shift, 0.0f);

    e.loss = loss;
    e.schlick = (1.0f - loss) * c * c * c * c * c;
    return e;
}

static inline struct ggx_albedo ggx_albedo(float mu, float alpha)
{
    struct cubic_nodes a =
        cubic_nodes_around(energy_axis_alpha(alpha), GGX_ALPHA_NODES);
    struct cubic_nodes m =
        cubic_nodes_around(energy_axis_mu(mu, alpha), GGX_MU_NODES);
    float loss = 0.0f, shift = 0.0f;

    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = 0; j < 4; j++) {
            uint32_t k = (a.first + i) * GGX_MU_NODES + m.first + j;
            float w = a.w[i] * m.w[j];

            loss += w * ggx_losses[k];
            shift += w * ggx_shifts[k];
        }
    return ggx_albedo_of(mu, loss * ggx_loss_scale(mu, alpha), shift);
}

/* Hemispherical means: 2 int x(mu) mu dmu of both members. */
static inline struct ggx_albedo ggx_albedo_mean(float alpha)
{
    struct cubic_nodes a =
        cubic_nodes_around(energy_axis_alpha(alpha), GGX_MEAN_NODES);
    struct ggx_albedo e = {0.0f, 0.0f};

    for (uint32_t i = 0; i < 4; i++) {
        e.loss += a.w[i] * ggx_mean_losses[a.first + i];
        e.schlick += a.w[i] * ggx_mean_schlicks[a.first + i];
    }
    e.loss *= alpha * alpha;
    return e;
}

/* Albedo of rough glass, reflection and transmission together. */
static inline float glass_albedo(float mu, float alpha, float eta)
{
    struct cubic_nodes e =
        cubic_nodes_around(energy_axis_eta(eta), GLASS_ETA_NODES);
    struct cubic_nodes a =
        cubic_nodes_around(energy_axis_alpha(alpha), GLASS_ALPHA_NODES);
    struct cubic_nodes m =
        cubic_nodes_around(energy_axis_mu(mu, alpha), GLASS_MU_NODES);
    float sum = 0.0f;

    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = 0; j < 4; j++) {
            uint32_t row = (e.first + i) * GLASS_ALPHA_NODES + a.first + j;
            uint32_t k = row * GLASS_MU_NODES + m.first;
            float along = m.w[0] * (float)glass_albedos[k] +
                          m.w[1] * (float)glass_albedos[k + 1] +
                          m.w[2] * (float)glass_albedos[k + 2] +
                          m.w[3] * (float)glass_albedos[k + 3];

            sum += e.w[i] * a.w[j] * along;
        }
    return sum * (1.0f / 65535.0f);
}

/* Least roughness of sheen. Below it single scattering would reflect more light
 * than there is at grazing angles. */
#define SHEEN_ALPHA_MIN 0.07f

/* Albedo of white sheen, within 0.4 %; within 1.5 % for mu below 0.02. */
static inline float sheen_albedo(float mu, float alpha)
{
    struct cubic_nodes a =
        cubic_nodes_around((alpha - SHEEN_ALPHA_MIN) / (1.0f - SHEEN_ALPHA_MIN),
                           SHEEN_ALPHA_NODES);
    struct cubic_nodes m = cubic_nodes_around(sqrtf(mu), SHEEN_MU_NODES);
    float sum = 0.0f;

    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = 0; j < 4; j++)
            sum += a.w[i] * m.w[j] *
                   sheen_albedos[(a.first + i) * SHEEN_MU_NODES + m.first + j];
    return f_min(f_max(sum, 0.0f), 1.0f);
}

#endif
