// SPDX-License-Identifier: MIT
/*
 * image.h - reads image files through stb_image
 *
 * Units:     pixels, row 0 at the top; 8-bit images are sRGB with linear
 *            alpha, float images are linear Rec.709
 * Ownership: image_free() frees the pixels
 * Threads:   any
 * Errors:    a missing, broken or too large file; the text names the file
 */
#ifndef GLIM_IMAGE_H
#define GLIM_IMAGE_H

#include "glim/util.h"

/* Neither side of an image may be longer, nor its pixels be more. */
#define IMAGE_SIDE_MAX   32768
#define IMAGE_PIXELS_MAX (256u << 20)

struct image {
    int width, height;
    uint8_t *rgba; /* 4 bytes a pixel, or NULL */
    float *rgb;    /* 3 floats a pixel, or NULL */
};

/* 8 bits a channel whatever the file has. */
bool image_read_8bit(struct image *image, const char *path, struct error *err);

/* Linear floats: HDR as it is, others decoded from sRGB. NaN is refused,
 * negative and infinite values are clamped (to 0 and to 1e30) and counted. */
bool image_read_linear(struct image *image, const char *path,
                       uint64_t *clamped_count, struct error *err);

void image_free(struct image *image);

#endif
