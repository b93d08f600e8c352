// SPDX-License-Identifier: MIT
/*
 * NumPy files. A grid has finite values, and no interpolated value exceeds the
 * majorant of its place. Nothing behind the bytes is read.
 */
#include "fuzz_grid.h"
#include "read/npy.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error err = {""};
    struct voxel_grid grid;
    char *bytes = malloc(size + (size == 0));

    require(bytes != NULL, "memory");
    if (size > 0)
        memcpy(bytes, data, size);
    if (npy_parse(&grid, bytes, size, &err)) {
        require(npy_matches(bytes, size), "a beginning");
        fuzz_check_grid(&grid);
    } else {
        fuzz_check_message(err.text);
    }
    voxel_grid_free(&grid);
    free(bytes);
    return 0;
}
