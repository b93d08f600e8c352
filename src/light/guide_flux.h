// SPDX-License-Identifier: MIT
/*
 * guide_flux.h - what one kind of light would add to the table of directions
 *
 * Units:     flux and rest in one unit, any: only their ratio counts
 * Ownership: guide_flux_free() frees; a zeroed struct is one that was not made
 * Threads:   one thread makes it; read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_GUIDE_FLUX_H
#define GLIM_GUIDE_FLUX_H

#include <stdbool.h>

#include "kernels/types.h"

struct guide_flux {
    float *flux; /* that comes from each of the GUIDE_BINS of each cell */
    float *rest; /* of each cell: what other light it has */
};

static inline uint32_t guide_cell_count(const struct guide_grid *g)
{
    return g->width * g->height * g->depth * GUIDE_FACINGS;
}

bool guide_flux_init(struct guide_flux *part, const struct guide_grid *g);
void guide_flux_free(struct guide_flux *part);

/* What comes to a cell from all directions. */
double guide_flux_total(const struct guide_flux *part, uint32_t cell);

#endif
