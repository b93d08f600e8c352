// SPDX-License-Identifier: MIT
/*
 * OpenVDB files. A grid has finite values, and no interpolated value exceeds
 * the majorant of its place.
 */
#include <math.h>

#include "fuzz.h"
#include "read/vdb.h"

/* Checks points of a place of the box, which the number selects. */
static void check_place(const struct voxel_grid *grid, uint64_t place)
{
    const uint32_t *n = grid->sides;
    const double first[3] = {grid->origin[0] +
                                 8. * (double)(place / n[2] / n[1]),
                             grid->origin[1] +
                                 8. * (double)(place / n[2] % n[1]),
                             grid->origin[2] + 8. * (double)(place % n[2])};

    for (int i = 0; i < 64; i++) {
        const double p[3] = {first[0] + i % 4 * 2.625,
                             first[1] + i / 4 % 4 * 2.5,
                             first[2] + i / 16 * 2.65625};
        float value = voxel_grid_sample(grid, p);

        require(isfinite(value), "a value");
        require(value <= grid->majorants[place], "a majorant");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error err = {""};
    struct voxel_grid grid;

    if (vdb_parse(&grid, data, size, NULL, &err)) {
        uint64_t places = voxel_grid_place_count(&grid);

        for (uint64_t i = 0; i < places; i++)
            require(grid.index[i] < grid.brick_count, "an index");
        for (uint64_t i = 0; i < places; i += 1 + places / 100)
            check_place(&grid, i);
    } else {
        fuzz_check_message(err.text);
    }
    voxel_grid_free(&grid);
    return 0;
}
