// SPDX-License-Identifier: MIT
/*
 * camera.h - camera rays of a pinhole and of a thin lens, and the beginning of
 * a sample: its sampler and its camera ray
 *
 * Units:     pixels, (0, 0) is the top left corner of the picture; normalised
 *            scene units
 */
#ifndef KERNELS_CAMERA_H
#define KERNELS_CAMERA_H

#include "kernels/rng.h"
#include "kernels/sample.h"

/* ---- rays ---- */

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

/* ---- samples ---- */

struct camera_sample {
    struct ray ray;
    struct sampler sampler;
    uint32_t half_number; /* of the pixel's samples: 1 if the index is odd */
};

/* The sampler of sample `index` of pixel (x, y) of the whole picture. */
static inline struct sampler
camera_sampler(const struct settings *s, uint32_t x, uint32_t y, uint64_t index)
{
    if (s->order == ORDER_DRAFT)
        return sampler_start_draft(x, y, (uint32_t)index, s->seed);
    if (s->order == ORDER_DRAFT_HALVES)
        return sampler_start_draft_half(x, y, (uint32_t)index, s->seed);
    return sampler_start_half(x, y, index, s->seed);
}

/* The camera ray of a sample, through `point` of pixel (x, y). For AOVs it goes
 * through the middle of the pixel. */
static inline struct ray camera_sample_ray(const struct settings *s, uint32_t x,
                                           uint32_t y, struct vec2 point,
                                           struct sampler sampler)
{
    struct ray r;

    if (s->sample != SAMPLE_LIGHT)
        return camera_ray(s->camera, x, y, v2(0.5f, 0.5f));
    r = camera_ray(s->camera, x, y, point);
    if (s->camera.lens_radius > 0.0f)
        r = camera_through_lens(s->camera, r,
                                random_2d(sampler, DIMENSION_LENS));
    return r;
}

static inline struct camera_sample camera_sample_begin(const struct settings *s,
                                                       uint32_t x, uint32_t y,
                                                       uint64_t index)
{
    struct camera_sample start;

    start.sampler = camera_sampler(s, x, y, index);
    start.ray =
        camera_sample_ray(s, x, y, random_2d(start.sampler, DIMENSION_PIXEL),
                          start.sampler);
    start.half_number = (uint32_t)index & 1u;
    return start;
}

#endif
