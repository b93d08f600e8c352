// SPDX-License-Identifier: MIT
/*
 * start.h - how a sample begins: its random numbers and its camera ray
 *
 * Units:     pixels; normalised scene units
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef KERNELS_START_H
#define KERNELS_START_H

#include "kernels/camera.h"
#include "kernels/rng.h"

struct path_start {
    struct ray ray;
    struct sampler sampler;
};

/* Sample `index` of pixel (x, y) of the whole picture. */
static inline struct path_start path_begin(const struct settings *s, uint32_t x,
                                           uint32_t y, uint64_t index)
{
    struct path_start start;

    start.sampler = s->order == ORDER_DRAFT
                        ? sampler_start_draft(x, y, (uint32_t)index, s->seed)
                        : sampler_start(x, y, index, s->seed);
    start.ray =
        camera_ray(s->camera, x, y, random_2d(start.sampler, DIMENSION_PIXEL));
    if (s->camera.lens_radius > 0.0f)
        start.ray =
            camera_through_lens(s->camera, start.ray,
                                random_2d(start.sampler, DIMENSION_LENS));
    return start;
}

#endif
