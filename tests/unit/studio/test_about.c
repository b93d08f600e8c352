// SPDX-License-Identifier: MIT
/*
 * test_about.c - the window about the render has lines of at most the same
 * number of columns, for all numbers
 */
#include "tests/unit/check.h"

#include <stdlib.h>

#include "base/print.h"
#include "studio/about_window.h"

#define S_NS UINT64_C(1000000000)

static char lines[ABOUT_ROWS][ABOUT_BYTES];

/* Facts of two threads. */
static struct about_facts facts_of(const struct render_progress *p)
{
    return (struct about_facts){.progress = p,
                                .thread_count = 2,
                                .load = 0.75,
                                .width_px = 640,
                                .height_px = 480,
                                .glyphs = "quadrants",
                                .colors = "24 bit"};
}

static void numbers_are_short(void **state)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {
        {0, "0 "},         {7.4, "7 "},          {999.4, "999 "},
        {999.6, "1.00 k"}, {9994, "9.99 k"},     {9996, "10.0 k"},
        {99960, "100 k"},  {123456, "123 k"},    {1234567, "1.23 M"},
        {1e9, "1.00 G"},   {12.34e12, "12.3 T"}, {1e18, "1.00 E"},
    };
    char text[16];

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        about_number(text, sizeof text, cases[i].value);
        assert_string_equal(text, cases[i].text);
    }
}

static void half_done_renders_show_their_progress(void **state)
{
    struct render_progress p = {.state = RENDER_RUNNING,
                                .spp_limit = 1000,
                                .spp_done = 250,
                                .samples = 25000000,
                                .samples_limit = 100000000,
                                .rays = 200000000,
                                .render_ns = 100 * S_NS};
    struct about_facts f = facts_of(&p);

    (void)state;
    assert_int_equal(about_format(lines, &f), ABOUT_USUAL_ROWS);
    assert_string_equal(lines[0], "CPU, 2 threads                 busy 75 %");
    assert_string_equal(lines[1], "640x480 pixels           250 of 1000 spp");
    assert_string_equal(lines[2], "samples    25.0 M         250 ksamples/s");
    assert_string_equal(lines[3], "rays        200 M           2.00 Mrays/s");
    assert_string_equal(lines[4], "noise                            unknown");
    assert_string_equal(lines[5], "1:40 of rendering              left 5:00");
    assert_string_equal(lines[6], "quadrants                         24 bit");
    p.film_error = (struct film_error){true, true, 0.023, 0.0222, 0.0239};
    about_format(lines, &f);
    assert_string_equal(lines[4], "noise               2.3 % (2.2 to 2.4 %)");
    p.film_error.is_resolved = false;
    about_format(lines, &f);
    assert_string_equal(lines[4], "noise, few pixels   2.3 % (2.2 to 2.4 %)");
    p = (struct render_progress){.state = RENDER_IDLE};
    f.device = "Some device";
    about_format(lines, &f);
    check_has(lines[0], "OpenCL Some device ");
    assert_string_equal(lines[1], "640x480 pixels                     0 spp");
    assert_string_equal(lines[5], "0 s of rendering                no limit");
}

/* Tests random values up to the greatest possible. */
static void lines_have_room(void **state)
{
    (void)state;
    for (int bits = 0; bits < 64; bits++) {
        uint64_t big = UINT64_MAX >> bits;
        struct render_progress p = {.state = RENDER_RUNNING,
                                    .spp_limit = big / 3,
                                    .spp_done = big / 4,
                                    .samples = big / 2,
                                    .samples_limit = big,
                                    .rays = big,
                                    .render_ns = big};
        struct rank_progress ranks[] = {{big, 1, 1, 0}, {0, 0, 0, big}};
        struct about_facts f = facts_of(&p);
        int row_count;

        f.width_px = f.height_px = 1 << 20;
        f.thread_count = 1 + bits * 16;
        f.device =
            bits & 1 ? "A device whose name is longer than it has to be" : NULL;
        f.ranks = ranks;
        f.rank_count = 2;
        row_count = about_format(lines, &f);
        assert_int_equal(row_count, ABOUT_USUAL_ROWS + 3);
        for (int i = 0; i < row_count; i++)
            assert_in_range(text_width_of(lines[i]), 1, ABOUT_COLS);
    }
}

/* Of 100 ranks rank 70 is late, and ranks 93 to 99 are the slowest. */
static void late_and_slow_ranks_are_shown(void **state)
{
    static struct rank_progress ranks[100];
    struct render_progress p = {.state = RENDER_RUNNING};
    struct about_facts f = facts_of(&p);

    (void)state;
    f.ranks = ranks;
    f.rank_count = 2;
    for (int i = 0; i < 100; i++)
        ranks[i] = (struct rank_progress){(uint64_t)(2000 - i) * 1000, 20,
                                          2 * S_NS, S_NS / 2};
    assert_int_equal(about_format(lines, &f), 10);
    assert_string_equal(lines[7], "2 ranks                                 ");
    assert_string_equal(lines[8], "rank 0      2.00 M              1.00 M/s");
    assert_string_equal(lines[9], "rank 1      2.00 M              1.00 M/s");
    f.rank_count = 100;
    assert_int_equal(about_format(lines, &f), ABOUT_ROWS);
    assert_string_equal(lines[7], "100 ranks                  the slowest 8");
    assert_string_equal(lines[8], "rank 92     1.91 M               954 k/s");
    /* 20 times its usual tenth of a second is 2 s */
    ranks[70].silent_ns = 75 * S_NS;
    about_format(lines, &f);
    assert_string_equal(lines[7], "100 ranks                         1 late");
    assert_string_equal(lines[8], "rank 70     1.93 M             late 1:15");
    assert_string_equal(lines[9], "rank 93     1.91 M               954 k/s");
    assert_string_equal(lines[15], "rank 99     1.90 M               950 k/s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_short),
        cmocka_unit_test(half_done_renders_show_their_progress),
        cmocka_unit_test(lines_have_room),
        cmocka_unit_test(late_and_slow_ranks_are_shown),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
