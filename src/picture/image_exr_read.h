// SPDX-License-Identifier: MIT
/*
 * image_exr_read.h - reads OpenEXR files of one part of scan lines
 *
 * The channels R, G and B, or Y, are read, of halves, floats or integers;
 * others are skipped. Lines are not compressed, or by RLE, ZIPS or ZIP.
 *
 * Units:     pixels, row 0 at the top; linear floats
 * Ownership: image_exr_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed or truncated file, other kinds of OpenEXR
 */
#ifndef GLIM_IMAGE_EXR_READ_H
#define GLIM_IMAGE_EXR_READ_H

#include <stdbool.h>

#include "picture/image_read.h"

bool image_exr_is(const struct image_file *file);

/* Finds the sides and the memory of the decoder. */
bool image_exr_header(struct image_file *file, struct error *err);

/* Returns 3 floats per pixel, or NULL and the error. */
float *image_exr_decode(const struct image_file *file, struct error *err);

#endif
