// SPDX-License-Identifier: MIT
/*
 * OpenVDB files. A grid has finite values, and no interpolated value exceeds
 * the majorant of its place.
 */
#include "fuzz_grid.h"
#include "mutate_vdb.h"
#include "read/vdb.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error err = {""};
    struct voxel_grid grid;

    if (vdb_parse(&grid, data, size, NULL, &err))
        fuzz_check_grid(&grid);
    else
        fuzz_check_message(err.text);
    voxel_grid_free(&grid);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    struct mutation m = mutation_begin(data, size, max, seed);

    mutation_vdb(&m);
    return m.size;
}
