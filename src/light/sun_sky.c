// SPDX-License-Identifier: MIT
#include "light/sun_sky.h"

#include <assert.h>
#include <math.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "light/daylight.h"
#include "kernels/vec.h"

/* Points each way by which the covered part of a texel is found. */
#define POINTS 16

struct painter {
    struct vec3 *texels;
    uint32_t width, height;
    struct daylight sky;
    double sun_sin, sun_cos; /* of the elevation */
    double sun[3];           /* radiance of a texel inside the disc */
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

/* Returns the part of a texel that the sun's disc covers. */
static double covered_part(const struct painter *p, uint32_t x, uint32_t y)
{
    double edge_cos = cos(angle_rad(SUN_RADIUS_DEG));
    int count = 0;

    for (int j = 0; j < POINTS; j++) {
        double angle = zenith_angle(p, y + (j + 0.5) / POINTS);
        double zenith_sin = sin(angle), zenith_cos = cos(angle);

        for (int i = 0; i < POINTS; i++)
            count += sun_angle_cos(p, zenith_sin, zenith_cos,
                                   x + (i + 0.5) / POINTS) >= edge_cos;
    }
    return (double)count / (POINTS * POINTS);
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

/* Stores the covered parts of the texels above the horizon in their first
 * channels. Returns the solid angle of the whole disc in the image. */
static double cover_disc(struct painter *p)
{
    double sun_angle = atan2(p->sun_cos, p->sun_sin);
    double reach = angle_rad(SUN_RADIUS_DEG) + zenith_angle(p, 1);
    double total = 0;

    for (uint32_t y = 0; y < p->height; y++) {
        double angle = zenith_angle(p, y + 0.5);

        if (fabs(angle - sun_angle) > reach)
            continue;
        for (uint32_t x = 0; x < p->width; x++) {
            double part;

            if (sun_angle_cos(p, sin(angle), cos(angle), x + 0.5) < cos(reach))
                continue;
            part = covered_part(p, x, y);
            total += part * tent_angle(p, y);
            if (y < p->height / 2)
                row_of(p, y)[x].x = (float)part;
        }
    }
    return total;
}

/* Sets the light of the sun, so that its disc has the right irradiance in the
 * image, and stores the disc. */
static void place_sun(struct painter *p, double elevation_deg, double turbidity)
{
    double angle = 2 * M_PI * (1 - cos(angle_rad(SUN_RADIUS_DEG)));
    double scale = angle / cover_disc(p);

    daylight_sun(elevation_deg, turbidity, p->sun);
    for (int i = 0; i < 3; i++)
        p->sun[i] *= scale;
}

/* Returns a texel's radiance: that of the sky, and the sun's covered part. */
static struct vec3 painted(const struct painter *p, const double sky[3],
                           float part)
{
    return v3((float)(sky[0] + (double)part * p->sun[0]),
              (float)(sky[1] + (double)part * p->sun[1]),
              (float)(sky[2] + (double)part * p->sun[2]));
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
        row[x] = painted(p, sky, row[x].x);
        *mirror = painted(p, sky, mirror->x);
    }
}

/* Paints the ground by the irradiance of all above it. */
static void paint_ground(struct painter *p)
{
    double sum[3] = {0, 0, 0};
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

    assert(width == 2 * height && height % 2 == 0);
    if (p.texels == NULL) {
        fail(err, "out of memory for a sky of %ux%u", width, height);
        return NULL;
    }
    if (!(sun_elevation_deg > 0))
        return p.texels;
    daylight_init(&p.sky, sun_elevation_deg, turbidity);
    place_sun(&p, sun_elevation_deg, turbidity);
    pool_each(pool, height / 2, paint_row, &p);
    paint_ground(&p);
    return p.texels;
}
