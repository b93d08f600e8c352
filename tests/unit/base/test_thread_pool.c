// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <sched.h>
#include <string.h>
#include <time.h>

#include "base/thread_pool.h"

#define ITEMS 10000

struct tally {
    atomic_int runs[ITEMS];
    atomic_int total;
    struct cancel *cancel;
    int cancel_at;
    int last_at; /* the first item ends when this many have begun; 0: at once */
};

static void count_item(void *context, uint32_t item, int worker)
{
    struct tally *t = context;

    (void)worker;
    atomic_fetch_add(&t->runs[item], 1);
    if (atomic_fetch_add(&t->total, 1) + 1 >= t->cancel_at && t->cancel_at != 0)
        cancel_request(t->cancel);
    while (item == 0 && atomic_load(&t->total) < t->last_at)
        sched_yield();
}

/* While the first item lasts, other workers steal the rest of its worker's
 * items. */
static void each_item_runs_once(void **state)
{
    static struct tally t;
    struct cancel cancel = {0};
    struct error err;

    (void)state;
    for (int threads = 1; threads <= 16; threads = threads * 2 + 1) {
        struct pool *pool = pool_create(threads, &err);

        assert_non_null(pool);
        assert_int_equal(pool_thread_count(pool), threads);
        for (uint32_t count = 0; count <= ITEMS; count = count * 4 + 1) {
            memset(&t, 0, sizeof t);
            t.last_at = threads > 1 ? (int)count : 0;
            t.cancel = &cancel;
            assert_true(pool_run(pool, count, count_item, &t, &cancel));
            for (uint32_t i = 0; i < ITEMS; i++)
                assert_int_equal(atomic_load(&t.runs[i]), i < count ? 1 : 0);
        }
        pool_destroy(pool);
    }
}

static void cancelling_starts_no_more(void **state)
{
    static struct tally t;
    struct cancel cancel = {0};
    struct error err;
    struct pool *pool = pool_create(4, &err);

    (void)state;
    assert_non_null(pool);
    for (int round = 0; round < 100; round++) {
        memset(&t, 0, sizeof t);
        t.cancel = &cancel;
        t.cancel_at = 50;
        cancel_reset(&cancel);
        assert_false(pool_run(pool, ITEMS, count_item, &t, &cancel));
        /* Each of the other workers may have one item in progress. */
        assert_in_range(atomic_load(&t.total), 50, 53);
    }
    cancel_reset(&cancel);
    t.cancel_at = 0;
    memset(t.runs, 0, sizeof t.runs);
    assert_true(pool_run(pool, ITEMS, count_item, &t, &cancel));
    pool_destroy(pool);
    pool_destroy(NULL);
}

#define BURN_NS UINT64_C(30000000)

static uint64_t read_clock(clockid_t clock)
{
    struct timespec t;

    assert_int_equal(clock_gettime(clock, &t), 0);
    return (uint64_t)t.tv_sec * UINT64_C(1000000000) + (uint64_t)t.tv_nsec;
}

static void burn(void *context, uint32_t item, int worker)
{
    uint64_t until_ns = read_clock(CLOCK_THREAD_CPUTIME_ID) + BURN_NS;

    (void)context;
    (void)item;
    (void)worker;
    while (read_clock(CLOCK_THREAD_CPUTIME_ID) < until_ns)
        continue;
}

static uint64_t used_ns(const struct pool *pool)
{
    return pool_cpu_ns(pool, 0) + pool_cpu_ns(pool, 1);
}

/* The processor time of the workers is that of their items, and a part of the
 * process's. It stands still while the workers are parked and another thread
 * uses time. The test tries again if the workers have not parked yet. */
static void processor_time_is_that_of_the_items(void **state)
{
    struct cancel cancel = {0};
    struct error err;
    uint64_t begin_ns = read_clock(CLOCK_PROCESS_CPUTIME_ID);
    struct pool *pool = pool_create(2, &err);
    uint64_t parked_ns;
    int tries = 0;

    (void)state;
    assert_non_null(pool);
    assert_true(pool_run(pool, 6, burn, NULL, &cancel));
    assert_true(used_ns(pool) >= 6 * BURN_NS);
    assert_true(used_ns(pool) <=
                read_clock(CLOCK_PROCESS_CPUTIME_ID) - begin_ns);
    do {
        parked_ns = used_ns(pool);
        burn(NULL, 0, 0);
        assert_true(tries++ < 100);
    } while (used_ns(pool) != parked_ns);
    pool_destroy(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(processor_time_is_that_of_the_items),
        cmocka_unit_test(each_item_runs_once),
        cmocka_unit_test(cancelling_starts_no_more),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
