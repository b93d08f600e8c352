// SPDX-License-Identifier: MIT
/*
 * clear_buffers.cl - empties the film, one work-item a pixel
 */
#include "kernels/pixel.h"

__kernel void clear_buffers(ulong pixel_count, __global struct sum *sums,
                            __global struct sum *odd_sums,
                            __global struct surface_sums *surfaces,
                            __global ulong *counts)
{
    ulong pixel = get_global_id(0);

    if (pixel >= pixel_count)
        return;
    for (ulong i = 3 * pixel; i < 3 * pixel + 3; i++) {
        sums[i].lo = sums[i].hi = 0;
        odd_sums[i].lo = odd_sums[i].hi = 0;
    }
    counts[pixel] = 0;
    if (surfaces != 0)
        surface_clear(&surfaces[pixel]);
}
