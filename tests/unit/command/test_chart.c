// SPDX-License-Identifier: MIT
/*
 * test_chart.c - diagrams of characters, compared with drawings by hand
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#include "command/chart.h"

static struct chart chart_of(const char *x_label, const char *y_label,
                             const struct series *s)
{
    return (struct chart){.title = "",
                          .x_label = x_label,
                          .y_label = y_label,
                          .series = s,
                          .series_count = 1};
}

static char *drawn(const struct chart *chart, int cols, int rows,
                   bool has_braille)
{
    char *text = NULL;
    size_t size_bytes;
    FILE *to = open_memstream(&text, &size_bytes);

    assert_non_null(to);
    chart_write_text(to, chart, cols, rows, has_braille);
    assert_int_equal(fclose(to), 0);
    return text;
}

/* A straight line through two decades each way. Both axes end 0.05 decades
 * beyond the points. */
static void a_line_is_drawn_in_ascii(void **state)
{
    struct series s = {.count = 3, .x = {1, 10, 100}, .y = {100, 10, 1}};
    struct chart chart = chart_of("seconds", "error", &s);
    char *text = drawn(&chart, 29, 11, false);

    (void)state;
    assert_string_equal(text, "error over seconds\n"
                              "   100 |*..                  \n"
                              "    50 |   ...               \n"
                              "    20 |      ...            \n"
                              "    10 |         .*.         \n"
                              "     5 |            ...      \n"
                              "     2 |               ...   \n"
                              "     1 |                  ..*\n"
                              "       +---------------------\n"
                              "        1  2   5 10 20    100 \n");
    free(text);
}

static void braille_has_the_same_frame(void **state)
{
    struct series s = {.count = 2, .x = {1, 100}, .y = {100, 1}};
    struct chart chart = chart_of("seconds", "error", &s);
    char *text = drawn(&chart, 29, 11, true);

    (void)state;
    check_has(text, "   100 |");
    free(text);
}

/* Points that are not above 0 or not finite are left out. */
static void no_point_is_no_diagram(void **state)
{
    struct series s = {.count = 3, .x = {1, 0, INFINITY}, .y = {0, 1, 1}};
    struct chart chart = chart_of("x", "y", &s);
    char *text = drawn(&chart, 30, 10, false);

    (void)state;
    assert_string_equal(text, "");
    free(text);
}

static void ticks_are_round(void **state)
{
    static const char *const labels[] = {"\n 50000 |", "\n100000 |",
                                         "\n200000 |", "\n500000 |",
                                         "\n   1e6 |", "\n   2e6 |"};
    struct series s = {.count = 2, .x = {4.5e-3, 0.023}, .y = {4.5e4, 2.2e6}};
    struct chart chart = chart_of("x", "y", &s);
    char *text = drawn(&chart, 60, 30, false);

    (void)state;
    for (int i = 0; i < 6; i++)
        check_has(text, labels[i]);
    check_has(text, " 5e-3 ");
    check_has(text, " 0.01 ");
    check_has(text, " 0.02 ");
    free(text);
}

/* One point, tiny and huge ranges and sizes end. */
static void extremes_end(void **state)
{
    static const double values[][2] = {{1, 1}, {1e-30, 1e30}, {1, 1.0000001}};

    (void)state;
    for (int i = 0; i < 3; i++) {
        struct series s = {.count = 2,
                           .x = {values[i][0], values[i][1]},
                           .y = {values[i][1], values[i][0]}};
        struct chart chart = chart_of("x", "y", &s);

        for (int cols = -1; cols < 100; cols += 67)
            free(drawn(&chart, cols, cols / 2, cols % 2 == 0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_is_drawn_in_ascii),
        cmocka_unit_test(braille_has_the_same_frame),
        cmocka_unit_test(no_point_is_no_diagram),
        cmocka_unit_test(ticks_are_round),
        cmocka_unit_test(extremes_end),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
