// SPDX-License-Identifier: MIT
/*
 * daylight.h - colour and brightness of the clear sky and of the sun
 *
 * The model is that of A. J. Preetham, P. Shirley and B. Smits, "A Practical
 * Analytic Model for Daylight", SIGGRAPH 1999. It covers the sky above the
 * horizon while the sun is there. Below 2 the turbidity makes its zenith too
 * dark.
 *
 * Units:     linear Rec.709 radiance, of which 1 is DAYLIGHT_UNIT candela per
 *            square metre; degrees, radians
 * Threads:   any
 */
#ifndef GLIM_DAYLIGHT_H
#define GLIM_DAYLIGHT_H

/* Luminance of radiance 1. A white floor under the sun at noon has about 1. */
#define DAYLIGHT_UNIT 30000.0

/* Angle from the centre of the sun's disc to its edge. */
#define SUN_RADIUS_DEG 0.2665

/* Range of the turbidity, the haze of the air, in which the model has positive
 * values: 2 is a clear day, 6 a hazy one. */
#define TURBIDITY_LEAST    1.7
#define TURBIDITY_GREATEST 10.0
#define TURBIDITY_DEFAULT  3.0

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

#endif
