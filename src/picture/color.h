// SPDX-License-Identifier: MIT
/*
 * color.h - colours as people write them (hex, HSV, kelvins), and their mean
 *
 * Hex and HSV describe the encoded colour, as in every colour picker. A
 * temperature in kelvins is the colour of a black body, with a largest channel
 * of 1.
 *
 * Units:     linear Rec.709; encoded sRGB, hue 0 to 360, the rest 0 to 1
 * Threads:   any
 * Errors:    color_parse() returns false
 */
#ifndef GLIM_COLOR_H
#define GLIM_COLOR_H

#include <math.h>
#include <stdbool.h>

#include "kernels/vec.h"

/* Returns the mean of the channels, which stands for a colour where errors of
 * all three channels count alike. */
static inline double color_mean(struct vec3 color)
{
    return ((double)color.x + (double)color.y + (double)color.z) / 3;
}

/* Returns the largest channel. */
static inline double color_largest(const double rgb[3])
{
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

/* Decode and encode a channel by the sRGB curve (IEC 61966-2-1). */
double color_decoded(double encoded);
double color_encoded(double linear);

void color_to_hsv(const double rgb[3], double hsv[3]);
void color_from_hsv(const double hsv[3], double rgb[3]);

/* Writes "#rrggbb"; channels are clamped to 1. */
#define COLOR_HEX_BYTES 8
void color_to_hex(const double rgb[3], char text[COLOR_HEX_BYTES]);

/* Reads "#rrggbb", "#rgb", "3000K" or three linear numbers. Sets *kelvin to 0
 * if the text is not a temperature. Returns false for any other text. */
bool color_parse(const char *text, double rgb[3], double *kelvin);

#endif
