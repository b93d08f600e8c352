// SPDX-License-Identifier: MIT
#include "image/image_webp.h"

const char image_webp_name[] = "";

bool image_webp_is(const struct image_file *f)
{
    (void)f;
    return false;
}

bool image_webp_header(struct image_file *f, struct error *err)
{
    return fail(err, "%s: found WebP, which this build does not read", f->path);
}

uint8_t *image_webp_decode(const struct image_file *f, struct error *err)
{
    fail(err, "%s: found WebP, which this build does not read", f->path);
    return NULL;
}
