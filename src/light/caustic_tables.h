// SPDX-License-Identifier: MIT
/*
 * caustic_tables.h - caustics of spheres and discs, for the path guide
 *
 * Photons find the directions that caustics come from. kernels/caustic_table.h
 * samples them.
 *
 * Units:     normalised scene units
 * Ownership: caustic_tables_free() frees; a zeroed struct has no tables
 * Threads:   one thread builds, with the threads of a pool if there is one;
 *            read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_CAUSTIC_TABLES_H
#define GLIM_CAUSTIC_TABLES_H

#include "base/thread_pool.h"
#include "bvh/bvh8.h"
#include "light/lights.h"

struct caustic_tables {
    struct guide_grid grids[2]; /* see kernels/caustic_table.h */
    uint32_t *cells;            /* NULL: there are no tables */
    struct caustic_group *groups;
    struct caustic_bin *bins;
    uint32_t cell_count;
    uint32_t group_count;
    uint32_t bin_count;
};

/* Replaces the tables by those of a world, which has triangles. */
bool caustic_tables_build(struct caustic_tables *tables,
                          const struct bvh8_world *w,
                          const struct lights *lights, struct pool *pool);

/* Lends the tables to the world. */
void caustic_tables_lend(const struct caustic_tables *tables,
                         struct world *world);

void caustic_tables_free(struct caustic_tables *tables);

#endif
