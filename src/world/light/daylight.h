// SPDX-License-Identifier: MIT
/*
 * daylight.h - colour and brightness of the clear sky and of the sun, and the
 * lat-long image of the sky
 *
 * The model is that of A. J. Preetham, P. Shirley and B. Smits, "A Practical
 * Analytic Model for Daylight", SIGGRAPH 1999. It covers the sky above the
 * horizon while the sun is there. Below 2 the turbidity makes its zenith too
 * dark.
 *
 * Units:     linear Rec.709 radiance, of which 1 is DAYLIGHT_UNIT candela per
 *            square metre; degrees, radians
 * Ownership: the caller frees the texels
 * Threads:   any; images are made on the pool
 * Errors:    memory
 */
#ifndef GLIM_DAYLIGHT_H
#define GLIM_DAYLIGHT_H

#include "base/error.h"
#include "base/thread_pool.h"
#include "kernels/types.h"

/* ---- model ---- */

/* Luminance of radiance 1. A white floor under the sun at noon has about 1. */
#define DAYLIGHT_UNIT 30000.0

/* Angle from the centre of the sun's disc to its edge. */
#define SUN_RADIUS_DEG 0.2665

/* Range of the turbidity, the haze of the air, in which the model has positive
 * values: 2 is a clear day, 6 a hazy one. */
#define TURBIDITY_MIN     1.7
#define TURBIDITY_MAX     10.0
#define TURBIDITY_DEFAULT 3.0

/* Sky of one elevation of the sun. */
struct daylight {
    double perez[3][5]; /* coefficients A to E for Y, x and y */
    /* Y as radiance, x and y at the zenith, over Perez's formula there */
    double zenith[3];
};

/* Sets the sky for a sun above the horizon. */
void daylight_init(struct daylight *d, double sun_elevation_deg,
                   double turbidity);

/* Perez's formula gives Y, x and y relative to each other. It is a product: one
 * factor depends on the angle from the zenith, whose cosine is above 0, the
 * other on the angle from the sun. */
double daylight_height(const struct daylight *d, int channel,
                       double zenith_cos);
double daylight_glow(const struct daylight *d, int channel, double gamma_cos,
                     double gamma_rad);

/* Sets the radiance of the sky, by the factors of the height for Y, x and y. */
void daylight_sky(const struct daylight *d, const double heights[3],
                  double gamma_cos, double rgb[3]);

/* Sets the radiance of the sun's disc, seen through the air at this elevation
 * above the horizon. */
void daylight_sun(double elevation_deg, double turbidity, double rgb[3]);

/* ---- image ---- */

/*
 * The sun stands above the middle column, above -z; the rotation of the sky
 * turns it. The image is without its disc, which is a directional light. Below
 * the horizon is a ground that reflects GROUND_ALBEDO of the light of sun and
 * sky. While the sun is not above the horizon, everything is black.
 */

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
