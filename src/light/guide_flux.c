// SPDX-License-Identifier: MIT
#include "light/guide_flux.h"

#include <stdlib.h>

#include "base/memory.h"

bool guide_flux_init(struct guide_flux *part, const struct guide_grid *g)
{
    size_t count = guide_cell_count(g);

    part->flux = alloc_array(count * GUIDE_BINS, sizeof *part->flux);
    part->rest = alloc_array(count, sizeof *part->rest);
    return part->flux != NULL && part->rest != NULL;
}

double guide_flux_total(const struct guide_flux *part, uint32_t cell)
{
    double total = 0;

    for (uint32_t i = 0; i < GUIDE_BINS; i++)
        total += (double)part->flux[cell * (size_t)GUIDE_BINS + i];
    return total;
}

void guide_flux_free(struct guide_flux *part)
{
    free(part->flux);
    free(part->rest);
    *part = (struct guide_flux){NULL, NULL};
}
