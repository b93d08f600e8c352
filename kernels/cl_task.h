// SPDX-License-Identifier: MIT
/*
 * cl_task.h - the part of a pass that is given to a device at once
 *
 * A pass visits the points of a grid of pixels, row by row. A task is a range
 * of these points. It has `samples` paths for each point, some of which may be
 * unused.
 *
 * Units:     pixels
 */
#ifndef KERNELS_CL_TASK_H
#define KERNELS_CL_TASK_H

#include "kernels/dialect.h"

struct task {
    uint64_t target; /* samples after the pass, of each pixel or the mean */
    uint64_t first_sample; /* index of the first sample of each pixel */
    uint32_t samples;      /* paths for a point */
    uint32_t first;        /* first point */
    uint32_t count;        /* number of points */
    uint32_t columns;      /* points in a row of the grid */
    uint32_t stride;       /* distance of neighbouring points, along x and y */
    uint32_t width;        /* width of the film */
    uint32_t x0;           /* the film's corner in the picture */
    uint32_t y0;
    uint32_t has_shares;   /* 1: pixels have shares: sample_share.h */
    uint32_t light_pixels; /* of the film, that get light of light paths; 0:
                              none */
};

/* Coordinates and index in the film of the task's point i. */
static inline uint32_t task_x(struct task t, uint32_t i)
{
    return (t.first + i) % t.columns * t.stride;
}

static inline uint32_t task_y(struct task t, uint32_t i)
{
    return (t.first + i) / t.columns * t.stride;
}

static inline uint64_t task_pixel(struct task t, uint32_t i)
{
    return (uint64_t)task_y(t, i) * t.width + task_x(t, i);
}

#endif
