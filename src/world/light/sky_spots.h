// SPDX-License-Identifier: MIT
/*
 * sky_spots.h - what is much brighter than the rest of a sky's image, such as
 * the sun, as a source of light paths
 *
 * Radiance is divided at a level: light paths bring what exceeds it, and paths
 * from the eye the rest (kernels/sky.h, sky_below()).
 *
 * Units:     radiance; densities per solid angle
 * Ownership: sky_spots_free() frees; a zeroed struct has no spots
 * Threads:   one thread builds; read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_SKY_SPOTS_H
#define GLIM_SKY_SPOTS_H

#include "world/light/triangle_cdf.h"

struct sky_spots {
    struct triangle_cdf texels; /* by a bound of what exceeds the level */
    float level;  /* mean of the channels; infinite if there are no spots */
    double power; /* irradiance of a face that looks at all of them, about */
};

/* Finds the spots of a sky whose image has this mean radiance. */
bool sky_spots_build(struct sky_spots *spots, const struct world *w,
                     double mean);

/* Samples a direction by `choice` and u. Returns what exceeds the level there,
 * divided by the density. The world has the table of its sky. */
struct vec3 sky_spots_sample(const struct sky_spots *spots,
                             const struct world *w, float choice, struct vec2 u,
                             struct vec3 *direction);

void sky_spots_free(struct sky_spots *spots);

#endif
