// SPDX-License-Identifier: MIT
/*
 * image_header.h - headers of the image files that stb_image decodes
 *
 * stb_image takes memory for all pixels that a header promises before it looks
 * for them, and fills up with zeros what is missing in BMP and TGA files. Here
 * a file has to be long enough for its pixels first.
 *
 * Units:     pixels, bytes
 * Threads:   any
 * Errors:    no such image, sides beyond the limits, a file that is too short
 */
#ifndef GLIM_IMAGE_HEADER_H
#define GLIM_IMAGE_HEADER_H

#include <stdbool.h>

#include "picture/image_read.h"

/* Finds kind, sides and decoder_bytes of a PNG, JPEG, BMP or TGA file. */
bool image_header(struct image_file *file, struct error *err);

/* Compares the sides that were found with the limits. */
bool image_expect_limits(const struct image_file *file, struct error *err);

#endif
