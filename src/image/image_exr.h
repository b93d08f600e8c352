// SPDX-License-Identifier: MIT
/*
 * image_exr.h - writes OpenEXR files of one part with any number of layers
 *
 * Files are scan lines of 32-bit floats, compressed without loss (ZIP, 16
 * lines a block), as OpenEXR 2 and later read them.
 *
 * Units:     pixels, row 0 at the top; values are not changed
 * Ownership: image_exr_encode() returns memory for free()
 * Threads:   any
 * Errors:    out of memory
 */
#ifndef GLIM_IMAGE_EXR_H
#define GLIM_IMAGE_EXR_H

#include <stddef.h>
#include <stdint.h>

#include "image/image_metadata.h"

/* Channels of a pixel whose names are the prefix and one letter each. */
struct exr_layer {
    const char *prefix;  /* empty or with a dot at its end: "albedo." */
    const char *letters; /* of up to 3 channels: "RGB" */
    const float *values; /* 3 floats a pixel, of which the first are used */
};

/* Channels of a file at most. */
#define EXR_CHANNELS_MAX 32

/* Returns the bytes of a file with these layers, whose channels have different
 * names, and sets their number; NULL if memory is out. The texts of the
 * metadata, which may be NULL, become attributes. */
uint8_t *image_exr_encode(const struct exr_layer *layers, int layer_count,
                          int width, int height,
                          const struct image_metadata *metadata,
                          size_t *size_bytes);

#endif
