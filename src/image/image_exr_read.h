// SPDX-License-Identifier: MIT
/*
 * image_exr_read.h - reads OpenEXR files through the library OpenEXRCore
 *
 * The channels R, G and B, or Y, of the first part are read, of lines or tiles
 * (the largest level) with any compression; others are skipped. Programs built
 * without the library have image_exr_read_none.c, for which no file is OpenEXR.
 *
 * Units:     pixels, row 0 at the top; linear floats
 * Ownership: image_exr_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed or truncated file, deep pixels, other channels
 */
#ifndef GLIM_IMAGE_EXR_READ_H
#define GLIM_IMAGE_EXR_READ_H

#include <stdbool.h>

#include "image/image_read.h"

/* The name of the kind in messages; empty without the library. */
extern const char image_exr_name[];

bool image_exr_is(const struct image_file *file);

/* Finds the sides and the memory of the decoder. */
bool image_exr_header(struct image_file *file, struct error *err);

/* Returns 3 floats per pixel, or NULL and the error. */
float *image_exr_decode(const struct image_file *file, struct error *err);

#endif
