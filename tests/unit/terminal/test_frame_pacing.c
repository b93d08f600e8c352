// SPDX-License-Identifier: MIT
/*
 * test_frame_pacing.c - pacing over a simulated line with a bandwidth and a
 * latency
 *
 * The measure is the backlog, for which a key would wait.
 */
#include "tests/unit/check.h"

#include "terminal/frame_pacing.h"

#define MS  UINT64_C(1000000)
#define SEC UINT64_C(1000000000)

struct line {
    double bytes_per_s;
    uint64_t way_ns;  /* round trip time */
    uint64_t free_ns; /* time when all bytes written so far have been sent */
};

/* Returns the time when the answer to a request behind these bytes arrives. */
static uint64_t line_send(struct line *l, uint64_t now_ns, size_t bytes)
{
    if (l->free_ns < now_ns)
        l->free_ns = now_ns;
    l->free_ns += (uint64_t)((double)bytes / l->bytes_per_s * 1e9);
    return l->free_ns + l->way_ns;
}

/* Draws frames of `want` bytes for ten seconds, as often as the pacing allows.
 * Returns the longest backlog of the line after the first frame. */
static uint64_t longest_backlog(struct line *l, size_t want,
                                double *bytes_per_s)
{
    uint64_t now_ns = SEC;
    uint64_t first_ns = line_send(l, now_ns, 50);
    uint64_t answer_ns = 0;
    uint64_t worst_ns = 0;
    size_t total = 0;
    struct frame_pacing p;

    frame_pacing_init(&p, now_ns);
    for (; now_ns < 11 * SEC; now_ns += MS) {
        if (first_ns && now_ns >= first_ns) {
            frame_pacing_answer(&p, first_ns);
            first_ns = 0;
        }
        if (answer_ns && now_ns >= answer_ns) {
            frame_pacing_answer(&p, answer_ns);
            answer_ns = 0;
        }
        frame_pacing_tick(&p, now_ns);
        if (!frame_pacing_may_send(&p))
            continue;
        size_t size = want < p.budget_bytes ? want : p.budget_bytes;
        bool asks = frame_pacing_wants_request(&p);
        answer_ns = line_send(l, now_ns, size);
        frame_pacing_sent(&p, size, asks, now_ns, now_ns);
        total += size;
        if (total > size && l->free_ns - now_ns > worst_ns)
            worst_ns = l->free_ns - now_ns;
    }
    *bytes_per_s = (double)total / 10;
    return worst_ns;
}

/* Over 256 kbit/s and 200 ms a key waits for at most 0.3 s of output. */
static void slow_line_has_no_backlog(void **state)
{
    struct line l = {.bytes_per_s = 32000, .way_ns = 200 * MS};
    double rate;

    (void)state;
    check_at_most((double)longest_backlog(&l, 400000, &rate) * 1e-9, 0.3);
    assert_true(rate > 8000); /* a quarter of the bandwidth */
}

/* The first answers are late, since the terminal is busy. All answers vary by
 * some milliseconds. Small frames come first, then a large picture. */
static void early_answers_make_no_fast_line(void **state)
{
    struct line l = {.bytes_per_s = 32000, .way_ns = 200 * MS};
    struct frame_pacing p;
    uint64_t now_ns = SEC;
    uint64_t worst_ns = 0;
    uint32_t noise = 1;

    (void)state;
    frame_pacing_init(&p, now_ns);
    frame_pacing_answer(&p, line_send(&l, now_ns, 50) + 400 * MS);
    for (int i = 0; i < 200; i++) {
        size_t want = i < 100 ? 1200 : 400000;
        size_t size = want < p.budget_bytes ? want : p.budget_bytes;
        uint64_t answer_ns;

        assert_true(frame_pacing_may_send(&p));
        answer_ns = line_send(&l, now_ns, size);
        noise = noise * 1664525u + 1013904223u;
        answer_ns += noise % 40 * MS;
        frame_pacing_sent(&p, size, true, now_ns, now_ns);
        if (i >= 100 && l.free_ns - now_ns > worst_ns)
            worst_ns = l.free_ns - now_ns;
        frame_pacing_answer(&p, answer_ns);
        now_ns = answer_ns + MS;
    }
    check_at_most((double)worst_ns * 1e-9, 0.3);
}

/* Sends 200 frames of this size, whose answers are up to 40 ms late at random,
 * the first one 16 ms. Returns the bytes of the last frame. */
static size_t last_of_late(struct line *l, size_t want)
{
    struct frame_pacing p;
    uint64_t now_ns = SEC;
    uint32_t noise = 1;
    size_t size = 0;

    frame_pacing_init(&p, now_ns);
    frame_pacing_answer(&p, line_send(l, now_ns, 50) + 16 * MS);
    for (int i = 0; i < 200; i++) {
        uint64_t answer_ns;

        size = want < p.budget_bytes ? want : p.budget_bytes;
        answer_ns = line_send(l, now_ns, size);
        noise = noise * 1664525u + 1013904223u;
        answer_ns += (noise >> 16) % 40 * MS;
        frame_pacing_sent(&p, size, true, now_ns, now_ns);
        frame_pacing_answer(&p, answer_ns);
        now_ns = answer_ns + MS;
    }
    return size;
}

/* On a busy machine a local line still carries whole frames. */
static void late_answers_make_no_slow_line(void **state)
{
    struct line fast = {.bytes_per_s = 50e6, .way_ns = MS / 5};
    struct line far = {.bytes_per_s = 50e6, .way_ns = 200 * MS};

    (void)state;
    assert_int_equal(last_of_late(&fast, 400000), 400000);
    assert_int_equal(last_of_late(&far, 400000), 400000);
}

static void fast_line_is_not_held_back(void **state)
{
    struct line l = {.bytes_per_s = 50e6, .way_ns = MS / 5};
    double rate;

    (void)state;
    longest_backlog(&l, 400000, &rate);
    assert_true(rate > 10e6); /* 25 full frames per second */
}

static void first_frame_does_not_wait(void **state)
{
    struct frame_pacing p;

    (void)state;
    frame_pacing_init(&p, SEC);
    assert_true(frame_pacing_may_send(&p));
    assert_true(frame_pacing_wants_request(&p));
    frame_pacing_sent(&p, 10000, true, SEC, SEC);
    assert_false(frame_pacing_may_send(&p));
    frame_pacing_answer(&p, SEC + 3 * MS); /* for the first request */
    assert_false(frame_pacing_may_send(&p));
    frame_pacing_answer(&p, SEC + 4 * MS);
    assert_true(frame_pacing_may_send(&p));
    assert_int_equal(p.rtt_min_ns, 3 * MS);
}

static void silent_terminal_is_not_waited_for(void **state)
{
    struct frame_pacing p;

    (void)state;
    frame_pacing_init(&p, SEC);
    frame_pacing_sent(&p, 10000, true, SEC, SEC);
    assert_true(frame_pacing_deadline_ns(&p) <= SEC + 500 * MS);
    frame_pacing_tick(&p, frame_pacing_deadline_ns(&p) - 1);
    assert_false(frame_pacing_may_send(&p));
    frame_pacing_tick(&p, frame_pacing_deadline_ns(&p));
    assert_true(frame_pacing_may_send(&p));
    assert_false(frame_pacing_wants_request(&p));
    assert_true(frame_pacing_deadline_ns(&p) == UINT64_MAX);
    for (int i = 0; i < 100; i++) {
        frame_pacing_sent(&p, 10000, false, SEC, SEC + 1000);
        assert_true(frame_pacing_may_send(&p));
    }
    /* A blocking write() shows how slow the line is: 0.08 s of 100 kB/s. */
    for (int i = 0; i < 30; i++)
        frame_pacing_sent(&p, 10000, false, SEC, SEC + 100 * MS);
    check_close((double)p.budget_bytes, 8000, 200);
    frame_pacing_answer(&p, 3 * SEC); /* it answers after all */
    assert_true(frame_pacing_wants_request(&p));
    assert_true(frame_pacing_may_send(&p));
}

static void lost_answers_are_given_up(void **state)
{
    struct frame_pacing p;

    (void)state;
    frame_pacing_init(&p, SEC);
    frame_pacing_answer(&p, SEC + MS);
    frame_pacing_sent(&p, 5000, true, 2 * SEC, 2 * SEC);
    frame_pacing_tick(&p, 6 * SEC);
    assert_false(frame_pacing_may_send(&p));
    frame_pacing_tick(&p, 7 * SEC);
    assert_true(frame_pacing_may_send(&p));
    frame_pacing_sent(&p, 5000, false, 7 * SEC, 7 * SEC);
    frame_pacing_answer(&p, 8 * SEC); /* late */
    assert_true(frame_pacing_may_send(&p));
    frame_pacing_answer(&p, 8 * SEC); /* later, without a request */
    assert_true(frame_pacing_may_send(&p));
    assert_int_equal(p.outstanding, 0);
}

static void slow_lines_are_recognised(void **state)
{
    struct frame_pacing p;

    (void)state;
    frame_pacing_init(&p, SEC);
    assert_false(frame_pacing_is_slow(&p));
    frame_pacing_answer(&p, SEC + MS);
    frame_pacing_sent(&p, 10000, true, SEC, SEC);
    frame_pacing_answer(&p, SEC + 300 * MS);
    assert_true(frame_pacing_is_slow(&p));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_line_has_no_backlog),
        cmocka_unit_test(early_answers_make_no_fast_line),
        cmocka_unit_test(late_answers_make_no_slow_line),
        cmocka_unit_test(fast_line_is_not_held_back),
        cmocka_unit_test(first_frame_does_not_wait),
        cmocka_unit_test(silent_terminal_is_not_waited_for),
        cmocka_unit_test(lost_answers_are_given_up),
        cmocka_unit_test(slow_lines_are_recognised),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
