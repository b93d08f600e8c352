// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <unistd.h>

#include "base/clock.h"

static void test_clock(void **state)
{
    uint64_t begin_ns = clock_ns();

    (void)state;
    usleep(20000);
    double seconds = seconds_between(begin_ns, clock_ns());
    assert_true(seconds >= 0.02 && seconds < 10);
    check_close(seconds_between(5, 1000000005), 1, 1e-12);
    check_close(seconds_between(10, 5), 0, 0); /* never negative */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clock),
    };

    return cmocka_run_group_tests_name("clock", tests, NULL, NULL);
}
