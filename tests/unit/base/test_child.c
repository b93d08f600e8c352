// SPDX-License-Identifier: MIT
/*
 * test_child.c - children are ended by their processor time, not by the clock
 * of a busy machine
 */
#include "base/child.h"

#include <stdlib.h>

#include "base/clock.h"
#include "tests/unit/check.h"

#define LIMIT_NS UINT64_C(400000000)

/* Runs a line of the shell under the limit. */
static enum child_end run(const char *line, struct child_result *r)
{
    const char *const arguments[] = {"sh", "-c", line, NULL};
    struct child_task task = {.program = "/bin/sh",
                              .arguments = arguments,
                              .time_ns = LIMIT_NS,
                              .size_bytes = 100};

    return child_run(&task, r);
}

/* Two seconds with little work pass, as on a machine that gives the child a
 * small share; the limit is .4 s. */
static void a_slow_child_is_awaited(void **state)
{
    struct child_result r;
    uint64_t begin_ns = clock_ns();

    (void)state;
    assert_int_equal(
        run("for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 "
            "19 20; do sleep .1; done; echo ready",
            &r),
        CHILD_ENDED);
    assert_true(clock_ns() - begin_ns > 2 * LIMIT_NS);
    assert_string_equal(r.output, "ready\n");
    free(r.output);
}

static void loops_and_sleepers_are_ended(void **state)
{
    struct child_result r;

    (void)state;
    assert_int_equal(run("while :; do :; done", &r), CHILD_LATE);
    assert_int_equal(run("exec sleep 60", &r), CHILD_LATE);
    /* a little work now and then is no reason to wait forever */
    assert_int_equal(run("while :; do sleep .1; done", &r), CHILD_LATE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slow_child_is_awaited),
        cmocka_unit_test(loops_and_sleepers_are_ended),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
