// SPDX-License-Identifier: MIT
/*
 * What a copy of the program sends after libblosc has read a hostile file may
 * be any bytes: they give a grid whose voxels can be read, or one line.
 */
#include <math.h>

#include "fuzz.h"
#include "read/child/vdb_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error err = {""};
    struct voxel_grid grid;

    if (vdb_stream_read(&grid, (const char *)data, size, &err)) {
        for (int i = 0; i < 64; i++)
            require(isfinite(voxel_grid_value(&grid, grid.origin[0] + 8 * i,
                                              grid.origin[1] + i,
                                              grid.origin[2])),
                    "a value");
    } else {
        fuzz_check_message(err.text);
    }
    voxel_grid_free(&grid);
    return 0;
}
