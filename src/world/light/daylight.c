// SPDX-License-Identifier: MIT
#include "world/light/daylight.h"

#include <assert.h>
#include <math.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "image/color.h"
#include "kernels/vec.h"

/* ---- model ---- */

/* Lumens per watt at 555 nm. */
#define LUMINOUS_EFFICACY 683.002

/* Coefficients of Perez's formula, linear in the turbidity: slope and constant
 * of A to E for Y, x and y (Preetham et al., appendix A.2). */
static const double perez_of_turbidity[3][5][2] = {
    {{0.1787, -1.4630},
     {-0.3554, 0.4275},
     {-0.0227, 5.3251},
     {0.1206, -2.5771},
     {-0.0670, 0.3703}},
    {{-0.0193, -0.2592},
     {-0.0665, 0.0008},
     {-0.0004, 0.2125},
     {-0.0641, -0.8989},
     {-0.0033, 0.0452}},
    {{-0.0167, -0.2608},
     {-0.0950, 0.0092},
     {-0.0079, 0.2102},
     {-0.0441, -1.6537},
     {-0.0109, 0.0529}},
};

/* Chromaticity x and y of the zenith: rows for the square of the turbidity, the
 * turbidity and 1, columns for the cube of the sun's angle from the zenith down
 * to 1 (ibid.). */
static const double zenith_of_turbidity[2][3][4] = {
    {{0.00166, -0.00375, 0.00209, 0},
     {-0.02903, 0.06377, -0.03202, 0.00394},
     {0.11693, -0.21196, 0.06052, 0.25886}},
    {{0.00275, -0.00610, 0.00317, 0},
     {-0.04214, 0.08970, -0.04153, 0.00516},
     {0.15346, -0.26756, 0.06670, 0.26688}},
};

/* The sun and the air (ibid., table 2): radiance above the atmosphere in
 * 10 W/(m2 sr nm), and absorption by ozone and by water vapour in 1/cm, every
 * 10 nm from 380 to 750. Mixed gases absorb from 760 nm on, where the eye sees
 * almost nothing, and are left out. */
static const struct {
    double radiance, ozone, water;
} sunlight[] = {
    {1655.9, 0, 0},           {1623.37, 0, 0},         {2112.75, 0, 0},
    {2588.82, 0, 0},          {2582.91, 0, 0},         {2423.23, 0, 0},
    {2676.05, 0, 0},          {2965.83, 0.003, 0},     {3054.54, 0.006, 0},
    {3005.75, 0.009, 0},      {3066.37, 0.014, 0},     {2883.04, 0.021, 0},
    {2871.21, 0.030, 0},      {2782.5, 0.040, 0},      {2710.06, 0.048, 0},
    {2723.36, 0.063, 0},      {2636.13, 0.075, 0},     {2550.38, 0.085, 0},
    {2506.02, 0.103, 0},      {2531.16, 0.120, 0},     {2535.59, 0.120, 0},
    {2513.42, 0.115, 0},      {2463.15, 0.125, 0},     {2417.32, 0.120, 0},
    {2368.53, 0.105, 0},      {2321.21, 0.090, 0},     {2282.77, 0.079, 0},
    {2233.98, 0.067, 0},      {2197.02, 0.057, 0},     {2152.67, 0.048, 0},
    {2109.79, 0.036, 0},      {2072.83, 0.028, 0.016}, {2024.04, 0.023, 0.024},
    {1987.08, 0.018, 0.0125}, {1942.72, 0.014, 1.0},   {1907.24, 0.011, 0.87},
    {1862.89, 0.010, 0.061},  {1825.92, 0.009, 0.001},
};

#define SUNLIGHT_COUNT ((int)(sizeof sunlight / sizeof *sunlight))

static double luminance_of_zenith(double turbidity, double sun_rad)
{
    double chi = (4.0 / 9 - turbidity / 120) * (M_PI - 2 * sun_rad);
    double kilocandela =
        (4.0453 * turbidity - 4.9710) * tan(chi) - 0.2155 * turbidity + 2.4192;

    return kilocandela * 1000;
}

static double chromaticity_of_zenith(const double rows[3][4], double turbidity,
                                     double sun_rad)
{
    double sum = 0;

    for (int i = 0; i < 3; i++) {
        const double *row = rows[i];
        double cubic =
            ((row[0] * sun_rad + row[1]) * sun_rad + row[2]) * sun_rad + row[3];

        sum = sum * turbidity + cubic;
    }
    return sum;
}

double daylight_height(const struct daylight *d, int channel, double zenith_cos)
{
    const double *p = d->perez[channel];

    return 1 + p[0] * exp(p[1] / zenith_cos);
}

double daylight_glow(const struct daylight *d, int channel, double gamma_cos,
                     double gamma_rad)
{
    const double *p = d->perez[channel];

    return 1 + p[2] * exp(p[3] * gamma_rad) + p[4] * gamma_cos * gamma_cos;
}

void daylight_init(struct daylight *d, double sun_elevation_deg,
                   double turbidity)
{
    double sun_rad = angle_rad(90 - sun_elevation_deg);

    d->zenith[0] = luminance_of_zenith(turbidity, sun_rad) / DAYLIGHT_UNIT;
    for (int i = 0; i < 2; i++)
        d->zenith[1 + i] =
            chromaticity_of_zenith(zenith_of_turbidity[i], turbidity, sun_rad);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 5; k++)
            d->perez[i][k] = perez_of_turbidity[i][k][0] * turbidity +
                             perez_of_turbidity[i][k][1];
        d->zenith[i] /= daylight_height(d, i, 1) *
                        daylight_glow(d, i, cos(sun_rad), sun_rad);
    }
}

/* Converts XYZ to Rec.709 without the negative channels of colours outside the
 * gamut. */
static void clamped_rgb(const double xyz[3], double rgb[3])
{
    observer_rgb(xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] > 0 ? rgb[i] : 0;
}

void daylight_sky(const struct daylight *d, const double heights[3],
                  double gamma_cos, double rgb[3])
{
    double in_range = gamma_cos < -1 ? -1 : gamma_cos > 1 ? 1 : gamma_cos;
    double gamma_rad = acos(in_range);
    double v[3], sum;

    for (int i = 0; i < 3; i++)
        v[i] = d->zenith[i] * heights[i] *
               daylight_glow(d, i, in_range, gamma_rad);
    sum = v[0] / v[2]; /* X + Y + Z */
    clamped_rgb((const double[3]){sum * v[1], v[0], sum * (1 - v[1] - v[2])},
                rgb);
}

/* Returns the part of the light that passes the air (ibid., appendix A.1, with
 * its 0.35 cm of ozone and 2 cm of water). `mass` is the length of the way
 * through the air, 1 from the zenith. */
static double transmittance(int i, double mass, double turbidity)
{
    double um = (OBSERVER_FIRST_NM + i * OBSERVER_STEP_NM) * 1e-3;
    double aerosol = 0.04608365822050 * turbidity - 0.04586025928522;
    double water = sunlight[i].water * 2 * mass;
    double depth = 0.008735 * pow(um, -4.08) * mass +
                   aerosol * pow(um, -1.3) * mass +
                   sunlight[i].ozone * 0.35 * mass +
                   0.2385 * water / pow(1 + 20.07 * water, 0.45);

    return exp(-depth);
}

void daylight_sun(double elevation_deg, double turbidity, double rgb[3])
{
    double mass = 1 / (sin(angle_rad(elevation_deg)) +
                       0.15 * pow(3.885 + elevation_deg, -1.253));
    double spectrum[OBSERVER_COUNT] = {0};
    double xyz[3];

    for (int i = 0; i < SUNLIGHT_COUNT; i++)
        spectrum[i] =
            10 * sunlight[i].radiance * transmittance(i, mass, turbidity);
    observer_xyz(spectrum, xyz);
    for (int i = 0; i < 3; i++)
        xyz[i] *= LUMINOUS_EFFICACY * OBSERVER_STEP_NM / DAYLIGHT_UNIT;
    clamped_rgb(xyz, rgb);
}

/* ---- image ---- */

struct painter {
    struct vec3 *texels;
    uint32_t width, height;
    struct daylight sky;
    double sun_sin, sun_cos; /* of the elevation */
};

static struct vec3 *row_of(const struct painter *p, uint32_t y)
{
    return p->texels + (size_t)y * p->width;
}

/* Angle from the zenith of a place in the image, in rows. */
static double zenith_angle(const struct painter *p, double y)
{
    return y * M_PI / p->height;
}

/* Cosine of the angle between the sun and a place in the image: zenith_sin and
 * zenith_cos belong to its row, x is in columns. */
static double sun_angle_cos(const struct painter *p, double zenith_sin,
                            double zenith_cos, double x)
{
    double azimuth = (x / p->width - 0.5) * 2 * M_PI;

    return zenith_cos * p->sun_sin + zenith_sin * p->sun_cos * cos(azimuth);
}

/* Solid angle of a texel in the bilinear image: the integral of its tent, which
 * is cut off at the pole. */
static double tent_angle(const struct painter *p, uint32_t y)
{
    double step = zenith_angle(p, 1);
    double column = 2 * M_PI / p->width;

    if (y == 0)
        return column * (1 - (sin(1.5 * step) - sin(0.5 * step)) / step);
    return column * sin(zenith_angle(p, y + 0.5)) * 2 * (1 - cos(step)) / step;
}

/* Paints one row above the horizon. The halves of the sky are mirror images. */
static void paint_row(void *context, uint32_t y, int worker)
{
    const struct painter *p = context;
    struct vec3 *row = row_of(p, y);
    double angle = zenith_angle(p, y + 0.5);
    double zenith_sin = sin(angle), zenith_cos = cos(angle);
    double heights[3];

    (void)worker;
    for (int i = 0; i < 3; i++)
        heights[i] = daylight_height(&p->sky, i, zenith_cos);
    for (uint32_t x = 0; x < p->width / 2; x++) {
        struct vec3 *mirror = &row[p->width - 1 - x];
        double sky[3];

        daylight_sky(&p->sky, heights,
                     sun_angle_cos(p, zenith_sin, zenith_cos, x + 0.5), sky);
        row[x] = *mirror = v3((float)sky[0], (float)sky[1], (float)sky[2]);
    }
}

/* Paints the ground by the irradiance of the sun, which faces it, and of all
 * above it. */
static void paint_ground(struct painter *p, const double sun[3])
{
    double sum[3] = {sun[0] * p->sun_sin, sun[1] * p->sun_sin,
                     sun[2] * p->sun_sin};
    size_t half = (size_t)p->width * (p->height / 2);
    struct vec3 ground;

    for (uint32_t y = 0; y < p->height / 2; y++) {
        double weight = cos(zenith_angle(p, y + 0.5)) * tent_angle(p, y);
        const struct vec3 *row = row_of(p, y);

        for (uint32_t x = 0; x < p->width; x++) {
            sum[0] += weight * (double)row[x].x;
            sum[1] += weight * (double)row[x].y;
            sum[2] += weight * (double)row[x].z;
        }
    }
    ground = v3_scale(v3((float)sum[0], (float)sum[1], (float)sum[2]),
                      (float)(GROUND_ALBEDO / M_PI));
    for (size_t i = half; i < 2 * half; i++)
        p->texels[i] = ground;
}

void sun_irradiance(double elevation_deg, double turbidity, double rgb[3])
{
    double radius = sin(angle_rad(SUN_RADIUS_DEG));
    double height = fmin(elevation_deg / SUN_RADIUS_DEG, 1);
    double angle = 0;

    rgb[0] = rgb[1] = rgb[2] = 0;
    if (!(elevation_deg > 0))
        return;
    daylight_sun(elevation_deg, turbidity, rgb);
    /* without the circular segment below the horizon */
    angle = M_PI - acos(height) + height * sqrt(1 - height * height);
    for (int i = 0; i < 3; i++)
        rgb[i] *= angle * radius * radius;
}

struct vec3 *sun_sky_create(uint32_t width, uint32_t height,
                            double sun_elevation_deg, double turbidity,
                            struct pool *pool, struct error *err)
{
    struct painter p = {
        .texels = alloc_array((size_t)width * height, sizeof *p.texels),
        .width = width,
        .height = height,
        .sun_sin = sin(angle_rad(sun_elevation_deg)),
        .sun_cos = cos(angle_rad(sun_elevation_deg)),
    };

    double sun[3];

    assert(width % 2 == 0 && height % 2 == 0);
    if (p.texels == NULL) {
        fail(err, "out of memory for a sky of %ux%u", width, height);
        return NULL;
    }
    if (!(sun_elevation_deg > 0))
        return p.texels;
    daylight_init(&p.sky, sun_elevation_deg, turbidity);
    sun_irradiance(sun_elevation_deg, turbidity, sun);
    pool_each(pool, height / 2, paint_row, &p);
    paint_ground(&p, sun);
    return p.texels;
}
