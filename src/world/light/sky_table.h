// SPDX-License-Identifier: MIT
/*
 * sky_table.h - the table by which directions to a sky image are sampled
 *
 * Each texel has a weight: the mean of its bilinear look-ups times its solid
 * angle. Where BSDF samples find the sky as well, the mean of the sky is
 * subtracted from the weights (Karlik et al. 2019, "MIS compensation"). The
 * table is then zero in places, and unbiased only together with BSDF samples.
 *
 * Units:     radiance, steradians
 * Ownership: sky_table_free() frees; a zeroed struct has no table
 * Threads:   one thread builds; read only after
 * Errors:    memory
 */
#ifndef GLIM_SKY_TABLE_H
#define GLIM_SKY_TABLE_H

#include "base/error.h"
#include "kernels/types.h"

struct sky_table {
    float *sums; /* see kernels/sky.h; NULL if the sky is not sampled */
    double mean; /* mean radiance of the image */
};

enum sky_use {
    SKY_WITH_MIS, /* compensated, for use with MIS */
    SKY_ALONE     /* above zero wherever the sky is */
};

/* Builds the table. Black skies have none, and with MIS constant skies. */
bool sky_table_build(struct sky_table *table, const struct vec3 *texels,
                     uint32_t width, uint32_t height, enum sky_use use,
                     struct error *err);

/* Lends the table to a world that has its sky and its lights, and shares the
 * light samples between lights of the tree and light from infinity. */
void sky_table_lend(const struct sky_table *table, struct world *world);

void sky_table_free(struct sky_table *table);

#endif
