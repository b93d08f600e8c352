// SPDX-License-Identifier: MIT
/*
 * fuzz_grid.h - checks of grids that come from files
 *
 * Threads:   one
 * Errors:    abort(), with a line that names the failure
 */
#ifndef TESTS_FUZZ_GRID_H
#define TESTS_FUZZ_GRID_H

#include <math.h>

#include "fuzz.h"
#include "scene/voxel_grid.h"

/* Checks points of a place of the box, which the number selects: values are
 * finite and no interpolated one exceeds the majorant of its place. */
static inline void fuzz_check_place(const struct voxel_grid *grid,
                                    uint64_t place)
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

/* Checks that all places have bricks, and a hundred of them. */
static inline void fuzz_check_grid(const struct voxel_grid *grid)
{
    uint64_t places = voxel_grid_place_count(grid);

    for (uint64_t i = 0; i < places; i++)
        require(grid->index[i] < grid->brick_count, "an index");
    for (uint64_t i = 0; i < places; i += 1 + places / 100)
        fuzz_check_place(grid, i);
}

#endif
