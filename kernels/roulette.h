// SPDX-License-Identifier: MIT
/*
 * roulette.h - how long paths live
 *
 * Survival by the square root of the throughput, from the second vertex on:
 * the throughput itself ends paths too early where light comes from walls.
 *
 * Units:     probabilities
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef KERNELS_ROULETTE_H
#define KERNELS_ROULETTE_H

#include "kernels/vec.h"

/* With which probability a path goes on that counts beta after this vertex, the
 * first of which is 1. 1 or more: surely; 0 or NaN: never. */
static inline float survival(struct vec3 beta, uint32_t vertex)
{
    float q = sqrtf(v3_max(beta));

    return vertex == 1 && q > 0.0f ? 1.0f : q;
}

#endif
