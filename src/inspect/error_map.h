// SPDX-License-Identifier: MIT
/*
 * error_map.h - a picture of the error of each pixel
 *
 * Colours are those of false_color_heat() on a logarithmic scale with fixed
 * ends, so that maps of any renders can be compared.
 *
 * Units:     errors as film_error_map() has them: 0.01 is 1 %
 * Threads:   any; the film may be in use
 * Errors:    unknown errors, files, memory
 */
#ifndef GLIM_ERROR_MAP_H
#define GLIM_ERROR_MAP_H

#include <stdint.h>

#include "film/film.h"

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
