// SPDX-License-Identifier: MIT
/*
 * sixel.h - pixels as the bytes of DEC's sixel graphics
 *
 * Each image defines the colours that it uses, since only some terminals keep
 * colour registers from one image to the next.
 *
 * Units:     pixels, bytes
 * Ownership: the buffer is the caller's
 * Threads:   any
 */
#ifndef GLIM_SIXEL_H
#define GLIM_SIXEL_H

#include <stddef.h>
#include <stdint.h>

#include "terminal/dither.h"

/* Widest image in pixels. */
#define SIXEL_WIDTH_MAX 512

/* Image of numbers of colours, row 0 at the top. */
struct sixel_image {
    int width, height;
    const struct rgb *colors;
    const uint8_t *numbers;
};

/* Most bytes that sixel_encode() writes. */
size_t sixel_bytes_max(int width, int height);

/* Encodes an image, which appears with its corner in the cursor's cell. Returns
 * the number of bytes. */
size_t sixel_encode(const struct sixel_image *image, char *bytes);

#endif
