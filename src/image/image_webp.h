// SPDX-License-Identifier: MIT
/*
 * image_webp.h - WebP files through libwebp
 *
 * Programs built without libwebp have image_webp_none.c, to which no file is
 * one.
 *
 * Units:     pixels, row 0 at the top; values are sRGB
 * Ownership: image_webp_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed or truncated file, an animation
 */
#ifndef GLIM_IMAGE_WEBP_H
#define GLIM_IMAGE_WEBP_H

#include <stdbool.h>

#include "image/image_read.h"

/* The name of the kind in messages; empty without libwebp. */
extern const char image_webp_name[];

bool image_webp_is(const struct image_file *file);

/* Finds the sides and the memory of the decoder. */
bool image_webp_header(struct image_file *file, struct error *err);

/* Returns 4 bytes per pixel, or NULL and the error. */
uint8_t *image_webp_decode(const struct image_file *file, struct error *err);

#endif
