// SPDX-License-Identifier: MIT
/*
 * image_psd.h - the picture of all layers in files of Adobe Photoshop: red,
 * green and blue of 8 or 16 bits, with alpha if there is a fourth channel
 *
 * stb_image converts negative colours to bytes, which C leaves undefined, where
 * alpha was not mixed with white, and takes packed values of 16 bits for bytes.
 *
 * Source:    Adobe Photoshop File Formats Specification, November 2019
 * Units:     pixels, row 0 at the top; values are sRGB
 * Ownership: image_psd_decode() returns memory for free()
 * Threads:   any
 * Errors:    other kinds of pixels, missing pixels
 */
#ifndef GLIM_IMAGE_PSD_H
#define GLIM_IMAGE_PSD_H

#include <stdbool.h>

#include "image/image_read.h"

bool image_psd_is(const struct image_file *file);

/* Finds sides, channels, the largest value and the offset of the pixels. */
bool image_psd_header(struct image_file *file, struct error *err);

/* Returns 4 bytes per pixel, or NULL and the error. */
uint8_t *image_psd_decode(const struct image_file *file, struct error *err);

#endif
