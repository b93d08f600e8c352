// SPDX-License-Identifier: MIT
/*
 * test_series.c - slopes of exact curves, ratios and guides
 */
#include <math.h>

#include "tests/unit/check.h"

#include "command/curve.h"

/* y is a square, so the slope of its root is half of the exponent. */
static void exact_powers_have_exact_slopes(void **state)
{
    static const double exponents[] = {-1, -0.5, -2.2, 0};

    (void)state;
    for (int k = 0; k < 4; k++) {
        struct series s = {.count = 7};
        struct series_fit fit;

        for (int i = 0; i < s.count; i++) {
            s.x[i] = 0.013 * pow(2, i) + 1e-4 * i;
            s.y[i] = 3 * pow(s.x[i], exponents[k]);
        }
        fit = series_fit(&s);
        check_close(fit.slope, exponents[k] / 2, 1e-9);
        check_close(fit.low, fit.slope, 1e-6);
        check_close(fit.high, fit.slope, 1e-6);
    }
}

static void few_points_have_no_interval(void **state)
{
    struct series s = {.count = 2, .x = {1, 2, 4}, .y = {4, 1, 1}};

    (void)state;
    check_close(series_fit(&s).slope, -1, 1e-12);
    assert_true(isnan(series_fit(&s).low));
    s.count = 1;
    assert_true(isnan(series_fit(&s).slope));
    s.count = 3;
    assert_true(series_fit(&s).low < -0.5 && series_fit(&s).high > -0.5);
}

static void guide_has_half_a_slope(void **state)
{
    struct series s = {.count = 3, .x = {1, 2, 4}, .y = {8, 4, 2}};
    struct series guide = series_half_slope(&s);

    (void)state;
    check_close(guide.y[0], 8, 1e-9);
    check_close(guide.y[1], 2, 1e-9);
}

static void ratio_is_at_the_common_time(void **state)
{
    struct series a = {.count = 3, .x = {1, 2, 4}, .y = {4, 2, 1}};
    struct series b = {.count = 2, .x = {1, 2}, .y = {12, 6}};

    (void)state;
    check_close(series_times(&a, &b), 3, 1e-9);
    check_close(series_times(&b, &a), 1.0 / 3, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_powers_have_exact_slopes),
        cmocka_unit_test(few_points_have_no_interval),
        cmocka_unit_test(guide_has_half_a_slope),
        cmocka_unit_test(ratio_is_at_the_common_time),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
