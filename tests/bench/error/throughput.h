// SPDX-License-Identifier: MIT
/*
 * throughput.h - replaces roulette by a plain one: paths survive with the
 * probability of their throughput, from the first vertex on
 *
 * Units:     probabilities
 */
#ifndef ERROR_THROUGHPUT_H
#define ERROR_THROUGHPUT_H

#include "kernels/roulette.h"

static inline float throughput(struct vec3 beta, uint32_t vertex)
{
    (void)vertex;
    return v3_max_component(beta);
}

#define roulette_survival throughput

#endif
