// SPDX-License-Identifier: MIT
/*
 * sun_sky.h - the lat-long image of a clear sky with the sun
 *
 * The sun stands in the middle column, above -z; the rotation of the sky turns
 * it. Each texel has the sun times the part of it that the disc covers, scaled
 * so that the disc's light does not depend on the resolution. Below the horizon
 * is a ground that reflects GROUND_ALBEDO of the light of sun and sky. While
 * the sun is not above the horizon, everything is black.
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

/* Size of the image: texels of 0.18 degrees, three of them across the sun. Its
 * edge is blurred by one. */
#define SUN_SKY_WIDTH  2048
#define SUN_SKY_HEIGHT 1024

/* Reflectance of the ground: that of grass and soil. */
#define GROUND_ALBEDO 0.2

/* Returns width * height texels, where width is 2 height and height is even;
 * NULL when memory is out. Without a pool the caller's thread does the work. */
struct vec3 *sun_sky_create(uint32_t width, uint32_t height,
                            double sun_elevation_deg, double turbidity,
                            struct pool *pool, struct error *err);

#endif
