// SPDX-License-Identifier: MIT
#include "world/light/daylight.h"

#include <math.h>

#include "base/geometry.h"
#include "tests/unit/check.h"

/* Converts radiance to Y in candela per square metre, x and y by the primaries
 * of Rec.709 (IEC 61966-2-1). */
static void luminance_and_chromaticity(const double rgb[3], double yxy[3])
{
    static const double matrix[3][3] = {{0.4124, 0.3576, 0.1805},
                                        {0.2126, 0.7152, 0.0722},
                                        {0.0193, 0.1192, 0.9505}};
    double xyz[3] = {0, 0, 0};
    double sum;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            xyz[i] += matrix[i][k] * rgb[k];
    sum = xyz[0] + xyz[1] + xyz[2];
    yxy[0] = xyz[1] * DAYLIGHT_UNIT;
    yxy[1] = xyz[0] / sum;
    yxy[2] = xyz[1] / sum;
}

/* Sets the radiance of the sky at an angle from the zenith, gamma away from the
 * sun. */
static void sky_at(const struct daylight *d, double zenith_deg,
                   double gamma_deg, double rgb[3])
{
    double heights[3];

    for (int i = 0; i < 3; i++)
        heights[i] = daylight_height(d, i, cos(angle_rad(zenith_deg)));
    daylight_sky(d, heights, cos(angle_rad(gamma_deg)), rgb);
}

/* Zenith by the formulas of the paper's appendix A.2 with the four digits that
 * it prints, computed apart from this program. The first luminance is
 * (4.0453 * 2 - 4.9710) tan(77 degrees) - 0.2155 * 2 + 2.4192 kcd/m2. */
static void the_zenith_is_that_of_the_paper(void **state)
{
    static const struct {
        double turbidity, elevation, luminance, x, y;
    } cases[] = {
        {2, 90, 15500.7, 0.2667, 0.2773},   {3, 90, 29477.3, 0.2706, 0.2825},
        {3, 45, 7320.4, 0.2462, 0.2522},    {4, 60, 14605.6, 0.2564, 0.2651},
        {2, 0.001, 1988.2, 0.2843, 0.3060},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct daylight d;
        double rgb[3], yxy[3];

        daylight_init(&d, cases[i].elevation, cases[i].turbidity);
        sky_at(&d, 0, 90 - cases[i].elevation, rgb);
        luminance_and_chromaticity(rgb, yxy);
        check_close(yxy[0] / cases[i].luminance, 1, 0.003);
        check_close(yxy[1], cases[i].x, 0.002);
        check_close(yxy[2], cases[i].y, 0.002);
    }
}

/* A clear sky is brightest at the sun and darkest about 90 degrees from it, on
 * the other side of the zenith (CIE S 011, types 12 and 13). */
static void the_sky_is_bright_at_the_sun(void **state)
{
    struct daylight d;
    double sun[3], zenith[3], dark[3], far[3];

    (void)state;
    daylight_init(&d, 40, 2.5);
    sky_at(&d, 50, 0, sun);
    sky_at(&d, 0, 50, zenith);
    sky_at(&d, 40, 90, dark);
    sky_at(&d, 85, 135, far);
    assert_true(sun[1] > 5 * zenith[1]);
    assert_true(dark[1] < zenith[1]);
    assert_true(dark[1] < far[1]);
    assert_true(dark[2] > 1.5 * dark[0]); /* blue */
}

static double illuminance_of_sun(double elevation, double turbidity,
                                 double yxy[3])
{
    double radius = angle_rad(SUN_RADIUS_DEG);
    double rgb[3];

    daylight_sun(elevation, turbidity, rgb);
    luminance_and_chromaticity(rgb, yxy);
    return yxy[0] * 2 * M_PI * (1 - cos(radius));
}

/* Correlated colour temperature by McCamy (1992). */
static double color_temperature(const double yxy[3])
{
    double n = (yxy[1] - 0.3320) / (0.1858 - yxy[2]);

    return ((449 * n + 3525) * n + 6823.3) * n + 5520.33;
}

/* The illuminance of the sun in clear air is 127.5 exp(-0.21 m) kilolux for an
 * air mass m (IES, Recommended Practice for the Calculation of Daylight
 * Availability, 1984). A pure model of the air differs by some per cent. */
static void the_sun_is_as_bright_as_measured(void **state)
{
    (void)state;
    for (double elevation = 30; elevation <= 90; elevation += 15) {
        double mass = 1 / sin(angle_rad(elevation));
        double yxy[3];
        double lux = illuminance_of_sun(elevation, 2.3, yxy);

        check_close(lux / (127500 * exp(-0.21 * mass)), 1, 0.1);
    }
}

/* The sun reddens and dims towards the horizon: sunlight at noon has 5000 to
 * 5800 K, an hour after sunrise (15 degrees) about 3500 to 4500 K, and the
 * setting sun about 2000 K. */
static void the_sun_is_red_at_the_horizon(void **state)
{
    double last = INFINITY;
    double yxy[3];

    (void)state;
    illuminance_of_sun(60, 2.3, yxy);
    check_close(color_temperature(yxy), 5400, 400);
    illuminance_of_sun(15, 2.3, yxy);
    check_close(color_temperature(yxy), 4000, 500);
    illuminance_of_sun(3, 2.3, yxy);
    check_close(color_temperature(yxy), 2100, 500);
    for (double elevation = 90; elevation > 0; elevation -= 5) {
        double lux = illuminance_of_sun(elevation, 3, yxy);

        assert_true(lux < last);
        last = lux;
    }
}

static void everything_is_finite_at_the_ends(void **state)
{
    static const double elevations[] = {1e-9, 1e-3, 1, 45, 89.999, 90};

    (void)state;
    for (double turbidity = TURBIDITY_MIN; turbidity <= TURBIDITY_MAX + 1e-9;
         turbidity += 0.83) {
        for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
            struct daylight d;
            double rgb[3];

            daylight_sun(elevations[i], turbidity, rgb);
            for (int k = 0; k < 3; k++)
                assert_true(rgb[k] >= 0 && rgb[k] < 1e5);
            daylight_init(&d, elevations[i], turbidity);
            for (int zenith = 0; zenith < 90; zenith++) {
                sky_at(&d, zenith + 0.999, fabs(90 - elevations[i] - zenith),
                       rgb);
                for (int k = 0; k < 3; k++)
                    assert_true(rgb[k] >= 0 && rgb[k] < 100);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_zenith_is_that_of_the_paper),
        cmocka_unit_test(the_sky_is_bright_at_the_sun),
        cmocka_unit_test(the_sun_is_as_bright_as_measured),
        cmocka_unit_test(the_sun_is_red_at_the_horizon),
        cmocka_unit_test(everything_is_finite_at_the_ends),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
