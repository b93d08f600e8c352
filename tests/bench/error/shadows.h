// SPDX-License-Identifier: MIT
/*
 * shadows.h - turns off roulette of shadow rays: every light gets one
 *
 * Units:     probabilities
 */
#ifndef ERROR_SHADOWS_H
#define ERROR_SHADOWS_H

#include "kernels/roulette.h"

static inline float always(struct vec3 light, struct vec3 sum)
{
    (void)light;
    (void)sum;
    return 1.0f;
}

#define roulette_shadow_survival always

#endif
