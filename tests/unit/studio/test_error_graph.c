// SPDX-License-Identifier: MIT
/*
 * test_error_graph.c - the course of an error that falls as one over the root
 * of time is a straight line; the history keeps few points and begins anew
 */
#include <math.h>
#include <string.h>

#include "studio/error_graph.h"
#include "tests/unit/check.h"

#define COLS 30
#define ROWS 4

static struct error_graph graph;

static bool plot(const struct error_history *h, double target, double target_s,
                 bool has_unicode)
{
    graph.cols = COLS;
    graph.rows = ROWS;
    graph.has_unicode = has_unicode;
    return error_graph_plot(&graph, h, target, target_s);
}

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

/* Dots across and down. */
#define ACROSS (2 * COLS)
#define DOWN   (4 * ROWS)

/* Returns the height of the area in a column without Unicode, in rows. */
static double height_of(int col)
{
    static const char piles[] = " .:|#";
    double height = 0;

    for (int y = 0; y < ROWS; y++)
        height += (double)(strchr(piles, graph.text[y][col]) - piles) / 4;
    return height;
}

/* The top of the area falls along the diagonal. */
static void a_root_is_a_straight_line(void **state)
{
    struct error_history h;

    (void)state;
    fill(&h, 100);
    assert_true(plot(&h, 0, 0, false));
    for (int col = 0; col < COLS; col++)
        check_close(height_of(col),
                    (DOWN - (DOWN - 1) * 2.0 * col / (ACROSS - 1)) / 4, 0.13);
    check_close(graph.high, 5, 1e-9);
    /* the last error is a tenth older than the end at most */
    assert_true(graph.to_s > 100 / 1.1 && graph.to_s <= 100);
    check_close(graph.low, 0.5 / sqrt(graph.to_s), 1e-6);
    /* braille takes three bytes a character, and begins at the upper left */
    assert_true(plot(&h, 0, 0, true));
    for (int y = 0; y < ROWS; y++)
        assert_int_equal(strlen(graph.text[y]), 3 * COLS);
    assert_int_equal((unsigned char)graph.text[0][0], 0xe2);
    assert_int_equal(graph.text[0][2] & 1, 1);
}

/* The way to a target continues the line by a dot in each column. */
static void the_target_is_reached_by_dots(void **state)
{
    struct error_history h;

    (void)state;
    fill(&h, 1);
    assert_true(plot(&h, 0.05, 90, false));
    assert_in_range(graph.known_cols, COLS / 2 - 1, COLS / 2);
    for (int col = 0; col < COLS; col++) {
        double row = (col + 0.25) * ROWS / COLS;

        if (col < graph.known_cols)
            check_close(height_of(col), ROWS - row, 0.3);
        else
            for (int y = 0; y < ROWS; y++)
                if (graph.text[y][col] != ' ')
                    check_close(y + 0.5, row, 0.75);
    }
    assert_int_equal(graph.text[ROWS - 1][COLS - 1], '.');
    check_close(graph.low, 0.05, 1e-9);
    /* too far away: the course so far takes all columns */
    assert_true(plot(&h, 1e-6, 1e9, false));
    assert_int_equal(graph.known_cols, COLS);
    check_close(height_of(0), ROWS, 0.25);
    check_close(height_of(COLS - 1), 0.25, 0.25);
}

static void nothing_is_shown_before_two_errors(void **state)
{
    struct error_history h = {.count = 0};

    (void)state;
    assert_false(plot(&h, 0.01, 5, true));
    h.count = 1;
    assert_false(plot(&h, 0.01, 5, true));
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
