// SPDX-License-Identifier: MIT
/*
 * observer.h - colours of spectra: the CIE 1931 observer and Rec.709
 *
 * Units:     nanometres; XYZ, linear Rec.709
 * Threads:   any
 */
#ifndef GLIM_OBSERVER_H
#define GLIM_OBSERVER_H

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

#endif
