// SPDX-License-Identifier: MIT
/*
 * compositor.cl - adds the samples of a task to the film, one work-item a point
 */
#include "kernels/cl_task.h"
#include "kernels/pixel.h"

/* Samples of a pixel are consecutive. After the first that was cancelled none
 * is added. */
__kernel void
add_samples(struct task task, __global const struct path_sample *samples,
            __global const struct first_surface *surfaces,
            __global struct sum *sums, __global struct sum *odd_sums,
            __global struct surface_sums *surface_sums, __global ulong *counts,
            volatile __global struct tally *tally, __global const float *light)
{
    uint point = (uint)get_global_id(0);
    struct tally t = {0, 0, 0, 0, 0};
    ulong pixel;

    if (point >= task.count)
        return;
    pixel = task_pixel(task, point);
    samples += (ulong)point * task.samples;
    for (uint s = 0; s < task.samples && samples[s].rays != 0; s++) {
        struct path_sample sample = samples[s];

        if (task.light_pixels != 0) {
            ulong is_odd = (task.first_sample + counts[pixel] + s) & 1;
            ulong from = 3 * (pixel + is_odd * task.light_pixels);

            sample.radiance =
                v3_add(sample.radiance,
                       v3(light[from], light[from + 1], light[from + 2]));
        }
        if (HAS(FEATURE_FILTER) && surfaces != 0)
            surface_add(&surface_sums[pixel],
                        task.first_sample + counts[pixel] + s,
                        surfaces[(ulong)point * task.samples + s],
                        sample.radiance);
        pixel_add(&sums[3 * pixel], &odd_sums[3 * pixel], counts[pixel] + s,
                  sample, &t);
    }
    counts[pixel] += t.samples;
    atomic_add(&tally->samples, t.samples);
    atomic_add(&tally->rays, t.rays);
    if (t.non_finite != 0)
        atomic_add(&tally->non_finite, t.non_finite);
    if (t.saturated != 0)
        atomic_add(&tally->saturated, t.saturated);
    if (t.cut_paths != 0)
        atomic_add(&tally->cut_paths, t.cut_paths);
}
