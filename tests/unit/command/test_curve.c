// SPDX-License-Identifier: MIT
/*
 * test_curve.c - how often the interval of a slope contains the truth, the
 * reference's own error, and the table
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"
#include "tests/unit/noise.h"

#include "command/curve.h"

enum { SIDE = 24, VALUES = 3 * SIDE * SIDE, DOUBLINGS = 8, TRIES = 200 };

static float black[VALUES], picture[VALUES];

static const struct picture_pair pair = {SIDE, SIDE, picture, black};

/* A render that does not state its error. */
static struct curve_render at(uint64_t spp, double seconds, double cpu_seconds)
{
    return (struct curve_render){.spp = spp,
                                 .seconds = seconds,
                                 .cpu_seconds = cpu_seconds};
}

/* Measures one render of independent samples, the same in all channels of a
 * pixel, at 1, 2, 4 .. samples. Its slope is -0.5. */
static void render(struct curve *curve, double spread, uint64_t *random)
{
    static double sums[SIDE * SIDE];
    struct reference_info own = {0};
    struct curve_render now;
    int n = 0;

    curve->count = 0;
    for (int k = 0; k < SIDE * SIDE; k++)
        sums[k] = 0;
    for (int i = 0; i < DOUBLINGS; i++) {
        for (; n < 1 << i; n++)
            for (int k = 0; k < SIDE * SIDE; k++)
                sums[k] += noise(spread, random);
        for (int k = 0; k < VALUES; k++)
            picture[k] = (float)(sums[k / 3] / n);
        now = at((uint64_t)n, 0.01 * n, 0.02 * n);
        curve_add(curve, &now, &pair, &own);
    }
}

/* At least 92 % of the tries must be inside; without the groups of pixels 50 to
 * 80 % are. */
static void interval_contains_the_truth(void **state)
{
    static const double spreads[] = {0, 0.7, 1};
    static struct curve curve;

    (void)state;
    for (int k = 0; k < 3; k++) {
        uint64_t random = 5;
        int inside = 0;

        for (int i = 0; i < TRIES; i++) {
            struct series_fit fit;

            render(&curve, spreads[k], &random);
            fit = curve_fit(&curve, (struct curve_axes){false, false});
            inside += fit.low <= -0.5 && -0.5 <= fit.high;
            /* the interval says something */
            check_at_most(fit.high - fit.low, 0.4);
        }
        printf("spread %g: %d of %d\n", spreads[k], inside, TRIES);
        check_at_most(TRIES - inside, 16);
    }
}

static void own_error_is_subtracted(void **state)
{
    static struct curve curve;
    struct reference_info own = {.is_known = true, .mse = 0.1, .relmse = 1};
    struct curve_render renders[] = {at(4, 2, 3), at(8, 4, 6)};

    (void)state;
    for (int k = 0; k < VALUES; k++)
        picture[k] = 0.5f; /* MSE 0.25, relMSE 25 */
    curve_add(&curve, &renders[0], &pair, &own);
    check_close(curve.points[0].mse, 0.15, 1e-9);
    check_close(curve.points[0].relmse, 25, 1e-9); /* 1 is 4 % of it */
    check_close(curve_efficiency(&curve.points[0]), 1.0 / 50, 1e-9);
    assert_false(curve.points[0].is_drowned);
    for (int k = 0; k < VALUES; k++)
        picture[k] = 0.4f; /* MSE 0.16, of which 0.1 is the reference's */
    curve_add(&curve, &renders[1], &pair, &own);
    assert_true(curve.points[1].is_drowned);
    assert_int_equal(
        curve_series(&curve, (struct curve_axes){false, false}).count, 1);
}

static void table_has_a_line_for_each_point(void **state)
{
    static struct curve curve;
    struct reference_info own = {0};
    struct curve_render renders[] = {at(1, 0.5, 0.75), at(2, 1, 2)};
    struct curve_axes axes = {.is_relative = true};
    char *csv;

    (void)state;
    for (int k = 0; k < VALUES; k++)
        picture[k] = 0.5f;
    curve_add(&curve, &renders[0], &pair, &own);
    renders[1].stated = (struct film_error){true, true, 0.25, 0.125, 0.5};
    curve_add(&curve, &renders[1], &pair, &own);
    axes.is_cpu = true;
    check_close(curve_series(&curve, axes).x[1], 2, 0);
    csv = curve_csv(&curve);
    assert_string_equal(
        csv, "spp,seconds,cpu_seconds,rmse,relmse,bias,percentile_999,"
             "efficiency,error,stated,stated_low,stated_high\n"
             "1,0.5,0.75,0.5,25,,0.5,0.08,5,,,\n"
             "2,1,2,0.5,25,,0.5,0.04,5,0.25,0.125,0.5\n");
    free(csv);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interval_contains_the_truth),
        cmocka_unit_test(own_error_is_subtracted),
        cmocka_unit_test(table_has_a_line_for_each_point),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
