// SPDX-License-Identifier: MIT
/*
 * whole_image.h - reads an image file in one step
 *
 * Ownership: image_free() frees the image
 * Errors:    those of image_open() and image_decode()
 */
#ifndef TESTS_WHOLE_IMAGE_H
#define TESTS_WHOLE_IMAGE_H

#include "image/image_read.h"

static inline bool image_read_8bit(struct image *image, const char *path,
                                   struct error *err)
{
    struct image_file f;
    uint64_t ignored;

    *image = (struct image){0};
    return image_open(&f, path, IMAGE_8BIT, 0, err) &&
           image_decode(&f, image, &ignored, err);
}

static inline bool image_read_linear(struct image *image, const char *path,
                                     uint64_t *clamped_count, struct error *err)
{
    struct image_file f;

    *image = (struct image){0};
    *clamped_count = 0;
    return image_open(&f, path, IMAGE_LINEAR, 0, err) &&
           image_decode(&f, image, clamped_count, err);
}

#endif
