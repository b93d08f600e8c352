// SPDX-License-Identifier: MIT
#include "light/sun_sky.h"

#include <assert.h>
#include <math.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "light/daylight.h"
#include "kernels/vec.h"

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
