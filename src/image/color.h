// SPDX-License-Identifier: MIT
/*
 * color.h - colours as people write them (hex, HSV, kelvins), of spectra and of
 * black bodies, and their mean
 *
 * Hex and HSV describe the encoded colour, as in every colour picker. A
 * temperature in kelvins is the colour of a black body, with a largest channel
 * of 1.
 *
 * Units:     linear Rec.709; encoded sRGB, hue 0 to 360, the rest 0 to 1; XYZ
 *            of the CIE 1931 observer; kelvins, nanometres
 * Threads:   any
 * Errors:    color_parse() returns false
 */
#ifndef GLIM_COLOR_H
#define GLIM_COLOR_H

#include <math.h>
#include <stdbool.h>

#include "kernels/vec.h"

/* ---- spectra ---- */

/* Wavelengths of a spectrum: every 10 nm from 380 to 780. */
#define OBSERVER_FIRST_NM 380
#define OBSERVER_STEP_NM  10
#define OBSERVER_COUNT    41

/* Sums the spectrum times the colour-matching functions over the wavelengths.
 * Of a radiance in W/(m2 sr nm), Y times the step times 683 lm/W is the
 * luminance. */
void observer_xyz(const double spectrum[OBSERVER_COUNT], double xyz[3]);

/* Converts to linear Rec.709 with white D65. Channels are negative outside the
 * gamut. */
void observer_rgb(const double xyz[3], double rgb[3]);

/* ---- black bodies ---- */

/* Range of temperatures. Below it nothing glows visibly; above it the colour
 * hardly changes. */
#define BLACKBODY_MIN 1.0
#define BLACKBODY_MAX 1e9

/* Returns the natural logarithm of the luminance, up to a summand that is the
 * same for all temperatures. */
double blackbody_log_luminance(double kelvin);

/* Sets XYZ with Y = 1. kelvin is in the range above. */
void blackbody_xyz(double kelvin, double xyz[3]);

/* Sets linear Rec.709 without negative channels. Below about 1900 K the colour
 * is outside the gamut and is moved towards white of the same luminance. */
void blackbody_rgb(double kelvin, double rgb[3]);

/* ---- colours as text ---- */

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
