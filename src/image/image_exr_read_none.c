// SPDX-License-Identifier: MIT
#include "image/image_exr_read.h"

const char image_exr_name[] = "";

bool image_exr_is(const struct image_file *f)
{
    (void)f;
    return false;
}

bool image_exr_header(struct image_file *f, struct error *err)
{
    return fail(err, "%s: found OpenEXR, which this build does not read",
                f->path);
}

float *image_exr_decode(const struct image_file *f, struct error *err)
{
    fail(err, "%s: found OpenEXR, which this build does not read", f->path);
    return NULL;
}
