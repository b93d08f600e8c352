// SPDX-License-Identifier: MIT
/*
 * roulette.h - how long paths live, and which shadow rays are worth their time
 *
 * Survival by the square root of the throughput, from the second vertex on:
 * the throughput itself ends paths too early where light comes from walls.
 * A shadow ray for much less light than the path has gathered already is traced
 * so rarely that it then brings a good part of that: the noise it adds is lost
 * beside that of the path, and 2 to 10 % of the time are won.
 *
 * Units:     probabilities
 */
#ifndef KERNELS_ROULETTE_H
#define KERNELS_ROULETTE_H

#include "kernels/vec.h"

/* With which probability a path goes on that counts beta after this vertex, the
 * first of which is 1. 0: never, also where beta is no number. Without
 * branches, as vertices come in no order that could be foreseen. */
static inline float roulette_survival(struct vec3 beta, uint32_t vertex)
{
    float q = sqrtf(v3_max_component(beta));
    float is_first = (float)((uint32_t)(vertex == 1) & (uint32_t)(q > 0.0f));

    return f_max(f_min(1.0f, q), is_first);
}

/* With which probability a shadow ray is traced that would add `light` to a
 * path that has gathered `sum`. 1 or more: surely. */
static inline float roulette_shadow_survival(struct vec3 light, struct vec3 sum)
{
    return v3_max_component(light) / (0.25f * v3_max_component(sum));
}

#endif
