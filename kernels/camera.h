// SPDX-License-Identifier: MIT
/*
 * camera.h - camera rays of a pinhole and of a thin lens
 *
 * Units:     pixels; (0, 0) is the top left corner of the picture
 */
#ifndef KERNELS_CAMERA_H
#define KERNELS_CAMERA_H

#include "kernels/sample.h"

/* The pinhole ray through point (offset.x, offset.y) of pixel (x, y). Offsets
 * are in [0, 1); uniform ones are a box filter of one pixel. */
static inline struct ray camera_ray(struct camera c, uint32_t x, uint32_t y,
                                    struct vec2 offset)
{
    float sx = 2.0f * (((float)x + offset.x + c.left) / c.width) - 1.0f;
    float sy = 1.0f - 2.0f * (((float)y + offset.y + c.top) / c.height);
    struct vec3 d =
        v3_add(v3_add(c.forward, v3_scale(c.right, sx)), v3_scale(c.up, sy));
    struct ray r = {c.eye, v3_unit(d), FLOAT_MAX, 0, 0};

    return r;
}

/* Moves the origin of the pinhole ray r to a point of the lens and aims it at
 * the same point of the focal plane. u is uniform in the square. */
static inline struct ray camera_through_lens(struct camera c, struct ray r,
                                             struct vec2 u)
{
    struct vec2 lens = disk_from_square(u);
    struct vec3 offset =
        v3_add(v3_scale(v3_unit(c.right), c.lens_radius * lens.x),
               v3_scale(v3_unit(c.up), c.lens_radius * lens.y));
    struct vec3 sharp = v3_scale(r.d, c.focus / v3_dot(r.d, c.forward));

    r.o = v3_add(r.o, offset);
    r.d = v3_unit(v3_sub(sharp, offset));
    return r;
}

#endif
