// SPDX-License-Identifier: MIT
/*
 * test_axis.c - ranges, places and ticks of axes
 */
#include <stddef.h>

#include "tests/unit/check.h"

#include "measure/axis.h"

static struct series points(void)
{
    return (
        struct series){.count = 3, .x = {1e3, 1e5, 1e7}, .y = {50, 90, 600}};
}

static void logarithms_are_even(void **state)
{
    struct axis x = {.from = 0, .to = 1000}, y = {.from = 500, .to = 0};
    struct series s = points();

    (void)state;
    assert_true(axes_fit(&x, &y, &s, 1));
    check_close(axis_place(&x, 1e5), 500, 1e-9);
    check_close(axis_place(&x, 1e6) - axis_place(&x, 1e5),
                axis_place(&x, 1e5) - axis_place(&x, 1e4), 1e-9);
}

static void check_ticks(const struct axis *a, const char *const *labels,
                        int count)
{
    struct axis_tick tick;

    for (int i = 0; i < count; i++) {
        assert_true(axis_tick(a, i, &tick));
        assert_string_equal(tick.label, labels[i]);
    }
    assert_false(axis_tick(a, count, &tick));
}

static void ticks_are_round(void **state)
{
    static const char *const powers[] = {"50000",  "100000", "200000",
                                         "500000", "1e6",    "2e6"};
    static const char *const small[] = {"5e-3", "0.01", "0.02"};

    (void)state;
    check_ticks(&(struct axis){.low = 4.6, .high = 6.4}, powers, 6);
    check_ticks(&(struct axis){.low = -2.4, .high = -1.6}, small, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(logarithms_are_even),
        cmocka_unit_test(ticks_are_round),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
