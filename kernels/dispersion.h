// SPDX-License-Identifier: MIT
/*
 * dispersion.h - glass whose refractive index changes with the wavelength
 *
 * A path has no wavelength until it meets the first dispersive face. One is
 * drawn there, with the responses of the channels mixed by the throughput as
 * the density, and the throughput of each channel is multiplied by its response
 * over this density: the mean over all wavelengths is 1 in every channel, and
 * the sum of the channels stays the same. All further faces have the index at
 * this wavelength. Responses are those of response_tables.h.
 *
 * Units:     wavelengths in nanometres; 0: the path has none yet
 */
#ifndef KERNELS_DISPERSION_H
#define KERNELS_DISPERSION_H

#include "kernels/response_tables.h"
#include "kernels/surface_point.h"

/* Refractive index at a wavelength, as KHR_materials_dispersion of glTF has it:
 * Cauchy's equation through the index and the Abbe number of the d line. */
static inline float ior_at(GLOBAL const struct material *m, float wavelength)
{
    float change = 523655.0f / (wavelength * wavelength) - 1.5168f;

    return f_max(m->ior + m->dispersion * change, 1.0f);
}

static inline struct vec3 response_node(uint32_t i)
{
    return v3(response_nodes[3 * i], response_nodes[3 * i + 1],
              response_nodes[3 * i + 2]);
}

/* Share of the mixture of the channels up to a node. */
static inline float response_share(struct vec3 mixture, uint32_t i)
{
    return v3_dot(mixture,
                  v3(response_shares[3 * i], response_shares[3 * i + 1],
                     response_shares[3 * i + 2]));
}

/* Index of the node before the share u of the mixture. */
static inline uint32_t response_find(struct vec3 mixture, float u)
{
    uint32_t found = 0;

    for (uint32_t step = 64; step > 0; step /= 2)
        if (found + step < RESPONSE_NODES - 1 &&
            response_share(mixture, found + step) <= u)
            found += step;
    return found;
}

/* Draws the wavelength of light with this weight, which becomes that of the
 * wavelength. */
static inline float wavelength_draw(struct vec3 *weight, float u)
{
    float sum = weight->x + weight->y + weight->z;
    struct vec3 mixture = v3(weight->x / sum, weight->y / sum, weight->z / sum);
    uint32_t i = response_find(mixture, u);
    struct vec3 low = response_node(i), high = response_node(i + 1);
    float a = v3_dot(mixture, low), slope = v3_dot(mixture, high) - a;
    float left = (u - response_share(mixture, i)) * (float)(RESPONSE_NODES - 1);
    /* the density is linear between nodes, and its integral a parabola */
    float root = sqrtf(f_max(a * a + 2.0f * slope * left, 0.0f));
    float x = f_min(2.0f * left / (a + root), 1.0f);
    float density = a + slope * x;

    if (density > 0.0f)
        *weight =
            v3_scale(v3_mul(mixture, v3_lerp(low, high, x)), sum / density);
    return WAVELENGTH_MIN + WAVELENGTH_STEP * ((float)i + x);
}

/* Gives a BSDF of a dispersive material the index at a wavelength. */
static inline void bsdf_disperse(GLOBAL const struct material *m,
                                 const struct surface_point *v,
                                 float wavelength, struct bsdf *b)
{
    b->eta = eta_at(b, v, ior_at(m, wavelength));
}

#endif
