// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <unistd.h>

#include "base/clock.h"
#include "terminal/screen.h"

/* An answer that was read together with the last key is not waited for: what
 * follows it on standard input is not read. */
static void answers_that_were_read_are_not_awaited(void **state)
{
    const struct term_caps_choice choice = {0};
    struct tty_input input = {0};
    struct screen screen;
    char next = 0;
    int ends[2];

    (void)state;
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(dup2(ends[0], STDIN_FILENO), STDIN_FILENO);
    assert_int_equal(write(ends[1], "x", 1), 1);
    close(ends[1]);
    screen_init(&screen, &choice);
    screen.has_all_answers = true;
    frame_pacing_answer(&screen.pace, clock_ns());
    frame_pacing_sent(&screen.pace, 1, true, clock_ns(), clock_ns());
    assert_int_equal(screen.pace.outstanding, 1);
    tty_input_feed(&input, "\033[0n", 4);
    screen_drain(&screen, &input);
    assert_int_equal(screen.pace.outstanding, 0);
    assert_int_equal(read(STDIN_FILENO, &next, 1), 1);
    assert_int_equal(next, 'x');
    screen_free(&screen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_that_were_read_are_not_awaited),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
