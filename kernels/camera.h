// SPDX-License-Identifier: MIT
/*
 * camera.h - pinhole camera
 *
 * Units:     pixels; (0, 0) is the top left corner of the picture
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef KERNELS_CAMERA_H
#define KERNELS_CAMERA_H

#include "kernels/vec.h"

/* The ray through point (offset.x, offset.y) of pixel (x, y), offsets in
 * [0, 1): a box filter of one pixel when they are uniform. */
static inline struct ray camera_ray(struct camera c, uint32_t x, uint32_t y,
                                    struct vec2 offset)
{
    float sx = 2.0f * (((float)x + offset.x) / c.width) - 1.0f;
    float sy = 1.0f - 2.0f * (((float)y + offset.y) / c.height);
    struct vec3 d =
        v3_add(v3_add(c.forward, v3_scale(c.right, sx)), v3_scale(c.up, sy));
    struct ray r = {c.eye, v3_unit(d), FLOAT_MAX, 0};

    return r;
}

#endif
