// SPDX-License-Identifier: MIT
/*
 * image_pfm.h - PFM files: floats, in colour or grey
 *
 * Units:     pixels, row 0 at the top; linear floats
 * Ownership: image_pfm_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed header, missing pixels
 */
#ifndef GLIM_IMAGE_PFM_H
#define GLIM_IMAGE_PFM_H

#include <stdbool.h>

#include "image/image_read.h"

bool image_pfm_is(const struct image_file *file);

/* Finds the sides and the offset of the pixels. */
bool image_pfm_header(struct image_file *file, struct error *err);

/* Returns 3 floats per pixel, or NULL and the error. */
float *image_pfm_decode(const struct image_file *file, struct error *err);

#endif
