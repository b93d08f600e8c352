// SPDX-License-Identifier: MIT
/*
 * sky_table.h - the table by which directions to a sky's image are drawn
 *
 * One number for each texel: what the bilinear look-up shows of it on average,
 * times its solid angle. Where rays find the sky by chance as well, only what
 * exceeds the sky's mean is left to the table (Karlik et al. 2019, "MIS
 * compensation"): it is then zero in places, right only together with such
 * rays.
 *
 * Units:     radiance, steradians
 * Ownership: sky_table_free() frees; a zeroed struct is a sky without a table
 * Threads:   one thread builds; read only after
 * Errors:    memory
 */
#ifndef GLIM_SKY_TABLE_H
#define GLIM_SKY_TABLE_H

#include "base/error.h"
#include "kernels/types.h"

struct sky_table {
    float *sums; /* as kernels/sky.h reads them; NULL: nothing to sample */
    double mean; /* radiance of the image */
};

enum sky_use {
    SKY_WITH_MIS, /* compensated: for next-event estimation with MIS */
    SKY_ALONE     /* nowhere zero where the sky shines */
};

/* No table for black and, with chance, constant skies. */
bool sky_table_build(struct sky_table *table, const struct vec3 *texels,
                     uint32_t width, uint32_t height, enum sky_use use,
                     struct error *err);

/* Lends the table to a world that has its sky and its lights, and lets both
 * share the samples. */
void sky_table_lend(const struct sky_table *table, struct world *world);

void sky_table_free(struct sky_table *table);

#endif
