// SPDX-License-Identifier: MIT
/*
 * blackbody.h - the colour of a black body by its temperature
 *
 * Units:     kelvin; XYZ of the CIE 1931 observer, linear Rec.709; luminance 1
 * Threads:   any
 */
#ifndef GLIM_BLACKBODY_H
#define GLIM_BLACKBODY_H

/* Range of temperatures. Below it nothing glows visibly; above it the colour
 * hardly changes. */
#define BLACKBODY_LEAST    1.0
#define BLACKBODY_GREATEST 1e9

/* Sets XYZ with Y = 1. kelvin is in the range above. */
void blackbody_xyz(double kelvin, double xyz[3]);

/* Sets linear Rec.709 without negative channels. Below about 1900 K the colour
 * is outside the gamut and is moved towards white of the same luminance. */
void blackbody_rgb(double kelvin, double rgb[3]);

#endif
