// SPDX-License-Identifier: MIT
/*
 * guide.h - the table of directions that caustics come from
 *
 * Photons leave the lights for the glass and the mirrors alone (the projection
 * maps of Jensen 1996, "Global illumination using photon maps"), go through,
 * and are counted on the two next diffuse surfaces: the caustic, and what it
 * lights. The table only says where to look, kernels/guide.h weighs what is
 * found: that few photons make it, and that it has no textures, costs time and
 * no truth.
 *
 * A function of the scene alone. Measured for a glass ball and a gold one: 20
 * ms and .66 times the error.
 *
 * Units:     normalised scene units
 * Ownership: guide_free() frees; a zeroed struct is a scene without a table
 * Threads:   one thread builds; read only after
 * Errors:    memory
 */
#ifndef GLIM_GUIDE_H
#define GLIM_GUIDE_H

#include "glim/util.h"
#include "kernels/types.h"

struct guide {
    struct guide_grid grid;
    uint32_t *cells; /* as kernels/guide.h reads them */
    float *sums;
};

/* Reads all of a world's arrays but the sky; it has its lights. There is no
 * table where nothing shines or casts caustics, nor for scenes so large that it
 * would keep the first picture waiting. */
bool guide_build(struct guide *guide, const struct world *world,
                 struct error *err);

/* Lends the table to the world. */
void guide_lend(const struct guide *guide, struct world *world);

void guide_free(struct guide *guide);

#endif
