// SPDX-License-Identifier: MIT
/*
 * false_color.h - colours for numbers: normals, uvs, depths, materials, counts
 *
 * Units:     numbers as enum sample_kind has them; 0xRRGGBB as it is shown
 * Threads:   any
 */
#ifndef GLIM_FALSE_COLOR_H
#define GLIM_FALSE_COLOR_H

#include <stddef.h>

#include "kernels/types.h"

/* The least and the largest number; both 0: there is none. */
struct number_range {
    float lo, hi;
};

/* Of count numbers above 0, which lie `stride` floats apart. */
struct number_range number_range_of(const float *x, size_t count,
                                    size_t stride);

/* Normals: x red, y green, z blue, 128 for 0. UVs: u red, v green, dark grey
 * without. Depths: white for the nearest, dark grey for the farthest.
 * Materials: a colour for each. The sky is black. */
uint32_t false_color(enum sample_kind kind, const float xyz[3],
                     struct number_range range);

/* From black at 0 by violet, red and yellow to white at 1. */
uint32_t false_color_heat(float part);

#endif
