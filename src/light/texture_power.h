// SPDX-License-Identifier: MIT
/*
 * texture_power.h - how much a textured emitter shines, triangle by triangle
 *
 * A table of sums over the texels (Crow 1984) gives the mean over any
 * rectangle of the repeating image at once; a triangle is covered by bands of
 * such rectangles, never too tightly, so that its mean is above 0 if a texel
 * that it shows is.
 *
 * Units:     texture coordinates; radiance, the mean of the channels
 * Ownership: texture_power_free() frees; accepts a zeroed struct
 * Threads:   one thread makes it; read only after
 * Errors:    memory
 */
#ifndef GLIM_TEXTURE_POWER_H
#define GLIM_TEXTURE_POWER_H

#include "base/error.h"
#include "kernels/types.h"

struct texture_power_sums {
    double *sums; /* over the texels above and left: (width + 1)(height + 1) */
    uint32_t width, height;
};

/* The radiance of the material, which has an emission texture. */
bool texture_power_init(struct texture_power_sums *f, const struct world *w,
                        const struct material *m, struct error *err);

/* The mean over the whole image. */
double texture_power_whole(const struct texture_power_sums *footprint);

/* Over the triangle with these corners. */
double texture_power_mean(const struct texture_power_sums *f,
                          const struct vec2 uv[3]);

void texture_power_free(struct texture_power_sums *f);

#endif
