// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <time.h>

#include "base/clock.h"

static uint64_t monotonic_ns(void)
{
    struct timespec t;

    assert_int_equal(clock_gettime(CLOCK_MONOTONIC, &t), 0);
    return (uint64_t)t.tv_sec * UINT64_C(1000000000) + (uint64_t)t.tv_nsec;
}

static void the_clock_is_the_monotonic_one(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        uint64_t before_ns = monotonic_ns();
        uint64_t now_ns = clock_ns();

        assert_true(now_ns >= before_ns);
        assert_true(now_ns <= monotonic_ns());
    }
}

static void seconds_are_never_negative(void **state)
{
    (void)state;
    check_close(seconds_between(5, 1000000005), 1, 1e-12);
    check_close(seconds_between(10, 5), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_clock_is_the_monotonic_one),
        cmocka_unit_test(seconds_are_never_negative),
    };

    return cmocka_run_group_tests_name("clock", tests, NULL, NULL);
}
