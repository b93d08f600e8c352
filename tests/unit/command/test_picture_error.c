// SPDX-License-Identifier: MIT
/*
 * test_picture_error.c - errors of small pictures computed by hand
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#include "command/difference.h"

/* Differences 0.1, 0 and -0.3 in the first pixel, 0 in the second. */
static void errors_are_those_by_hand(void **state)
{
    const float a[] = {1.1f, 2.0f, 0.0f, 0.5f, 0.5f, 0.5f};
    const float b[] = {1.0f, 2.0f, 0.3f, 0.5f, 0.5f, 0.5f};
    struct picture_pair pair = {2, 1, a, b};
    struct picture_error e = picture_error_of(&pair);

    (void)state;
    check_close(e.mse, (0.01 + 0.09) / 6, 1e-7);
    check_close(e.relmse, (0.01 / 1.01 + 0.09 / 0.10) / 6, 1e-7);
    check_close(e.bias, -0.2 / 4.8, 1e-7);
    /* pixel means -0.2/3 and 0: their standard error is half of the distance,
     * relative to the mean of 0.8 */
    check_close(e.bias_margin, 1.96 * 0.2 / 3 / 2 / 0.8, 1e-6);
    check_close(e.largest, -0.3, 1e-7);
    assert_int_equal(e.largest_x, 0);
    assert_int_equal(e.largest_y, 0);
    assert_int_equal(e.largest_channel, 2);
    check_close(e.percentile, 0.3, 1e-7);
}

/* A pixel of 4 between four of 1, and one of 20 that counts as a quarter of
 * itself. At exposure 1, black is 0.05. */
static void stated_errors_are_relative_to_the_means_around(void **state)
{
    float a[15], b[15];
    struct picture_pair pair = {5, 1, a, b};
    double black = 0.1 * 0.1;

    (void)state;
    for (int i = 0; i < 15; i++)
        a[i] = b[i] = i / 3 == 2 ? 4 : 1;
    a[6] += 0.5f;
    check_close(picture_error_stated(&pair, 0), sqrt(0.25 / (1 + black) / 15),
                1e-9);
    check_close(picture_error_stated(&pair, 1),
                sqrt(0.25 / (1 + black / 4) / 15), 1e-9);
    b[6] = 20;
    a[6] = 20.5f;
    check_close(picture_error_stated(&pair, 0), sqrt(0.25 / (25 + black) / 15),
                1e-9);
    a[6] = 20;
    a[0] = 2; /* the pixels around have 1 and 20 */
    check_close(picture_error_stated(&pair, 0),
                sqrt(1 / (10.5 * 10.5 + black) / 15), 1e-9);
}

static void one_pixel_has_no_margin(void **state)
{
    const float a[] = {1, 2, 3}, b[] = {1, 1, 1}, black[] = {0, 0, 0};
    struct picture_pair pair = {1, 1, a, b}, dark = {1, 1, a, black};
    struct picture_error e = picture_error_of(&pair);

    (void)state;
    check_close(e.bias, 1, 1e-12);
    assert_true(isnan(e.bias_margin));
    assert_false(isfinite(picture_error_of(&dark).bias));
}

/* 1,000 pixels of 3 values: the percentile is the difference of rank 2,997 of
 * 3,000, so that three are larger. */
static void percentile_is_the_rank_of_a_sorted_list(void **state)
{
    enum { COUNT = 3000 };
    float a[COUNT], b[COUNT] = {0};
    struct picture_pair pair = {100, 10, a, b};

    (void)state;
    /* 1 to 3,000 in a scrambled order, every second with a minus */
    for (int i = 0; i < COUNT; i++) {
        int rank = (int)((long)i * 1237 % COUNT) + 1;

        a[i] = (float)(i % 2 == 0 ? rank : -rank) / 7;
    }
    check_close(picture_error_of(&pair).percentile, 2997.0 / 7, 1e-3);
    check_close(fabs(picture_error_of(&pair).largest), 3000.0 / 7, 1e-3);
}

static void own_error_is_subtracted_where_it_matters(void **state)
{
    (void)state;
    check_close(picture_error_without(1, 0.04), 1, 0);
    check_close(picture_error_without(1, 0.06), 0.94, 1e-12);
    check_close(picture_error_without(1, 2), -1, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_those_by_hand),
        cmocka_unit_test(stated_errors_are_relative_to_the_means_around),
        cmocka_unit_test(one_pixel_has_no_margin),
        cmocka_unit_test(percentile_is_the_rank_of_a_sorted_list),
        cmocka_unit_test(own_error_is_subtracted_where_it_matters),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
