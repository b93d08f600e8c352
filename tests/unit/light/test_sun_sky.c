// SPDX-License-Identifier: MIT
#include "world/light/daylight.h"

#include <math.h>
#include <stdlib.h>

#include "base/geometry.h"
#include "world/light/sky_table.h"
#include "kernels/light.h"

#include "tests/unit/check.h"

struct dome {
    struct vec3 *texels;
    struct world world;
};

static void dome_init(struct dome *d, uint32_t width, uint32_t height,
                      double elevation, double turbidity)
{
    struct error err;

    *d = (struct dome){.texels = sun_sky_create(width, height, elevation,
                                                turbidity, NULL, &err)};
    assert_non_null(d->texels);
    d->world.settings.sky = (struct sky){.color = {1, 1, 1},
                                         .width = width,
                                         .height = height,
                                         .rotation_cos = 1};
    d->world.sky_texels = d->texels;
}

/* The irradiance of a disc is its radiance times pi sin^2 of its radius: a
 * quadrature over the part above the horizon. */
static void the_sun_has_its_irradiance(void **state)
{
    static const double elevations[] = {0.01, 0.05, 0.15, 0.25,
                                        0.27, 5,    60,   90};
    const double radius = SUN_RADIUS_DEG;
    const int n = 2000;

    (void)state;
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        double rgb[3], got[3], sum = 0;

        for (int y = 0; y < n; y++) {
            double up = radius * (2 * (y + 0.5) / n - 1);

            if (elevations[i] + up > 0)
                sum += 2 * sqrt(radius * radius - up * up) * 2 * radius / n;
        }
        daylight_sun(elevations[i], 2.5, rgb);
        sun_irradiance(elevations[i], 2.5, got);
        for (int k = 0; k < 3; k++)
            check_close(got[k], rgb[k] * sum * angle_rad(1) * angle_rad(1),
                        1e-3 * got[k]);
    }
}

/* The image has the radiance of the model between its texels, too, where the
 * sun stands: there is no disc. */
static void the_image_has_the_radiance_of_the_model(void **state)
{
    const double elevations[] = {3, 40, 88};
    uint64_t seed = 5;

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        double e = angle_rad(elevations[i]);
        struct daylight sky;
        struct dome d;

        dome_init(&d, SUN_SKY_WIDTH, SUN_SKY_HEIGHT, elevations[i], 3);
        daylight_init(&sky, elevations[i], 3);
        for (int k = 0; k < 1000; k++) {
            /* from 1 degree above the horizon on */
            double y = k == 0 ? sin(e) : 0.02 + 0.98 * check_random(&seed);
            double phi = k == 0 ? 0 : 2 * M_PI * check_random(&seed);
            double width = sqrt(1 - y * y);
            double near = y * sin(e) + width * cos(e) * cos(phi);
            struct vec3 way = v3((float)(width * sin(phi)), (float)y,
                                 (float)(-width * cos(phi)));
            double heights[3], rgb[3];

            for (int c = 0; c < 3; c++)
                heights[c] = daylight_height(&sky, c, y);
            daylight_sky(&sky, heights, near, rgb);
            check_close((double)sky_radiance(&d.world, way).y, rgb[1],
                        (near > cos(angle_rad(3)) ? 0.03 : 0.01) * rgb[1]);
        }
        free(d.texels);
    }
}

/* The sky is the same left and right of the sun. */
static void the_sky_is_symmetric(void **state)
{
    struct dome d;

    (void)state;
    dome_init(&d, 512, 256, 37, 4);
    for (uint32_t y = 0; y < 256; y++) {
        for (uint32_t x = 0; x < 256; x++) {
            struct vec3 left = d.texels[y * 512 + x];
            struct vec3 right = d.texels[y * 512 + 511 - x];

            assert_true(left.x == right.x && left.z == right.z);
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
        double sun[3];

        sun_irradiance(elevations[i], 3, sun);
        assert_true(sun[0] == 0 && sun[1] == 0 && sun[2] == 0);
        dome_init(&d, 64, 32, elevations[i], 3);
        for (int k = 0; k < 64 * 32; k++)
            assert_true(v3_is_zero(d.texels[k]));
        assert_true(
            sky_table_build(&table, d.texels, 64, 32, SKY_WITH_MIS, &err));
        assert_null(table.sums);
        sky_table_free(&table);
        free(d.texels);
    }
}

/* A plane outdoors receives as much from the sun and the whole image as the
 * ground, which reflects GROUND_ALBEDO of it: quadrature over all directions.
 */
static void the_ground_reflects_its_irradiance(void **state)
{
    const int rows = 2000, columns = 4000;
    double sum = 0, ground, sun[3];
    struct dome d;

    (void)state;
    dome_init(&d, 128, 512, 50, 3);
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
    sun_irradiance(50, 3, sun);
    sum += sun[1] * sin(angle_rad(50));
    ground = (double)sky_radiance(&d.world, v3(0, -1, 0)).y;
    check_close(ground / (GROUND_ALBEDO * sum / M_PI), 1, 0.01);
    free(d.texels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sun_has_its_irradiance),
        cmocka_unit_test(the_image_has_the_radiance_of_the_model),
        cmocka_unit_test(the_sky_is_symmetric),
        cmocka_unit_test(the_night_is_black),
        cmocka_unit_test(the_ground_reflects_its_irradiance),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
