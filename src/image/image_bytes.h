// SPDX-License-Identifier: MIT
/*
 * image_bytes.h - numbers at offsets of an image file
 *
 * Threads:   any
 */
#ifndef GLIM_IMAGE_BYTES_H
#define GLIM_IMAGE_BYTES_H

#include "image/image_read.h"

struct bytes {
    const unsigned char *data;
    size_t size;
};

static inline struct bytes bytes_of(const struct image_file *f)
{
    return (struct bytes){(const unsigned char *)f->data, f->size_bytes};
}

/* Read numbers of 1, 2 and 4 bytes at an offset. Bytes behind the end are 0. */
static inline uint32_t byte_at(struct bytes b, size_t at)
{
    return at < b.size ? b.data[at] : 0;
}

static inline uint32_t big16(struct bytes b, size_t at)
{
    return byte_at(b, at) << 8 | byte_at(b, at + 1);
}

static inline uint32_t big32(struct bytes b, size_t at)
{
    return big16(b, at) << 16 | big16(b, at + 2);
}

static inline uint32_t little16(struct bytes b, size_t at)
{
    return byte_at(b, at) | byte_at(b, at + 1) << 8;
}

static inline uint32_t little32(struct bytes b, size_t at)
{
    return little16(b, at) | little16(b, at + 2) << 16;
}

#endif
