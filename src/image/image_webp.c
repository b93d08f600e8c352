// SPDX-License-Identifier: MIT
#include "image/image_webp.h"

#include <stdlib.h>
#include <string.h>
#include <webp/decode.h>

#include "base/memory.h"
#include "image/image_header.h"

/* Bytes of a pixel while it is decoded: the result, and the decoder's own rows
 * or, in lossless files, its copy with tables of codes. */
#define PIXEL_BYTES 12

static const uint8_t *bytes_of(const struct image_file *f)
{
    return (const uint8_t *)f->data;
}

const char image_webp_name[] = "WebP";

bool image_webp_is(const struct image_file *f)
{
    return f->size_bytes >= 12 && memcmp(f->data, "RIFF", 4) == 0 &&
           memcmp(f->data + 8, "WEBP", 4) == 0;
}

bool image_webp_header(struct image_file *f, struct error *err)
{
    WebPBitstreamFeatures features;

    if (WebPGetFeatures(bytes_of(f), f->size_bytes, &features) != VP8_STATUS_OK)
        return fail(err, "%s: found a broken WebP image", f->path);
    if (features.has_animation)
        return fail(err,
                    "%s: found an animation, expected a WebP image of one "
                    "picture",
                    f->path);
    f->width = features.width;
    f->height = features.height;
    f->decoder_bytes =
        PIXEL_BYTES * (size_t)features.width * (size_t)features.height;
    return image_expect_limits(f, err);
}

uint8_t *image_webp_decode(const struct image_file *f, struct error *err)
{
    size_t size_bytes = 4 * (size_t)f->width * (size_t)f->height;
    uint8_t *rgba = alloc_array(size_bytes, 1);

    if (rgba == NULL) {
        fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
             f->height);
        return NULL;
    }
    if (WebPDecodeRGBAInto(bytes_of(f), f->size_bytes, rgba, size_bytes,
                           4 * f->width) != NULL)
        return rgba;
    free(rgba);
    fail(err, "%s: found a broken WebP image", f->path);
    return NULL;
}
