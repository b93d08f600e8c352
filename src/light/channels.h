// SPDX-License-Identifier: MIT
/*
 * channels.h - one number for light of three channels
 *
 * Units:     those of the light
 * Threads:   any
 */
#ifndef GLIM_CHANNELS_H
#define GLIM_CHANNELS_H

#include "kernels/vec.h"

/* The mean: errors of all three count alike. */
static inline double channels_mean(struct vec3 light)
{
    return ((double)light.x + (double)light.y + (double)light.z) / 3;
}

#endif
