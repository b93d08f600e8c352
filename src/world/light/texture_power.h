// SPDX-License-Identifier: MIT
/*
 * texture_power.h - mean radiance of a textured emitter, for each triangle
 *
 * A summed-area table of the texels (Crow 1984) has the mean over any rectangle
 * of the repeating image. A triangle is covered by bands of such rectangles,
 * with a margin, so that its mean is above 0 if any texel that it shows is.
 *
 * Units:     texture coordinates; radiance, as the mean of the channels
 * Ownership: texture_power_free() frees; accepts a zeroed struct
 * Threads:   one thread makes it; read only after
 * Errors:    memory
 */
#ifndef GLIM_TEXTURE_POWER_H
#define GLIM_TEXTURE_POWER_H

#include "base/error.h"
#include "kernels/types.h"

struct texture_power_sums {
    double *sums; /* over texels above and left: (width + 1)(height + 1) */
    uint32_t width, height;
};

/* Sums up the radiance of a material, which has an emission texture. */
bool texture_power_init(struct texture_power_sums *f, const struct world *w,
                        const struct material *m, struct error *err);

/* Returns the mean over the whole image. */
double texture_power_whole(const struct texture_power_sums *footprint);

/* Returns the mean over a triangle with these texture coordinates. */
double texture_power_mean(const struct texture_power_sums *f,
                          const struct vec2 uv[3]);

void texture_power_free(struct texture_power_sums *f);

#endif
