// SPDX-License-Identifier: MIT
/*
 * image_read.h - reads image files: PNG, JPEG, BMP and TGA through stb_image,
 * WebP through libwebp, PNM, GIF, PSD, PFM, OpenEXR and Radiance HDR by our
 * own code
 *
 * image_open() reads the header and finds the number of pixels and the memory
 * that they take. It fails if the file is too short for them or if there is not
 * enough memory. image_decode() then reads the pixels.
 *
 * Units:     pixels, row 0 at the top; 8-bit images are sRGB with linear
 *            alpha, float images are linear Rec.709
 * Ownership: image_close() frees the file, image_free() the pixels; paths stay
 *            the caller's
 * Threads:   any
 * Errors:    a missing, broken or too large file; the text names the file
 */
#ifndef GLIM_IMAGE_READ_H
#define GLIM_IMAGE_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/file.h"

/* Limits on each side of an image and on its pixels. */
#define IMAGE_SIDE_MAX   65536
#define IMAGE_PIXELS_MAX (256u << 20)

enum image_kind {
    IMAGE_UNKNOWN,
    IMAGE_PNG,
    IMAGE_JPEG,
    IMAGE_BMP,
    IMAGE_TGA,
    IMAGE_PSD,
    IMAGE_PNM,
    IMAGE_GIF,
    IMAGE_WEBP,
    IMAGE_HDR,
    IMAGE_PFM,
    IMAGE_EXR,
};

enum image_form {
    IMAGE_8BIT,   /* 4 bytes per pixel for every file */
    IMAGE_LINEAR, /* 3 floats per pixel, decoded from sRGB for 8-bit files */
};

/* Image file in memory, with the contents of its header. */
struct image_file {
    const char *path;
    char *data;
    size_t size_bytes;
    enum image_kind kind;
    int width, height;

    /* PFM and PSD */
    size_t pixels_at; /* offset in the data */
    int channels;
    uint32_t value_max; /* of PSD */
    bool is_big_endian;

    size_t decoder_bytes; /* peak memory of stb_image, pixels included */

    enum image_form form;
    uint64_t memory_bytes; /* peak memory of reading, file included */
    bool is_beyond;        /* true if there was not enough memory for it */
};

struct image {
    int width, height;
    uint8_t *rgba; /* 4 bytes per pixel, or NULL */
    float *rgb;    /* 3 floats per pixel, or NULL */
};

/* Reads the file and its header. All images of a scene may take three quarters
 * of the memory that cgroup_quota_memory() finds; held_bytes of it are in use.
 */
bool image_open(struct image_file *file, const char *path, enum image_form form,
                uint64_t held_bytes, struct error *err);

/* The same for bytes of a file, which are copied. */
bool image_open_bytes(struct image_file *file, const struct file_bytes *from,
                      enum image_form form, uint64_t held_bytes,
                      struct error *err);

/* Reads the pixels in the form that the file was opened for, and closes the
 * file. NaN is an error. Negative and infinite floats are clamped to 0 and to
 * 1e30, and counted. */
bool image_decode(struct image_file *file, struct image *image,
                  uint64_t *clamped_count, struct error *err);

void image_close(struct image_file *file);

void image_free(struct image *image);

#endif
