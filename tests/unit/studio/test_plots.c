// SPDX-License-Identifier: MIT
/*
 * test_plots.c - the course of an error that falls as one over the root of
 * time is a straight line; the history keeps few points and begins anew
 */
#include <math.h>
#include <string.h>

#include "studio/progress_panel.h"
#include "tests/unit/check.h"

static char rows[PLOT_ERROR_ROWS][PLOT_BYTES];

/* A history of errors .5 / sqrt(t). */
static void fill(struct error_history *h, double end_s)
{
    struct render_progress p = {.film_error = {.is_known = true}};

    *h = (struct error_history){.count = 0};
    for (double t = 0.01; t < end_s; t *= 1.01) {
        p.render_ns = (uint64_t)(t * 1e9);
        p.film_error.error = 0.5 / sqrt(t);
        error_history_update(h, &p);
    }
}

static void histories_are_short(void **state)
{
    struct error_history h;
    struct render_progress p = {.film_error = {true, true, 0.5, 0.4, 0.6}};

    (void)state;
    fill(&h, 3e7);
    assert_in_range(h.count, 100, ERROR_HISTORY_MAX);
    for (int i = 1; i < h.count; i++)
        assert_true(h.points[i].time_s > 1.09 * h.points[i - 1].time_s);
    p.render_ns = 1; /* another render */
    error_history_update(&h, &p);
    assert_int_equal(h.count, 1);
    p.film_error.is_known = false;
    p.render_ns = 1000000000;
    error_history_update(&h, &p);
    assert_int_equal(h.count, 1);
}

/* Without Unicode each column has its stars on the diagonal. */
static void a_root_is_a_straight_line(void **state)
{
    struct error_history h;

    (void)state;
    fill(&h, 100);
    plot_errors(rows, &h, 0, 0, false);
    for (int col = 0; col < PLOT_COLS; col++) {
        double row = (col + 0.5) * PLOT_ERROR_ROWS / PLOT_COLS;
        int stars = 0;

        for (int y = 0; y < PLOT_ERROR_ROWS; y++) {
            if (rows[y][col] == ' ')
                continue;
            stars++;
            check_close(y + 0.5, row, 0.75);
        }
        assert_in_range(stars, 1, 2);
    }
    /* braille takes three bytes a character, and begins at the upper left */
    plot_errors(rows, &h, 0, 0, true);
    for (int y = 0; y < PLOT_ERROR_ROWS; y++)
        assert_int_equal(strlen(rows[y]), 3 * PLOT_COLS);
    assert_int_equal((unsigned char)rows[0][0], 0xe2);
    assert_int_equal(rows[0][2] & 1, 1);
}

/* The way to a target continues the line with fewer dots. */
static void the_target_is_reached_by_dots(void **state)
{
    struct error_history h;
    int stars[2] = {0, 0};

    (void)state;
    fill(&h, 1);
    plot_errors(rows, &h, 0.05, 90, false);
    for (int y = 0; y < PLOT_ERROR_ROWS; y++)
        for (int col = 0; col < PLOT_COLS; col++)
            stars[col >= PLOT_COLS / 2] += rows[y][col] != ' ';
    assert_in_range(stars[0], PLOT_COLS / 2 - 1, PLOT_COLS / 2 + 4);
    assert_in_range(stars[1], 8, 16);
    assert_int_not_equal(rows[PLOT_ERROR_ROWS - 1][PLOT_COLS - 1], ' ');
    /* too far away: the course so far takes all columns */
    plot_errors(rows, &h, 1e-6, 1e9, false);
    assert_int_not_equal(rows[PLOT_ERROR_ROWS - 1][PLOT_COLS - 1], ' ');
    assert_int_not_equal(rows[0][0], ' ');
}

static void nothing_is_shown_before_two_errors(void **state)
{
    struct error_history h = {.count = 0};

    (void)state;
    plot_errors(rows, &h, 0.01, 5, true);
    for (int y = 0; y < PLOT_ERROR_ROWS; y++)
        assert_int_equal(strspn(rows[y], " "), PLOT_COLS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(histories_are_short),
        cmocka_unit_test(a_root_is_a_straight_line),
        cmocka_unit_test(the_target_is_reached_by_dots),
        cmocka_unit_test(nothing_is_shown_before_two_errors),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
