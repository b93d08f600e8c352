// SPDX-License-Identifier: MIT
/*
 * The pace against a line that is simulated: it carries so many bytes a second
 * and takes a time for the way. What a key would wait is what the pace is for.
 */
#include "tests/unit/check.h"

#include "terminal/frame_pacing.h"

#define MS  UINT64_C(1000000)
#define SEC UINT64_C(1000000000)

struct line {
    double bytes_per_s;
    uint64_t way_ns;  /* there and back together */
    uint64_t free_ns; /* when all that was written has been carried */
};

/* When the answer to a request at the end of these bytes is back. */
static uint64_t line_send(struct line *l, uint64_t now_ns, size_t bytes)
{
    if (l->free_ns < now_ns)
        l->free_ns = now_ns;
    l->free_ns += (uint64_t)((double)bytes / l->bytes_per_s * 1e9);
    return l->free_ns + l->way_ns;
}

/* Draws for ten seconds a picture that wants `want` bytes a frame, as often as
 * the pace lets it. The longest backlog of the line after the first frame. */
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

/* 256 kbit/s, 200 ms: a key waits for 0.3 s of output at most. */
static void slow_line_has_no_backlog(void **state)
{
    struct line l = {.bytes_per_s = 32000, .way_ns = 200 * MS};
    double rate;

    (void)state;
    check_at_most((double)longest_backlog(&l, 400000, &rate) * 1e-9, 0.3);
    assert_true(rate > 8000); /* a quarter of what the line could carry */
}

/* The first answers are late, for the terminal is busy, and all come some
 * milliseconds sooner or later; small frames, then a large picture. */
static void lucky_answers_make_no_fast_line(void **state)
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

/* Frames of this size over the line, whose answers come up to 40 ms late by
 * chance, the first one by 16 ms; the bytes of the last of 200. */
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

/* On a busy machine: the line next to the program carries whole frames. */
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
    assert_true(rate > 10e6); /* 25 full frames a second */
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
    frame_pacing_answer(&p, SEC + 3 * MS); /* to the first request */
    assert_false(frame_pacing_may_send(&p));
    frame_pacing_answer(&p, SEC + 4 * MS);
    assert_true(frame_pacing_may_send(&p));
    assert_int_equal(p.rtt_min_ns, 3 * MS);
}

static void mute_terminal_is_not_waited_for(void **state)
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
    /* a write() that blocks says how slow it is: 0.08 s of 100 kB/s */
    for (int i = 0; i < 30; i++)
        frame_pacing_sent(&p, 10000, false, SEC, SEC + 100 * MS);
    check_close((double)p.budget_bytes, 8000, 200);
    frame_pacing_answer(&p, 3 * SEC); /* it speaks after all */
    assert_true(frame_pacing_wants_request(&p));
    assert_true(frame_pacing_may_send(&p));
}

static void lost_answer_is_given_up(void **state)
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
    frame_pacing_answer(&p, 8 * SEC); /* later: nothing was asked */
    assert_true(frame_pacing_may_send(&p));
    assert_int_equal(p.outstanding, 0);
}

static void slowness_is_known(void **state)
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
        cmocka_unit_test(lucky_answers_make_no_fast_line),
        cmocka_unit_test(late_answers_make_no_slow_line),
        cmocka_unit_test(fast_line_is_not_held_back),
        cmocka_unit_test(first_frame_does_not_wait),
        cmocka_unit_test(mute_terminal_is_not_waited_for),
        cmocka_unit_test(lost_answer_is_given_up),
        cmocka_unit_test(slowness_is_known),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
