// SPDX-License-Identifier: MIT
/*
 * image_gif.h - the first picture of a GIF file, after the specification 89a
 *
 * Units:     pixels, row 0 at the top; values are sRGB
 * Ownership: image_gif_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed or truncated file
 */
#ifndef GLIM_IMAGE_GIF_H
#define GLIM_IMAGE_GIF_H

#include <stdbool.h>

#include "picture/image_read.h"

bool image_gif_is(const struct image_file *file);

/* Finds the sides of the screen on which the picture lies. */
bool image_gif_header(struct image_file *file, struct error *err);

/* Returns 4 bytes per pixel of the screen, or NULL and the error. Pixels beside
 * the picture and of its transparent colour have the alpha 0. */
uint8_t *image_gif_decode(const struct image_file *file, struct error *err);

#endif
