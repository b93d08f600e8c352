// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <string.h>

#include "studio/status_line.h"

#define SEC UINT64_C(1000000000)

/* Formats the line, and checks that what is marked is within it. */
static void format(char text[STATUS_BYTES], int cols,
                   const struct status_line *s)
{
    struct status_row row;

    status_line_format(&row, cols, s);
    assert_in_range(row.span_count, 1, STATUS_SPANS);
    for (int i = 0; i < row.span_count; i++)
        assert_in_range(row.spans[i].col + row.spans[i].cols, 1, cols);
    memcpy(text, row.text, STATUS_BYTES);
}

static const char *duration(uint64_t ns)
{
    static char text[32];

    status_line_duration(text, sizeof text, ns);
    return text;
}

static void durations_are_short(void **state)
{
    (void)state;
    assert_string_equal(duration(0), "0 s");
    assert_string_equal(duration(60 * SEC - 1), "59 s");
    assert_string_equal(duration(60 * SEC), "1:00");
    assert_string_equal(duration(3599 * SEC), "59:59");
    assert_string_equal(duration(3600 * SEC + 62 * SEC), "1:01:02");
    assert_string_equal(duration(UINT64_MAX), "5124095:34:33");
}

static struct render_progress half_done(void)
{
    struct render_progress p = {.state = RENDER_RUNNING,
                                .spp_limit = 16,
                                .spp_done = 8,
                                .samples = 8 * 1000000,
                                .samples_limit = 16 * 1000000,
                                .render_ns = 4 * SEC};

    return p;
}

/* The line of live mode, with few fields of little length. */
static struct status_line live_line(const struct render_progress *p)
{
    return (
        struct status_line){.is_live = true, .progress = p, .help_key = "?"};
}

/* A line of normal mode. */
static struct status_line normal_line(const struct render_progress *p)
{
    struct status_line s = live_line(p);

    s.is_live = false;
    s.is_started = true;
    return s;
}

/* 8 samples per pixel of a live render without limits, with 1.9 % noise. */
static struct render_progress noisy(void)
{
    struct render_progress p = half_done();

    p.spp_limit = p.samples_limit = 0;
    p.pixels = 1000000;
    p.film_error = (struct film_error){true, true, 0.0192, 0.0185, 0.0199};
    render_trend_add(&p.trend, (double)p.render_ns, 8, &p.film_error);
    return p;
}

static void normal_mode_shows_the_time_left(void **state)
{
    struct render_progress p = half_done();
    struct status_line s = normal_line(&p);
    char text[STATUS_BYTES];

    (void)state;
    format(text, 64, &s);
    assert_string_equal(text, " NORMAL  8/16 spp  50 %  noise unknown  4 s  "
                              "left 4 s    ? help ");
    s.is_orbiting = true;
    format(text, 120, &s);
    check_has(text, " NORMAL  orbit  8/16 spp  ");
    s.is_filtered = true;
    format(text, 120, &s);
    check_has(text, " NORMAL  orbit filtered  8/16 spp  ");
    s.filtered_error = 0.0313;
    format(text, 120, &s);
    check_has(text, "8/16 spp  50 %  error ~3.1 %  4 s  left 4 s  ");
    s.is_orbiting = s.is_filtered = false;
    p.state = RENDER_IDLE;
    s.is_halted = true;
    format(text, 120, &s);
    check_has(text, "NORMAL paused  8/16 spp  50 %  noise unknown  4 s   ");
    p.state = RENDER_DONE;
    p.samples = p.samples_limit;
    format(text, 120, &s);
    check_has(text, "NORMAL done");
    check_has(text, "100 %");
    s.is_started = false;
    s.has_device = true;
    p.state = RENDER_IDLE;
    format(text, 120, &s);
    check_has(text, "NORMAL ready  OpenCL   ");
}

static void live_mode_has_no_end(void **state)
{
    struct render_progress p = half_done();
    struct status_line s = live_line(&p);
    char text[STATUS_BYTES];

    (void)state;
    p.spp_limit = p.samples_limit = 0;
    format(text, 100, &s);
    check_has(text, " LIVE  8 spp  noise unknown  4 s   ");
    assert_null(strchr(text, '%'));
    p = (struct render_progress){.state = RENDER_RUNNING};
    format(text, 100, &s);
    check_has(text, "0 spp  noise unknown  0 s  ");
}

/* The nearest limit has its time: the error in the field of noise, others in a
 * field of their own. */
static void noise_is_shown_with_the_time_to_a_target(void **state)
{
    struct render_progress p = noisy();
    struct status_line s = live_line(&p);
    char text[STATUS_BYTES];

    (void)state;
    /* live: to 0.5 %, of which the width of the interval makes 115.9 samples of
     * 8 * 3.98^2 = 126.7, in blocks 120 */
    format(text, 100, &s);
    check_has(text, " LIVE  8 spp  noise 1.9 %, 0.5 % in 56 s  4 s   ");
    p.state = RENDER_IDLE;
    format(text, 100, &s);
    check_has(text, "  8 spp  noise 1.9 %  4 s   ");
    p.state = RENDER_RUNNING;
    p.film_error.is_resolved = false;
    format(text, 100, &s);
    check_has(text, "  8 spp  noise 1.9 %, mostly in few pixels");
    p.film_error.is_resolved = true;
    /* -e 1%: 29.7 samples, so 32 */
    s = normal_line(&p);
    p.error_limit = 0.01;
    format(text, 110, &s);
    check_has(text, " NORMAL  8 spp  25 %  noise 1.9 %, 1 % in 12 s  4 s   ");
    p.time_limit_ns = 10 * SEC; /* before */
    format(text, 110, &s);
    check_has(text, "  8 spp  40 %  noise 1.9 %  4 s  left 6 s   ");
    p.time_limit_ns = 0;
    p.film_error.high = 0.0099; /* reached, but not at 8 of 16 samples */
    render_trend_add(&p.trend, (double)p.render_ns, 8, &p.film_error);
    format(text, 110, &s);
    check_has(text, "  8 spp  50 %  noise 1.9 %  4 s   ");
}

/* In narrow windows the time to the target goes before the noise. */
static void noise_outlives_its_target(void **state)
{
    struct render_progress p = noisy();
    struct status_line s = live_line(&p);
    char text[STATUS_BYTES];
    bool had_noise = false, had_target = false;

    (void)state;
    for (int cols = 20; cols < 120; cols++) {
        bool has_noise, has_target;

        format(text, cols, &s);
        has_noise = strstr(text, "  noise 1.9 %") != NULL;
        has_target = strstr(text, "  noise 1.9 %, 0.5 % in 56 s ") != NULL;
        assert_true(has_target == (strstr(text, "56 s") != NULL));
        assert_true(has_noise || !has_target);
        assert_true(has_noise >= had_noise && has_target >= had_target);
        had_noise = has_noise;
        had_target = has_target;
    }
    assert_true(had_target);
}

/* At any width the line has that many columns, begins with the mode and cuts no
 * field. */
static void narrow_windows_drop_fields(void **state)
{
    struct render_progress p = half_done();
    struct status_line s = normal_line(&p);
    static const char *const fields[] = {"8/16 spp", "50 %", "4 s", "left 4 s"};
    char text[STATUS_BYTES];

    (void)state;
    for (int cols = 1; cols < 3000; cols++) {
        format(text, cols, &s);
        assert_int_equal(strlen(text),
                         cols < STATUS_BYTES - 1 ? cols : STATUS_BYTES - 1);
        if (cols >= 24)
            assert_true(strncmp(text, " NORMAL", 7) == 0);
        for (size_t i = 1; i < 4; i++) {
            /* Less important ones are dropped first. */
            if (strstr(text, fields[i]))
                assert_non_null(strstr(text, fields[0]));
        }
    }
}

/* 80 columns have space for the mode, the backend, files, samples, noise and
 * the hint. */
static void eighty_columns_have_what_counts(void **state)
{
    struct render_progress p = half_done();
    struct status_line s = live_line(&p);
    char text[STATUS_BYTES];

    (void)state;
    p.render_ns = 100 * 3600 * SEC;
    for (int i = 0; i < 64; i++) {
        s.is_live = i & 1;
        s.is_orbiting = i & 2;
        s.is_halted = s.is_started = i & 4;
        s.load_key = i & 8 ? "l" : NULL;
        s.has_device = i & 16;
        p.spp_limit = i & 32 ? 16 : 0;
        format(text, 80, &s);
        check_has(text, "? help ");
        if (s.has_device)
            check_has(text, " OpenCL ");
        if (s.load_key)
            check_has(text, "changed: l loads");
        if (!s.load_key && (s.is_live || s.is_started))
            check_has(text, "noise unknown ");
        if (s.is_live || s.is_started)
            check_has(text, " spp ");
    }
}

/* A device that renders is in the line of any width that has room for it and
 * one word of the mode, and beside messages. */
static void every_width_has_the_device(void **state)
{
    struct render_progress p = half_done();
    struct status_line s = live_line(&p);
    struct status_row row;
    char text[STATUS_BYTES];

    (void)state;
    s.has_device = true;
    for (int i = 0; i < 32; i++) {
        s.is_live = i & 1;
        s.is_orbiting = s.passes_walls = i & 2;
        s.is_halted = s.is_started = i & 4;
        s.load_key = i & 8 ? "l" : NULL;
        p.spp_limit = i & 16 ? 16 : 0;
        for (int cols = 16; cols < 200; cols++) {
            format(text, cols, &s);
            check_has(text, "OpenCL");
        }
    }
    s = live_line(&p);
    s.has_device = true;
    status_line_message(&row, 80, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " LIVE OpenCL  abcdef");
    status_line_message(&row, 19, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " LIVE  abcdef");
}

static void messages_have_no_control_characters(void **state)
{
    struct render_progress p = half_done();
    struct status_line s = live_line(&p);
    struct status_row row;

    (void)state;
    status_line_message(&row, 80, &s, "a\033[2Jb\nc\177", ROLE_MESSAGE);
    assert_string_equal(row.text, " LIVE  a?[2Jb?c?");
    assert_int_equal(row.spans[0].cols, 6);
    s.is_halted = true;
    status_line_message(&row, 80, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " LIVE paused  abcdef");
    assert_int_equal(row.spans[0].role, ROLE_PAUSED);
    status_line_message(&row, 19, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " LIVE  abcdef");
    status_line_message(&row, 13, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " LIVE  abcdef");
    status_line_message(&row, 12, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " abcdef");
    assert_int_equal(row.span_count, 0);
    status_line_message(&row, 5, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, " abcd");
    status_line_message(&row, 0, &s, "abcdef", ROLE_MESSAGE);
    assert_string_equal(row.text, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(durations_are_short),
        cmocka_unit_test(normal_mode_shows_the_time_left),
        cmocka_unit_test(live_mode_has_no_end),
        cmocka_unit_test(noise_is_shown_with_the_time_to_a_target),
        cmocka_unit_test(noise_outlives_its_target),
        cmocka_unit_test(narrow_windows_drop_fields),
        cmocka_unit_test(eighty_columns_have_what_counts),
        cmocka_unit_test(every_width_has_the_device),
        cmocka_unit_test(messages_have_no_control_characters),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
