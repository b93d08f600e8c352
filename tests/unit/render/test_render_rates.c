// SPDX-License-Identifier: MIT
/*
 * test_speeds.c - at any time the spans together have all samples, and those of
 * a steady render all have its speed
 */
#include "tests/unit/check.h"

#include "render/progress.h"

#define S_NS UINT64_C(1000000000)

static double total_of(const struct speeds *s)
{
    double sum = 0;

    for (int i = 0; i < s->count; i++)
        sum += s->samples[i];
    return sum;
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static void steady_renders_have_one_speed(void **state)
{
    struct speeds s = {0};
    uint64_t time_ns = 0;
    uint32_t random = 1;

    (void)state;
    /* A thousand samples per second, queried at random times, for hours. */
    for (int i = 0; i < 20000; i++) {
        time_ns += 1000000 * (uint64_t)(1 + next_random(&random) % 2000);
        speeds_update(&s, time_ns, time_ns / 1000000);
        assert_true(s.count <= SPEEDS_MAX);
        if (i % 100 != 0)
            continue;
        check_close(total_of(&s), (double)(time_ns / 1000000), 1e-3);
        for (int k = 0; k < s.count; k++)
            check_close(speeds_at(&s, k), 1000, 1e-6);
    }
    assert_true(time_ns > 4 * 3600 * S_NS);
    /* The spans cover the time, and no more than necessary. */
    assert_true((uint64_t)s.count * s.span_ns >= time_ns);
    assert_true((uint64_t)(s.count - 1) * s.span_ns <= time_ns);
    assert_true(s.count > SPEEDS_MAX / 2 - 1);
}

static void spans_have_the_samples_of_their_time(void **state)
{
    struct speeds s = {0};

    (void)state;
    speeds_update(&s, S_NS / 2, 100); /* 200 per second in two spans */
    speeds_update(&s, S_NS, 1100);    /* 2000 per second in the next two */
    assert_int_equal(s.span_ns, S_NS / 4);
    assert_int_equal(s.count, 4);
    check_close(speeds_at(&s, 0), 200, 1e-9);
    check_close(speeds_at(&s, 1), 200, 1e-9);
    check_close(speeds_at(&s, 2), 2000, 1e-9);
    check_close(speeds_at(&s, 3), 2000, 1e-9);
    speeds_update(&s, S_NS + S_NS / 8, 1100); /* half a span without samples */
    assert_int_equal(s.count, 5);
    check_close(speeds_at(&s, 4), 0, 0);
}

static void two_spans_are_merged(void **state)
{
    struct speeds s = {0};
    uint64_t samples = 0;

    (void)state;
    for (int i = 0; i < SPEEDS_MAX; i++) {
        samples += i % 2 ? 300 : 100;
        speeds_update(&s, (uint64_t)(i + 1) * S_NS / 4, samples);
    }
    assert_int_equal(s.count, SPEEDS_MAX);
    check_close(speeds_at(&s, 1), 1200, 1e-9);
    speeds_update(&s, SPEEDS_MAX * S_NS / 4 + 1, samples);
    assert_int_equal(s.span_ns, S_NS / 2);
    assert_int_equal(s.count, SPEEDS_MAX / 2 + 1);
    for (int i = 0; i < SPEEDS_MAX / 2; i++)
        check_close(speeds_at(&s, i), 800, 1e-9);
}

/* Two queries at one time lose nothing; a restart forgets everything. */
static void queries_at_one_time_lose_nothing(void **state)
{
    struct speeds s = {0};

    (void)state;
    speeds_update(&s, 0, 0);
    assert_int_equal(s.count, 0);
    speeds_update(&s, S_NS / 8, 10);
    speeds_update(&s, S_NS / 8, 20);
    speeds_update(&s, S_NS / 4, 30);
    check_close(total_of(&s), 30, 1e-9);
    speeds_update(&s, S_NS / 8, 5);
    assert_int_equal(s.count, 1);
    check_close(total_of(&s), 5, 1e-9);
    check_close(speeds_at(&s, 0), 40, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steady_renders_have_one_speed),
        cmocka_unit_test(spans_have_the_samples_of_their_time),
        cmocka_unit_test(two_spans_are_merged),
        cmocka_unit_test(queries_at_one_time_lose_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
