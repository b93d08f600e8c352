// SPDX-License-Identifier: MIT
/*
 * cl_task.h - a part of a pass, as a device gets it
 *
 * A pass visits the points of a grid, row by row; a task is some of them in
 * a row. It has `samples` paths for each point, some of which may be empty.
 *
 * Units:     pixels
 */
#ifndef KERNELS_CL_TASK_H
#define KERNELS_CL_TASK_H

#include "kernels/dialect.h"

struct task {
    uint64_t target;  /* samples that each pixel is to have */
    uint32_t samples; /* paths for a point */
    uint32_t first;   /* its first point */
    uint32_t count;   /* its points */
    uint32_t columns; /* points in a row of the grid */
    uint32_t stride;  /* pixels from point to point, both ways */
    uint32_t width;   /* of the film */
    uint32_t x0;      /* where the film's corner is in the picture */
    uint32_t y0;
};

/* The film's pixel of the task's point i. */
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
