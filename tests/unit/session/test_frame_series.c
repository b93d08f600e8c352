// SPDX-License-Identifier: MIT
/* Names of frames, and the time left for all of them. */
#include "tests/unit/check.h"

#include <stdlib.h>

#include "session/frame_series.h"

static void check_name(const char *path, int number, const char *want)
{
    char *name = frame_name(path, number);

    assert_string_equal(name, want);
    free(name);
}

static void numbers_go_into_names(void **state)
{
    (void)state;
    check_name("out.png", 0, "out-0000.png");
    check_name("out.png", 12345, "out-12345.png");
    check_name("a.b/out", 7, "a.b/out-0007");
    check_name(".png", 7, ".png-0007");
    check_name("a%d/out.tar.png", 7, "a%d/out.tar-0007.png");
    check_name("%d.png", 7, "7.png");
    check_name("a/f%03d.png", 7, "a/f007.png");
    check_name("100%-%02d.png", 7, "100%-07.png");
    check_name("%s%n%05d%d", 7, "%s%n00007%d");
    check_name("%00d%10d", 7, "%00d%10d-0007");
    check_name("%", 7, "%-0007");
    check_name("%0", 7, "%0-0007");
}

/* Frames 4 to 7 of a series; the present one is 6, after two of 10 s each. */
static void the_time_left_is_that_of_all_frames(void **state)
{
    const uint64_t second_ns = 1000000000;
    struct frame_series f = {.first = 4,
                             .last = 7,
                             .present = 6,
                             .begin_ns = 100 * second_ns,
                             .frame_begin_ns = 120 * second_ns};
    struct glim_progress p = {.part_done = 0.5, .seconds_left = 3}, all;

    (void)state;
    assert_int_equal(frame_series_count(&f), 4);
    assert_int_equal(frame_series_done(&f), 2);
    all = frame_series_progress(&f, &p, 124 * second_ns);
    check_close(all.part_done, 2.5 / 4, 1e-12);
    check_close(all.seconds_left, 3 + 10, 1e-9);
    p.seconds_left = -1; /* not known yet */
    all = frame_series_progress(&f, &p, 124 * second_ns);
    check_close(all.seconds_left, 6 + 10, 1e-9);
    /* the first frame is all that is known of the others */
    f.present = 4;
    f.frame_begin_ns = f.begin_ns;
    all = frame_series_progress(&f, &p, 101 * second_ns);
    assert_true(all.seconds_left < 0);
    p.seconds_left = 4;
    all = frame_series_progress(&f, &p, 101 * second_ns);
    check_close(all.seconds_left, 4 + 3 * 5, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_go_into_names),
        cmocka_unit_test(the_time_left_is_that_of_all_frames),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
