// SPDX-License-Identifier: MIT
/*
 * test_progress_text.c - the panel shows the progress in lines of at most the
 * same number of columns, for all numbers
 */
#include "tests/unit/check.h"

#include <stdlib.h>

#include "studio/progress_panel.h"

#define S_NS UINT64_C(1000000000)

static const struct error_history no_errors;

static char lines[PROGRESS_TEXT_ROWS][PROGRESS_TEXT_BYTES];

static int cols_of(const char *text)
{
    int cols = 0;

    for (; *text; text++)
        cols += ((unsigned char)*text & 0xc0) != 0x80;
    return cols;
}

static void numbers_are_short(void **state)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {
        {0, "0"},          {7.4, "7"},           {999.4, "999"},
        {999.6, "1.00 k"}, {9994, "9.99 k"},     {9996, "10.0 k"},
        {99960, "100 k"},  {123456, "123 k"},    {1234567, "1.23 M"},
        {1e9, "1.00 G"},   {12.34e12, "12.3 T"}, {1e18, "1.00 E"},
    };
    char text[16];

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        progress_text_number(text, sizeof text, cases[i].value);
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
    struct speeds speeds = {0};
    double loads[] = {1, 0.5};
    struct progress_text_facts f = {&p, &speeds, &no_errors, loads,
                                    2,  false,   NULL,       0};

    (void)state;
    speeds_update(&speeds, 100 * S_NS, 25000000);
    progress_text_format(lines, &f);
    assert_string_equal(lines[0], "250 of 1000 spp         25.0 %");
    assert_string_equal(lines[PROGRESS_TEXT_GAUGE], "");
    assert_string_equal(lines[2], "noise                  unknown");
    assert_string_equal(lines[3], "samples    25.0 M      250 k/s");
    assert_string_equal(lines[4], "rays        200 M     2.00 M/s");
    assert_string_equal(lines[5], "elapsed      1:40    left 5:00");
    assert_string_equal(lines[6], "samples/s    250 k, most 250 k");
    assert_string_equal(lines[10], "2 threads            busy 75 %");
    assert_string_equal(lines[11], "@=");
    f.has_unicode = true;
    p.film_error = (struct film_error){true, true, 0.023, 0.0222, 0.0239};
    progress_text_format(lines, &f);
    assert_string_equal(lines[2], "noise     2.3 % (2.2 to 2.4 %)");
    p.film_error.is_resolved = false;
    progress_text_format(lines, &f);
    assert_string_equal(lines[2], "noise, few pixels        2.3 %");
    assert_string_equal(lines[11], "█▄");
}

/* Speeds of 12 twelfths, 6, 0, 3, ... make columns of as many dots, from
 * below. */
static void plots_are_to_scale(void **state)
{
    struct render_progress p = {.state = RENDER_RUNNING};
    struct speeds speeds = {.count = 4, .span_ns = S_NS, .time_ns = 4 * S_NS};
    struct progress_text_facts f = {&p, &speeds, &no_errors, NULL,
                                    0,  true,    NULL,       0};

    (void)state;
    speeds.samples[0] = 1200;
    speeds.samples[1] = 600;
    speeds.samples[2] = 0;
    speeds.samples[3] = 300;
    progress_text_format(lines, &f);
    /* Dots 1 2 3 7 are at the left, 4 5 6 8 at the right of U+2800. */
    assert_true(strncmp(lines[7], "⡇⠀⠀", 9) == 0);
    assert_true(strncmp(lines[8], "⣧⠀⠀", 9) == 0);
    assert_true(strncmp(lines[9], "⣿⢰⠀", 9) == 0);
    f.has_unicode = false;
    progress_text_format(lines, &f);
    assert_true(strncmp(lines[7], "#  ", 3) == 0);
    assert_true(strncmp(lines[8], "#  ", 3) == 0);
    assert_true(strncmp(lines[9], "#| ", 3) == 0);
}

/* Tests random values up to the greatest possible. */
static void lines_have_room(void **state)
{
    static double loads[1024];
    struct speeds speeds = {0};

    (void)state;
    for (int i = 0; i < 1024; i++)
        loads[i] = (i % 9) / 8.0;
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
        struct progress_text_facts f = {
            &p, &speeds, &no_errors, loads, 1 + bits * 16, bits % 2, ranks, 2};
        int row_count;

        speeds_update(&speeds, (uint64_t)bits * S_NS, big);
        row_count = progress_text_format(lines, &f);
        assert_int_equal(row_count, 20);
        for (int i = 0; i < row_count; i++)
            assert_true(cols_of(lines[i]) <= PROGRESS_TEXT_COLS);
    }
}

static void live_mode_device_and_nothing_are_shown(void **state)
{
    struct render_progress p = {.state = RENDER_IDLE};
    struct speeds speeds = {0};
    struct progress_text_facts f = {&p, &speeds, &no_errors, NULL,
                                    0,  true,    NULL,       0};

    (void)state;
    progress_text_format(lines, &f);
    assert_string_equal(lines[0], "0 spp                 no limit");
    assert_string_equal(lines[5], "elapsed       0 s             ");
    assert_string_equal(lines[11], "");
    assert_non_null(strstr(lines[10], "OpenCL"));
}

/* Of 100 ranks rank 70 is late, and ranks 93 to 99 are the slowest. */
static void late_and_slow_ranks_are_shown(void **state)
{
    static struct rank_progress ranks[100];
    struct render_progress p = {.state = RENDER_RUNNING};
    struct speeds speeds = {0};
    struct progress_text_facts f = {&p, &speeds, &no_errors, NULL,
                                    0,  false,   ranks,      2};

    (void)state;
    for (int i = 0; i < 100; i++)
        ranks[i] = (struct rank_progress){(uint64_t)(2000 - i) * 1000, 20,
                                          2 * S_NS, S_NS / 2};
    assert_int_equal(progress_text_format(lines, &f), 20);
    assert_string_equal(lines[17], "2 ranks                       ");
    assert_string_equal(lines[18], "rank 0      2.00 M    1.00 M/s");
    assert_string_equal(lines[19], "rank 1      2.00 M    1.00 M/s");
    f.rank_count = 100;
    assert_int_equal(progress_text_format(lines, &f), PROGRESS_TEXT_ROWS);
    assert_string_equal(lines[17], "100 ranks        the slowest 8");
    assert_string_equal(lines[18], "rank 92     1.91 M     954 k/s");
    /* 20 times its usual tenth of a second is 2 s */
    ranks[70].silent_ns = 75 * S_NS;
    progress_text_format(lines, &f);
    assert_string_equal(lines[17], "100 ranks               1 late");
    assert_string_equal(lines[18], "rank 70     1.93 M   late 1:15");
    assert_string_equal(lines[19], "rank 93     1.91 M     954 k/s");
    assert_string_equal(lines[25], "rank 99     1.90 M     950 k/s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_short),
        cmocka_unit_test(half_done_renders_show_their_progress),
        cmocka_unit_test(plots_are_to_scale),
        cmocka_unit_test(lines_have_room),
        cmocka_unit_test(live_mode_device_and_nothing_are_shown),
        cmocka_unit_test(late_and_slow_ranks_are_shown),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
