// SPDX-License-Identifier: MIT
/*
 * test_stop.c - a process that a signal asks to end: how long it goes on, and
 * with which status it ends, whatever it does
 */
#include "tests/unit/check.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/stop.h"

/* The thread sanitizer sleeps for a second at the end of a program. */
const char *__tsan_default_options(void);
const char *__tsan_default_options(void)
{
    return "atexit_sleep_ms=0";
}

static void on_signal(int number)
{
    stop_request(128 + number, true);
}

static void pause_s(double seconds)
{
    struct timespec t = {(time_t)seconds,
                         (long)((seconds - (double)(time_t)seconds) * 1e9)};

    while (nanosleep(&t, &t) != 0)
        continue;
}

static void work(double seconds)
{
    uint64_t end_ns = clock_ns() + (uint64_t)(seconds * 1e9);

    while (clock_ns() < end_ns)
        pause_s(0.001); /* here the thread sanitizer delivers signals */
}

/* Writes to a pipe that nobody reads. */
static void fill_pipe(void)
{
    static const char bytes[1 << 20];
    int ends[2];

    if (pipe(ends) == 0)
        file_write_pipe(ends[1], bytes, sizeof bytes);
}

static void says_so(void)
{
    static const char text[] = "last";

    if (write(STDOUT_FILENO, text, sizeof text - 1) < 0)
        abort();
}

/* ---- what the process does; it ends by itself with status 3 ---- */

static void build_a_tree(void)
{
    work(20);
}

static void write_a_stalled_picture(void)
{
    stop_hold();
    fill_pipe();
}

/* Longer than STOP_MS. */
static void write_a_large_picture(void)
{
    stop_hold();
    work(1.5);
    stop_release();
}

static void write_for_ever(void)
{
    stop_hold();
    work(20);
}

/* A reader that takes a little from time to time. */
static void write_to_a_slow_reader(void)
{
    stop_hold();
    for (int i = 0; i < 6; i++) {
        stop_allow_begin();
        pause_s(0.3);
        stop_allow_end();
    }
    stop_release();
}

/* The end of a picture that took long is no end of the time to clean up. */
static void clean_up_after_a_picture(void)
{
    write_a_large_picture();
    work(0.2);
}

/* ---- tests ---- */

/* Runs it, sends the signals, so many seconds apart, and returns the status and
 * the time from the first of them. */
static int run(void (*act)(void), int count, double apart_s, double *seconds)
{
    pid_t child = fork();
    uint64_t begin_ns;
    int status;

    if (child == 0) {
        struct sigaction action = {.sa_handler = on_signal,
                                   .sa_flags = SA_RESTART};
        struct error err;

        if (!stop_begin(&err))
            _exit(4);
        sigaction(SIGTERM, &action, NULL);
        sigaction(SIGINT, &action, NULL);
        act();
        _exit(3);
    }
    assert_true(child > 0);
    pause_s(0.2);
    begin_ns = clock_ns();
    for (int i = 0; i < count; i++) {
        if (i > 0)
            pause_s(apart_s);
        kill(child, i == 0 ? SIGTERM : SIGINT);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    *seconds = seconds_between(begin_ns, clock_ns());
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void every_stage_ends_within_a_second(void **state)
{
    double seconds;

    (void)state;
    assert_int_equal(run(build_a_tree, 1, 0, &seconds), 143);
    assert_true(seconds < 1);
    assert_int_equal(run(write_a_stalled_picture, 1, 0, &seconds), 143);
    assert_true(seconds < 1);
}

static void work_on_files_is_completed(void **state)
{
    double seconds;

    (void)state;
    assert_int_equal(run(write_a_large_picture, 1, 0, &seconds), 3);
    assert_int_equal(run(write_to_a_slow_reader, 1, 0, &seconds), 3);
    assert_int_equal(run(clean_up_after_a_picture, 1, 0, &seconds), 3);
    /* several signals at once are one */
    assert_int_equal(run(write_a_large_picture, 3, 0.05, &seconds), 3);
}

static void a_later_signal_ends_that_too(void **state)
{
    double seconds;

    (void)state;
    assert_int_equal(run(write_for_ever, 2, 1.2, &seconds), 143);
    assert_true(seconds < 1.2 + 0.5);
}

static int pipe_ends[2];

/* Ends the reader, after which the thread would go on to its status. */
static void end_reader(void)
{
    close(pipe_ends[0]);
    pause_s(0.3);
}

static void write_to_a_reader_that_ends(void)
{
    static const char bytes[1 << 20];

    signal(SIGPIPE, SIG_IGN);
    stop_at_end(end_reader);
    if (pipe(pipe_ends) == 0 &&
        !file_write_pipe(pipe_ends[1], bytes, sizeof bytes))
        stop_stay();
}

static void what_the_end_breaks_is_no_failure(void **state)
{
    double seconds;

    (void)state;
    assert_int_equal(run(write_to_a_reader_that_ends, 1, 0, &seconds), 143);
    assert_true(seconds < 1.3);
}

static void end_and_say_so(void)
{
    stop_at_end(says_so);
    work(20);
}

static void last_words_are_heard(void **state)
{
    int ends[2], saved = dup(STDOUT_FILENO);
    char text[8] = "";
    double seconds;

    (void)state;
    assert_int_equal(pipe(ends), 0);
    dup2(ends[1], STDOUT_FILENO);
    run(end_and_say_so, 1, 0, &seconds);
    dup2(saved, STDOUT_FILENO);
    assert_int_equal(read(ends[0], text, sizeof text), 4);
    assert_string_equal(text, "last");
    close(ends[0]);
    close(ends[1]);
    close(saved);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_stage_ends_within_a_second),
        cmocka_unit_test(work_on_files_is_completed),
        cmocka_unit_test(a_later_signal_ends_that_too),
        cmocka_unit_test(last_words_are_heard),
        cmocka_unit_test(what_the_end_breaks_is_no_failure),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
