// SPDX-License-Identifier: MIT
/*
 * guide_grid.h - the path guide's grid over the scene, and flux found in it
 *
 * The grid divides the box around the scene into cubes, of GUIDE_FACINGS cells
 * each. A guide_flux has one kind of light, such as the open sky, that a search
 * has found in the cells. path_guide.c makes the table of directions of it.
 *
 * Units:     normalised scene units; flux in any unit, as only ratios count
 * Ownership: guide_flux_free() frees; a zeroed struct has not been searched for
 * Threads:   one thread fills; read only after
 * Errors:    guide_flux_init() returns false when memory is out
 */
#ifndef GLIM_GUIDE_GRID_H
#define GLIM_GUIDE_GRID_H

#include <stdbool.h>

#include "kernels/types.h"

struct guide_flux {
    float *flux; /* of each cell: GUIDE_BINS, by direction of arrival */
    float *rest; /* of each cell: the light of other kinds, in the same unit */
};

/* Lays the grid over all triangles, of which there is at least one. Returns the
 * surface area of the box around them. *overlap, unless NULL, becomes the
 * number of instances whose boxes a ray through the box around all instances
 * meets on average: the sum of their areas by its area. */
double guide_grid_init(struct guide_grid *grid, const struct world *world,
                       double *overlap);

static inline uint32_t guide_cell_count(const struct guide_grid *g)
{
    return g->width * g->height * g->depth * GUIDE_FACINGS;
}

/* Allocates the arrays for the cells of a grid, all 0. */
bool guide_flux_init(struct guide_flux *flux, const struct guide_grid *grid);
void guide_flux_free(struct guide_flux *flux);

/* Returns the flux that arrives in a cell from all directions. */
double guide_flux_total(const struct guide_flux *flux, uint32_t cell);

/* Returns which share of a cell's light this flux is, from 0 to 1. total is
 * guide_flux_total(), `other` is light that `rest` does not have. */
double guide_flux_share(const struct guide_flux *flux, uint32_t cell,
                        double total, double other);

/* Adds a cell's distribution over the bins, scaled to end at `share`, to the
 * GUIDE_BINS numbers of a cdf. */
void guide_flux_add_cdf(const struct guide_flux *flux, uint32_t cell,
                        double total, double share, float *cdf);

#endif
