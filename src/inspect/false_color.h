// SPDX-License-Identifier: MIT
/*
 * false_color.h - colours for normals, uvs, depths, materials and counts
 *
 * Units:     numbers as in enum sample_kind; colours as 0xRRGGBB in sRGB
 * Threads:   any
 */
#ifndef GLIM_FALSE_COLOR_H
#define GLIM_FALSE_COLOR_H

#include <stddef.h>

#include "kernels/types.h"

/* Least and greatest number; both are 0 if there are none. */
struct number_range {
    float lo, hi;
};

/* Returns the range of the numbers above 0 among `count` numbers, which are
 * `stride` floats apart. */
struct number_range number_range_of(const float *x, size_t count,
                                    size_t stride);

/* Returns the colour of a sample. Normals: x, y, z as red, green, blue, with
 * 128 for 0. UVs: u red, v green, dark grey without. Depths: from white for the
 * nearest to dark grey for the farthest. Materials: a colour for each. The sky
 * is black. */
uint32_t false_color(enum sample_kind kind, const float xyz[3],
                     struct number_range range);

/* Returns the heat colour of a number from 0 to 1: black, violet, red, yellow,
 * white. */
uint32_t false_color_heat(float part);

/* Returns the colour of a difference from -1 to 1: light blue, blue, black,
 * red, yellow. */
uint32_t false_color_difference(float part);

#endif
