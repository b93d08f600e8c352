// SPDX-License-Identifier: MIT
/*
 * ray_generator.cl - camera rays of a task, one work-item a path
 */
#include "kernels/camera.h"
#include "kernels/cl_task.h"
#include "kernels/sample_share.h"

__kernel void generate_rays(struct task task,
                            volatile __global const uint *cancel,
                            __global const struct settings *settings,
                            __global const ulong *counts,
                            __global const ushort *shares,
                            __global struct camera_sample *starts)
{
    uint i = (uint)get_global_id(0);
    uint point = i / task.samples;
    ulong index, target = task.target;

    if (point >= task.count || *cancel != 0)
        return;
    index = counts[task_pixel(task, point)] + i % task.samples;
    if (task.has_shares != 0)
        target = share_samples(shares[task_pixel(task, point)], target);
    if (index < target) {
        struct settings s = *settings;

        starts[i] = camera_sample_begin(&s, task.x0 + task_x(task, point),
                                        task.y0 + task_y(task, point),
                                        task.first_sample + index);
    } else {
        starts[i].ray.t_max = -1.0f; /* no path */
    }
}
