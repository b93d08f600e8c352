// SPDX-License-Identifier: MIT
/*
 * camera_sample.h - the beginning of a sample: its sampler and its camera ray
 *
 * Units:     pixels; normalised scene units
 */
#ifndef KERNELS_CAMERA_SAMPLE_H
#define KERNELS_CAMERA_SAMPLE_H

#include "kernels/camera.h"
#include "kernels/rng.h"

struct camera_sample {
    struct ray ray;
    struct sampler sampler;
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
    return start;
}

#endif
