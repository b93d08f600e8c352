// SPDX-License-Identifier: MIT
/*
 * test_lettering.c - letters of strokes: their box, their ends, curves
 */
#include <ctype.h>
#include <math.h>
#include <stddef.h>

#include "tests/unit/check.h"

#include "measure/lettering.h"

/* All letters and digits, and what labels have. */
static const char needed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvw"
                             "xyz0123456789-.,:+/_()%=<>*#!;";

static void letters_are_in_their_boxes(void **state)
{
    (void)state;
    for (const char *c = needed; *c != '\0'; c++) {
        double left = INFINITY, right = -INFINITY;
        const char *at = NULL;
        struct stroke s;
        int strokes = 0;

        for (; lettering_stroke(*c, &at, &s); strokes++) {
            assert_in_range(s.count, 2, STROKE_POINTS - 1);
            for (int i = 0; i < s.count; i++) {
                left = fmin(left, s.x[i]);
                right = fmax(right, s.x[i]);
                assert_true(s.y[i] >= -40 && s.y[i] <= 135);
            }
        }
        if (strokes == 0)
            fail_msg("'%c' has no strokes", *c);
        /* j begins left of its stem */
        if (left < -4 || left > 21 || right > lettering_width(*c) + 1)
            fail_msg("'%c' is from %g to %g, its width is %d", *c, left, right,
                     lettering_width(*c));
    }
}

static void capitals_and_digits_have_one_height(void **state)
{
    (void)state;
    for (const char *c = needed; *c != '\0'; c++) {
        double low = INFINITY, high = -INFINITY;
        const char *at = NULL;
        struct stroke s;

        if (!isdigit((unsigned char)*c) &&
            (!isupper((unsigned char)*c) || *c == 'Q'))
            continue;
        while (lettering_stroke(*c, &at, &s))
            for (int i = 0; i < s.count; i++) {
                low = fmin(low, s.y[i]);
                high = fmax(high, s.y[i]);
            }
        if (fabs(low) > 2 || fabs(high - LETTER_HEIGHT) > 2)
            fail_msg("'%c' is from %g to %g high", *c, low, high);
    }
}

/* The O is symmetric and round: its points are in the box, off the corners. */
static void curves_are_round(void **state)
{
    const char *at = NULL;
    struct stroke s;

    (void)state;
    assert_true(lettering_stroke('O', &at, &s));
    for (int i = 0; i < s.count; i++) {
        double x = s.x[i] / 47.5 - 1, y = s.y[i] / 60 - 1;
        double radius = hypot(x, y);

        /* four parabolas instead of an ellipse */
        assert_true(radius > 0.999 && radius < 1.07);
    }
    assert_false(lettering_stroke('O', &at, &s));
}

static void other_characters_are_blank(void **state)
{
    static const char others[] = {' ', '\n', '~', '\x7f', (char)0xe4};

    (void)state;
    for (size_t i = 0; i < sizeof others; i++) {
        const char *at = NULL;
        struct stroke s;

        assert_false(lettering_stroke(others[i], &at, &s));
        assert_int_equal(lettering_width(others[i]), lettering_width(' '));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(letters_are_in_their_boxes),
        cmocka_unit_test(capitals_and_digits_have_one_height),
        cmocka_unit_test(curves_are_round),
        cmocka_unit_test(other_characters_are_blank),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
