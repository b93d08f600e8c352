// SPDX-License-Identifier: MIT
/*
 * image_pnm.h - grey and coloured images of the PNM formats: P2, P3, P5, P6
 *
 * Units:     pixels, row 0 at the top; values are sRGB
 * Ownership: image_pnm_decode() returns memory for free()
 * Threads:   any
 * Errors:    a malformed header, malformed or missing pixels
 */
#ifndef GLIM_IMAGE_PNM_H
#define GLIM_IMAGE_PNM_H

#include <stdbool.h>

#include "picture/image_read.h"

bool image_pnm_is(const struct image_file *file);

/* Finds sides, channels, the largest value and the offset of the pixels. */
bool image_pnm_header(struct image_file *file, struct error *err);

/* Returns 4 bytes per pixel, or NULL and the error. */
uint8_t *image_pnm_decode(const struct image_file *file, struct error *err);

#endif
