// SPDX-License-Identifier: MIT
/*
 * light_cells.h - cells of space with light: what light paths bring to matte
 * surfaces that the eye sees through glass and in mirrors, and what matte
 * surfaces reflect
 *
 * kernels/light_cells.h and kernels/radiance_cells.h look them up. Deposits are
 * kept in the order of the threads, and sorted by cell, path and vertex before
 * they are summed, so that threads do not change bits.
 *
 * Units:     normalised scene units
 * Ownership: light_cells_free() frees; a zeroed struct has no cells
 * Threads:   light_cells_add() and light_cells_estimate() by the threads of a
 *            pool, each with its number; other functions by one
 * Errors:    memory, by false
 */
#ifndef GLIM_LIGHT_CELLS_H
#define GLIM_LIGHT_CELLS_H

#include "base/thread_pool.h"
#include "kernels/path_types.h"

/* Light of a path at a vertex. */
struct light_deposit {
    uint64_t key; /* of its cell */
    uint32_t path, vertex;
    struct vec3 light; /* flux, or an estimate of radiance by color */
    struct vec3 d;     /* to where flux came from */
};

struct light_deposits {
    struct light_deposit *items;
    size_t count, capacity;
    bool is_cut; /* memory was out */
};

struct light_cells {
    struct light_grid grids[CELL_GRIDS];
    struct light_cell *cells; /* slots of all grids */
    size_t slot_count;
    struct light_deposits *lists; /* of each thread and grid */
    int thread_count;
};

/* Makes empty grids for the world's camera, for a block of samples whose first
 * is `begin`: the later, the finer, and each at another place. Radiance cells
 * are `wider` times as wide as those of pictures. */
bool light_cells_begin(struct light_cells *cells, const struct world *world,
                       uint64_t begin, double wider, const struct pool *pool);

/* Adds light at a point of a surface, whose unit normal ng is on its side. The
 * deposit has all but its cell. */
void light_cells_add(struct light_cells *cells, int thread, int half,
                     struct vec3 p, struct vec3 ng,
                     const struct light_deposit *deposit);

/* Adds the estimates of a path to the radiance cells of a half. */
void light_cells_estimate(struct light_cells *cells, int thread, int half,
                          uint32_t path,
                          const struct cell_estimates *estimates);

/* Sums the cells, for the flux of this number of light paths of each half.
 * Returns false after a cancel, too. */
bool light_cells_end(struct light_cells *cells, uint64_t path_count,
                     struct pool *pool, const struct cancel *cancel);

void light_cells_free(struct light_cells *cells);

#endif
