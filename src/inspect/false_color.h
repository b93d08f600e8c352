// SPDX-License-Identifier: MIT
/*
 * false_color.h - colours for normals, uvs, depths, materials and counts, and a
 * picture of the error of each pixel
 *
 * Colours of errors are those of false_color_heat() on a logarithmic scale with
 * fixed ends, so that maps of any renders can be compared.
 *
 * Units:     numbers as in enum sample_kind; errors as film_error_map() has
 *            them: 0.01 is 1 %; colours as 0xRRGGBB in sRGB
 * Threads:   any; the film may be in use
 * Errors:    unknown errors, files, memory
 */
#ifndef GLIM_FALSE_COLOR_H
#define GLIM_FALSE_COLOR_H

#include <stddef.h>
#include <stdint.h>

#include "film/film.h"
#include "kernels/types.h"

/* ---- numbers ---- */

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

/* ---- errors ---- */

/*
 * Colours are those of false_color_heat() on a logarithmic scale with fixed
 * ends, so that maps of any renders can be compared.
 */

/* Error of black pixels and below, and of white ones and above. */
#define ERROR_MAP_BLACK 0.001f
#define ERROR_MAP_WHITE 1.0f

/* Errors of the colours, for legends in the format of printf(). */
#define ERROR_MAP_SCALE "black 0.1 %%, red 3, white 100 %%"

/* Returns the colour of an error as 0xrrggbb. */
uint32_t error_map_color(float error);

/* Writes the map of the film: colours as PNG; the errors themselves, in three
 * equal channels, as HDR and PFM. Fails if the error is unknown because a pixel
 * has less than two samples. */
bool error_map_write(struct film *film, float exposure, const char *path,
                     struct error *err);

#endif
