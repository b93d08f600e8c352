// SPDX-License-Identifier: MIT
/*
 * sun_sky.h - the irradiance of the sun, and the lat-long image of the clear
 * sky around it
 *
 * The sun stands above the middle column, above -z; the rotation of the sky
 * turns it. The image is without its disc, which is a directional light. Below
 * the horizon is a ground that reflects GROUND_ALBEDO of the light of sun and
 * sky. While the sun is not above the horizon, everything is black.
 *
 * Units:     radiance of light/daylight.h; degrees
 * Ownership: the caller frees the texels
 * Threads:   runs on the pool; any
 * Errors:    memory
 */
#ifndef GLIM_SUN_SKY_H
#define GLIM_SUN_SKY_H

#include "base/error.h"
#include "base/thread_pool.h"
#include "kernels/types.h"

/* Size of the image. The horizon needs rows, which blur it by 0.18 degrees;
 * along them the sky is smooth. */
#define SUN_SKY_WIDTH  256
#define SUN_SKY_HEIGHT 1024

/* Reflectance of the ground: that of grass and soil. */
#define GROUND_ALBEDO 0.2

/* Sets the irradiance of a surface that faces the sun. A part of the disc that
 * is below the horizon is left out. */
void sun_irradiance(double elevation_deg, double turbidity, double rgb[3]);

/* Returns width * height texels, where both are even; NULL when memory is out.
 * Without a pool the caller's thread does the work. */
struct vec3 *sun_sky_create(uint32_t width, uint32_t height,
                            double sun_elevation_deg, double turbidity,
                            struct pool *pool, struct error *err);

#endif
