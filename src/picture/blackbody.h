// SPDX-License-Identifier: MIT
/*
 * blackbody.h - the colour of a body that glows by its temperature
 *
 * Units:     kelvin; XYZ of the CIE 1931 observer, linear Rec.709; luminance 1
 * Threads:   any
 */
#ifndef GLIM_BLACKBODY_H
#define GLIM_BLACKBODY_H

/* Below it nothing glows; above it the colour does not change any more. */
#define BLACKBODY_LEAST    1.0
#define BLACKBODY_GREATEST 1e9

/* kelvin within these bounds; XYZ with Y = 1. */
void blackbody_xyz(double kelvin, double xyz[3]);

/* No channel is negative: below some 1900 K the colour lies outside the gamut
 * and is moved towards white of the same luminance. */
void blackbody_rgb(double kelvin, double rgb[3]);

#endif
