// SPDX-License-Identifier: MIT
/*
 * image_float.h - Radiance HDR, PFM and OpenEXR files
 *
 * Units:     pixels, row 0 at the top; linear floats
 * Ownership: image_float_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed header, malformed or missing pixels
 */
#ifndef GLIM_IMAGE_FLOAT_H
#define GLIM_IMAGE_FLOAT_H

#include <stdbool.h>

#include "picture/image_read.h"

/* Returns the kind by the file's first bytes, or IMAGE_UNKNOWN. */
enum image_kind image_float_kind(const struct image_file *file);

/* Finds the sides and the offset of the pixels in a file of these kinds. */
bool image_float_header(struct image_file *file, struct error *err);

/* Returns 3 floats per pixel, or NULL and the error. */
float *image_float_decode(const struct image_file *file, struct error *err);

#endif
