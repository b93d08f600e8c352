// SPDX-License-Identifier: MIT
/*
 * image_header.h - headers of image files: their kind and their size
 *
 * stb_image allocates memory for all pixels that a header promises before it
 * reads them, and replaces missing pixels of BMP and TGA files by zeros. So
 * image_header() fails for files that are too short for their pixels.
 *
 * Units:     pixels, bytes
 * Threads:   any
 * Errors:    unknown kinds, sides beyond the limits, a file that is too short
 */
#ifndef GLIM_IMAGE_HEADER_H
#define GLIM_IMAGE_HEADER_H

#include <stdbool.h>

#include "image/image_read.h"

/* Finds kind, sides and decoder_bytes of a file. */
bool image_header(struct image_file *file, struct error *err);

/* Returns the kind of a file whose first bytes are the data, IMAGE_UNKNOWN if
 * it is no image that can be read. TGA is only what is named so. */
enum image_kind image_header_kind(const struct image_file *file);

/* Sets a side from a number of a header. Fails for one that is no count. */
bool image_take_side(const struct image_file *file, double number, int *side,
                     struct error *err);

/* Fails if the sides exceed the limits. */
bool image_expect_limits(const struct image_file *file, struct error *err);

#endif
