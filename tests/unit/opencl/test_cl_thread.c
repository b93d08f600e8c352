// SPDX-License-Identifier: MIT
/*
 * test_cl_thread.c - the thread of a driver's calls: what it does is waited
 * for; if it shows no sign after a halt, and does not compute, it is left, and
 * so is all later work
 */
#include <stdatomic.h>
#include <unistd.h>

#include "base/clock.h"
#include "render/opencl/cl_thread.h"
#include "tests/unit/check.h"

/* The clocks of the test are faster than real ones. */
#define HASTE 10

/* The linker sends calls of the clocks here (--wrap in tests.mk). */
uint64_t __real_clock_ns(void);
uint64_t __real_clock_cpu_ns(void);
uint64_t __wrap_clock_ns(void);
uint64_t __wrap_clock_ns(void)
{
    return HASTE * __real_clock_ns();
}
uint64_t __wrap_clock_cpu_ns(void);
uint64_t __wrap_clock_cpu_ns(void)
{
    return HASTE * __real_clock_cpu_ns();
}

struct work {
    struct cl_thread thread;
    atomic_bool may_end; /* of a call that does not return */
    atomic_int calls, beats;
    bool was_wanted;
};

static void count(void *context)
{
    struct work *w = context;

    atomic_fetch_add(&w->calls, 1);
}

static void work_is_waited_for(void **state)
{
    const struct cancel at_once = {.requested = 1};
    struct work w = {.calls = 0};
    struct error err;

    (void)state;
    assert_true(cl_thread_init(&w.thread, &err));
    for (int i = 1; i <= 1000; i++) {
        assert_true(
            cl_thread_run(&w.thread, count, &w, i % 2 ? &at_once : NULL));
        assert_int_equal(w.calls, i);
    }
    assert_true(cl_thread_beat(&w.thread));
    assert_false(cl_thread_is_left(&w.thread));
    cl_thread_end(&w.thread);
}

/* Shows signs for longer than a halt waits. */
static void beat(void *context)
{
    struct work *w = context;

    for (int i = 0; i < 24; i++) {
        usleep(500000 / HASTE);
        w->was_wanted = cl_thread_beat(&w->thread);
    }
    atomic_fetch_add(&w->calls, 1);
}

/* Computes, as a compiler does, for longer than a halt waits. */
static void compute(void *context)
{
    struct work *w = context;
    uint64_t end_ns = clock_ns() + UINT64_C(25000000000);

    while (clock_ns() < end_ns)
        ;
    atomic_fetch_add(&w->calls, 1);
}

/* A call that returns late. */
static void hang(void *context)
{
    struct work *w = context;

    while (!atomic_load(&w->may_end))
        usleep(1000);
    w->was_wanted = cl_thread_beat(&w->thread);
    atomic_fetch_add(&w->calls, 1);
}

static void silent_drivers_are_left(void **state)
{
    const struct cancel at_once = {.requested = 1};
    struct work w = {.was_wanted = false};
    struct error err;

    (void)state;
    assert_true(cl_thread_init(&w.thread, &err));
    assert_true(cl_thread_run(&w.thread, beat, &w, &at_once));
    assert_true(w.was_wanted);
    assert_int_equal(w.calls, 1);
    assert_true(cl_thread_run(&w.thread, compute, &w, &at_once));
    assert_int_equal(w.calls, 2);
    assert_false(cl_thread_run(&w.thread, hang, &w, &at_once));
    assert_true(cl_thread_is_left(&w.thread));
    assert_false(cl_thread_run(&w.thread, count, &w, NULL));
    atomic_store(&w.may_end, true);
    for (int i = 0; i < 10000 && w.calls < 3; i++)
        usleep(1000);
    assert_int_equal(w.calls, 3);
    assert_false(w.was_wanted);
    usleep(100000); /* until the thread is over */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(work_is_waited_for),
        cmocka_unit_test(silent_drivers_are_left),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
