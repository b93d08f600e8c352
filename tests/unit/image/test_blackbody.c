// SPDX-License-Identifier: MIT
#include "image/color.h"

#include <math.h>

#include "tests/unit/check.h"

/* Planckian locus: Wyszecki and Stiles, Color Science, 2nd ed., table
 * 1(3.11); illuminant A (CIE 15), a black body of 2855.5 K. */
static const double locus[][3] = {
    {1500, 0.5857, 0.3931}, {2000, 0.5267, 0.4133}, {2855.5, 0.44757, 0.40744},
    {3000, 0.4369, 0.4041}, {5000, 0.3451, 0.3516}, {6500, 0.3135, 0.3237},
    {10000, 0.2807, 0.2884}};

#define LOCUS_COUNT (sizeof locus / sizeof *locus)

/* Chromaticity of linear Rec.709, by the matrix of IEC 61966-2-1. */
static void chromaticity(const double rgb[3], double *x, double *y)
{
    static const double matrix[3][3] = {{0.4124, 0.3576, 0.1805},
                                        {0.2126, 0.7152, 0.0722},
                                        {0.0193, 0.1192, 0.9505}};
    double xyz[3] = {0, 0, 0};

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            xyz[i] += matrix[i][k] * rgb[k];
    *x = xyz[0] / (xyz[0] + xyz[1] + xyz[2]);
    *y = xyz[1] / (xyz[0] + xyz[1] + xyz[2]);
}

static void colours_are_on_the_locus(void **state)
{
    (void)state;
    for (size_t i = 0; i < LOCUS_COUNT; i++) {
        double xyz[3], rgb[3], sum, x, y;

        blackbody_xyz(locus[i][0], xyz);
        sum = xyz[0] + xyz[1] + xyz[2];
        check_close(xyz[0] / sum, locus[i][1], 0.0005);
        check_close(xyz[1] / sum, locus[i][2], 0.0005);
        if (locus[i][0] < 1900)
            continue; /* outside the Rec.709 gamut */
        blackbody_rgb(locus[i][0], rgb);
        chromaticity(rgb, &x, &y);
        check_close(x, locus[i][1], 0.002);
        check_close(y, locus[i][2], 0.002);
    }
}

/* A black body outside the gamut moves towards white: the line from white
 * through its colour meets the edge of the gamut where blue is 0. */
static void colours_outside_the_gamut_move_towards_white(void **state)
{
    const double white[2] = {0.3127, 0.3290};
    double rgb[3], x, y;

    (void)state;
    blackbody_rgb(1500, rgb);
    chromaticity(rgb, &x, &y);
    check_close(rgb[2], 0, 0);
    check_close((x - white[0]) * (0.3931 - white[1]),
                (y - white[1]) * (0.5857 - white[0]), 1e-4);
    assert_true(x > 0.5267 && x < 0.5857);
}

/* STRESS M15: temperatures reach from below any glow to above any star. */
static void all_temperatures_have_luminance_one(void **state)
{
    (void)state;
    for (double t = BLACKBODY_MIN; t <= BLACKBODY_MAX; t *= 1.1) {
        double rgb[3];

        blackbody_rgb(t, rgb);
        for (int k = 0; k < 3; k++)
            assert_true(rgb[k] >= 0 && rgb[k] < 5);
        check_close(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], 1,
                    1e-3);
        assert_true(t > 6000 || rgb[0] > rgb[2]);
        assert_true(t < 7000 || rgb[2] > rgb[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_are_on_the_locus),
        cmocka_unit_test(colours_outside_the_gamut_move_towards_white),
        cmocka_unit_test(all_temperatures_have_luminance_one),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
