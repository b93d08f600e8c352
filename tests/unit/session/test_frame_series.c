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
    struct render_left left = {RENDER_LIMIT_SPP, 3e9, 0.5}, all;

    (void)state;
    assert_int_equal(frame_series_count(&f), 4);
    assert_int_equal(frame_series_done(&f), 2);
    all = frame_series_left(&f, left, 124 * second_ns);
    check_close(all.part, 2.5 / 4, 1e-12);
    check_close(all.ns, (3 + 10) * 1e9, 1);
    left.limit = RENDER_LIMIT_NONE; /* not known yet */
    left.ns = 0;
    all = frame_series_left(&f, left, 124 * second_ns);
    check_close(all.ns, (6 + 10) * 1e9, 1);
    /* the first frame is all that is known of the others */
    f.present = 4;
    f.frame_begin_ns = f.begin_ns;
    all = frame_series_left(&f, left, 101 * second_ns);
    assert_int_equal(all.limit, RENDER_LIMIT_NONE);
    left.limit = RENDER_LIMIT_TIME;
    left.ns = 4e9;
    all = frame_series_left(&f, left, 101 * second_ns);
    check_close(all.ns, (4 + 3 * 5) * 1e9, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_go_into_names),
        cmocka_unit_test(the_time_left_is_that_of_all_frames),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
