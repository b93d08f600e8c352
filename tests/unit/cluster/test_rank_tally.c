// SPDX-License-Identifier: MIT
/*
 * test_rank_tally.c - counters of ranks: what was given, what came back, and
 * for how long an answer is owed
 */
#include "tests/unit/check.h"

#include <time.h>

#include "base/clock.h"
#include "render/cluster/rank_tally.h"

#define MS_NS UINT64_C(1000000)

static void pause_ms(long ms)
{
    nanosleep(&(struct timespec){.tv_nsec = ms * 1000000}, NULL);
}

/* Times are at most those that the clock shows from outside. */
static void only_time_with_work_counts(void **state)
{
    struct rank_tally t = {0};
    struct rank_progress p;
    uint64_t begin_ns;

    (void)state;
    rank_tally_begin(&t);
    pause_ms(20);
    assert_int_equal(rank_tally_read(&t).silent_ns, 0);
    begin_ns = clock_ns();
    rank_tally_give(&t);
    rank_tally_give(&t);
    pause_ms(20);
    p = rank_tally_read(&t);
    assert_in_range(p.silent_ns, 20 * MS_NS, clock_ns() - begin_ns);
    rank_tally_take(&t, 100);
    p = rank_tally_read(&t);
    assert_int_equal(p.answers, 1);
    assert_int_equal(p.samples, 100);
    assert_in_range(p.busy_ns, 20 * MS_NS, clock_ns() - begin_ns);
    /* now it is silent since its answer */
    assert_in_range(p.silent_ns, 1, clock_ns() - begin_ns - p.busy_ns);
    rank_tally_take(&t, 11);
    begin_ns = clock_ns() - begin_ns;
    pause_ms(20);
    p = rank_tally_read(&t);
    assert_int_equal(p.answers, 2);
    assert_int_equal(p.samples, 111);
    assert_int_equal(p.silent_ns, 0);
    assert_in_range(p.busy_ns, 20 * MS_NS, begin_ns);
}

/* A band that was given before still has to be answered, but its time before
 * the new picture is not that of the new one. */
static void new_pictures_begin_at_zero(void **state)
{
    struct rank_tally t = {0};
    struct rank_progress p;
    uint64_t begin_ns;

    (void)state;
    rank_tally_give(&t);
    rank_tally_give(&t);
    rank_tally_take(&t, 5);
    pause_ms(20);
    begin_ns = clock_ns();
    rank_tally_begin(&t);
    pause_ms(2);
    p = rank_tally_read(&t);
    assert_int_equal(p.samples, 0);
    assert_int_equal(p.answers, 0);
    assert_in_range(p.silent_ns, 2 * MS_NS, clock_ns() - begin_ns);
    rank_tally_take(&t, 0);
    p = rank_tally_read(&t);
    assert_int_equal(p.silent_ns, 0);
    assert_in_range(p.busy_ns, 2 * MS_NS, clock_ns() - begin_ns);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_time_with_work_counts),
        cmocka_unit_test(new_pictures_begin_at_zero),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
