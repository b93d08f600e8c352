// SPDX-License-Identifier: MIT
/*
 * clear_buffers.cl - empties the film, one work-item a pixel
 */
#include "kernels/sum.h"

__kernel void clear_buffers(ulong pixel_count, __global struct sum *sums,
                            __global ulong *counts)
{
    ulong pixel = get_global_id(0);

    if (pixel >= pixel_count)
        return;
    for (uint c = 0; c < 3; c++)
        sums[3 * pixel + c].lo = sums[3 * pixel + c].hi = 0;
    counts[pixel] = 0;
}
