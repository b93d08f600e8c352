// SPDX-License-Identifier: MIT
#include "light/sun_sky.h"

#include <math.h>
#include <stdlib.h>

#include "base/geometry.h"
#include "kernels/light.h"
#include "light/daylight.h"
#include "light/sky_table.h"

#include "tests/unit/check.h"

struct dome {
    struct vec3 *texels;
    struct world world;
};

static void dome_init(struct dome *d, uint32_t width, double elevation,
                      double turbidity)
{
    struct error err;

    *d = (struct dome){.texels = sun_sky_create(width, width / 2, elevation,
                                                turbidity, NULL, &err)};
    assert_non_null(d->texels);
    d->world.settings.sky = (struct sky){.color = {1, 1, 1},
                                         .width = width,
                                         .height = width / 2,
                                         .rotation_cos = 1};
    d->world.sky_texels = d->texels;
}

/* Returns the direction that is gamma away from the middle of the sun, at an
 * angle phi around it. */
static struct vec3 direction_at(double elevation, double gamma, double phi)
{
    double e = angle_rad(elevation);
    double x = sin(gamma) * cos(phi), up = sin(gamma) * sin(phi);
    double ahead = cos(gamma);

    return v3((float)x, (float)(ahead * sin(e) + up * cos(e)),
              (float)(-ahead * cos(e) + up * sin(e)));
}

/* Integrates the image without the sky's model over a cone around the sun: the
 * irradiance by the disc of a plane that faces it. Green. */
static double irradiance_of_disc(const struct dome *d, double elevation,
                                 double turbidity, double cone_deg)
{
    const int steps = 600, turns = 240;
    double step = angle_rad(cone_deg) / steps;
    struct daylight sky;
    double sum = 0;

    daylight_init(&sky, elevation, turbidity);
    for (int i = 0; i < steps; i++) {
        double gamma = (i + 0.5) * step;
        double weight = sin(gamma) * cos(gamma) * step * 2 * M_PI / turns;

        for (int k = 0; k < turns; k++) {
            struct vec3 way =
                direction_at(elevation, gamma, 2 * M_PI * (k + 0.5) / turns);
            double rgb[3] = {0, 0, 0};
            double heights[3];

            if (way.y <= 0)
                continue;
            for (int c = 0; c < 3; c++)
                heights[c] = daylight_height(&sky, c, (double)way.y);
            daylight_sky(&sky, heights, cos(gamma), rgb);
            sum += weight * ((double)sky_radiance(&d->world, way).y - rgb[1]);
        }
    }
    return sum;
}

/* The irradiance is the radiance of the disc times its solid angle, pi sin2 of
 * its radius. */
static void the_sun_has_its_irradiance(void **state)
{
    static const double elevations[] = {5, 30, 60, 85, 89.9, 90};
    const double radius = angle_rad(SUN_RADIUS_DEG);

    (void)state;
    for (uint32_t width = 256; width <= 2048; width *= 2) {
        for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
            double rgb[3], want;
            struct dome d;

            dome_init(&d, width, elevations[i], 2.5);
            daylight_sun(elevations[i], 2.5, rgb);
            want = rgb[1] * M_PI * sin(radius) * sin(radius);
            check_close(irradiance_of_disc(&d, elevations[i], 2.5,
                                           0.6 + 2 * 360.0 / width) /
                            want,
                        1, 0.01);
            free(d.texels);
        }
    }
}

/* A setting sun is cut off by the horizon: its light is that of the circular
 * segment above it. */
static void a_setting_sun_is_cut_off(void **state)
{
    const double radius = angle_rad(SUN_RADIUS_DEG);

    (void)state;
    for (double elevation = 0.05; elevation < 0.3; elevation += 0.1) {
        double h = fmin(elevation / SUN_RADIUS_DEG, 1);
        double part = 1 - (acos(h) - h * sqrt(1 - h * h)) / M_PI;
        double rgb[3], sum = 0;
        struct daylight sky;
        struct dome d;

        dome_init(&d, 2048, elevation, 2);
        daylight_init(&sky, elevation, 2);
        for (int y = 500; y < 512; y++) {
            double angle = M_PI * (y + 0.5) / 1024;
            double heights[3];

            for (int c = 0; c < 3; c++)
                heights[c] = daylight_height(&sky, c, cos(angle));
            for (int x = 1010; x < 1038; x++) {
                double azimuth = 2 * M_PI * ((x + 0.5) / 2048 - 0.5);
                double near =
                    cos(angle) * sin(angle_rad(elevation)) +
                    sin(angle) * cos(angle_rad(elevation)) * cos(azimuth);

                daylight_sky(&sky, heights, near, rgb);
                sum += ((double)d.texels[y * 2048 + x].x - rgb[0]) *
                       sin(angle) * (M_PI / 1024) * (M_PI / 1024);
            }
        }
        daylight_sun(elevation, 2, rgb);
        check_close(sum / (rgb[0] * part * M_PI * radius * radius), 1, 0.02);
        free(d.texels);
    }
}

/* The sky is the same left and right of the sun. */
static void the_sky_is_symmetric(void **state)
{
    struct dome d;

    (void)state;
    dome_init(&d, 512, 37, 4);
    for (uint32_t y = 0; y < 256; y++) {
        for (uint32_t x = 0; x < 256; x++) {
            struct vec3 left = d.texels[y * 512 + x];
            struct vec3 right = d.texels[y * 512 + 511 - x];

            /* the disc's edge is rounded to points */
            check_close((double)left.x, (double)right.x,
                        0.01 * (double)right.x);
            check_close((double)left.z, (double)right.z,
                        0.01 * (double)right.z);
        }
    }
    free(d.texels);
}

/* Without the sun above the horizon all is black, and never NaN. */
static void the_night_is_black(void **state)
{
    static const double elevations[] = {0, -1e-9, -5, -90};

    (void)state;
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        struct dome d;
        struct sky_table table = {0};
        struct error err;

        dome_init(&d, 64, elevations[i], 3);
        for (int k = 0; k < 64 * 32; k++)
            assert_true(v3_is_zero(d.texels[k]));
        assert_true(
            sky_table_build(&table, d.texels, 64, 32, SKY_WITH_MIS, &err));
        assert_null(table.sums);
        sky_table_free(&table);
        free(d.texels);
    }
}

/* A plane outdoors receives as much from the whole image as the ground, which
 * reflects GROUND_ALBEDO of it: quadrature over all directions. */
static void the_ground_reflects_its_irradiance(void **state)
{
    const int rows = 2000, columns = 4000;
    double sum = 0, ground;
    struct dome d;

    (void)state;
    dome_init(&d, 512, 50, 3);
    for (int y = 0; y < rows; y++) {
        double angle = M_PI / 2 * (y + 0.5) / rows;

        for (int x = 0; x < columns; x++) {
            double phi = 2 * M_PI * (x + 0.5) / columns;
            struct vec3 way =
                v3((float)(sin(angle) * sin(phi)), (float)cos(angle),
                   (float)(-sin(angle) * cos(phi)));

            sum +=
                sin(angle) * cos(angle) * (double)sky_radiance(&d.world, way).y;
        }
    }
    sum *= M_PI / 2 / rows * 2 * M_PI / columns;
    ground = (double)sky_radiance(&d.world, v3(0, -1, 0)).y;
    check_close(ground / (GROUND_ALBEDO * sum / M_PI), 1, 0.01);
    free(d.texels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sun_has_its_irradiance),
        cmocka_unit_test(a_setting_sun_is_cut_off),
        cmocka_unit_test(the_sky_is_symmetric),
        cmocka_unit_test(the_night_is_black),
        cmocka_unit_test(the_ground_reflects_its_irradiance),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
