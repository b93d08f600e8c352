// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "terminal/glyphs.h"

/* Masks of the quadrants. */
enum {
    UPPER_LEFT = 1 + 4,
    UPPER_RIGHT = 2 + 8,
    LOWER_LEFT = 16 + 64,
    LOWER_RIGHT = 32 + 128,
    ALL = 255
};

/* Compares with the charts of the Unicode standard, whose names contain the
 * dots: "LOWER ONE QUARTER BLOCK", "QUADRANT UPPER LEFT AND ...", "BRAILLE
 * PATTERN DOTS-". Dots here are counted along the rows, so braille's 1234 are
 * 0, 2, 4, 1. A quadrant has two rows of dots. */
static void glyphs_are_those_of_the_charts(void **state)
{
    static const struct {
        enum glyphs glyphs;
        unsigned mask;
        uint32_t glyph;
    } cases[] = {
        {GLYPHS_HALF, 0, ' '},
        {GLYPHS_HALF, 1, 0x2580},
        {GLYPHS_UPPER, 1, 0x2580},
        {GLYPHS_LOWER, 2, 0x2584},
        {GLYPHS_HALF, 3, 0x2588},
        {GLYPHS_BLOCK, UPPER_LEFT, 0x2598},
        {GLYPHS_BLOCK, UPPER_RIGHT, 0x259d},
        {GLYPHS_BLOCK, LOWER_LEFT, 0x2596},
        {GLYPHS_BLOCK, LOWER_RIGHT, 0x2597},
        {GLYPHS_BLOCK, UPPER_LEFT + LOWER_RIGHT, 0x259a},
        {GLYPHS_BLOCK, UPPER_RIGHT + LOWER_LEFT, 0x259e},
        {GLYPHS_BLOCK, ALL - UPPER_RIGHT, 0x2599},
        {GLYPHS_BLOCK, ALL - LOWER_RIGHT, 0x259b},
        {GLYPHS_BLOCK, ALL - LOWER_LEFT, 0x259c},
        {GLYPHS_BLOCK, ALL - UPPER_LEFT, 0x259f},
        {GLYPHS_BLOCK, UPPER_LEFT + LOWER_LEFT, 0x258c}, /* left half */
        {GLYPHS_BLOCK, UPPER_RIGHT + LOWER_RIGHT, 0x2590},
        {GLYPHS_BLOCK, UPPER_LEFT + UPPER_RIGHT, 0x2580},
        {GLYPHS_BLOCK, LOWER_LEFT + LOWER_RIGHT, 0x2584},
        {GLYPHS_BLOCK, 64 + 128, 0x2582},    /* lower quarter */
        {GLYPHS_BLOCK, ALL - 1 - 2, 0x2586}, /* lower three quarters */
        {GLYPHS_BLOCK, 1 + 2, 0},            /* upper quarter */
        {GLYPHS_BLOCK, 1, 0},
        {GLYPHS_BLOCK, ALL, 0x2588},
        {GLYPHS_BRAILLE, 1, 0x2801},        /* 1 */
        {GLYPHS_BRAILLE, 2, 0x2808},        /* 4 */
        {GLYPHS_BRAILLE, 64 + 128, 0x28c0}, /* 78 */
        {GLYPHS_BRAILLE, 255, 0x28ff},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_int_equal(glyphs_of_mask(cases[i].glyphs, cases[i].mask),
                         cases[i].glyph);
}

/* Each mask with a glyph has its own, from which the mask is found again. */
static void masks_are_found_from_glyphs(void **state)
{
    static const enum glyphs kinds[] = {GLYPHS_HALF, GLYPHS_BLOCK};
    static const int counts[] = {4, 18};

    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        struct glyph_grid grid = glyphs_grid(kinds[i]);
        int count = 0;

        for (unsigned mask = 0; mask < 1u << grid.across * grid.down; mask++) {
            uint32_t glyph = glyphs_of_mask(kinds[i], mask);
            unsigned back;

            if (glyph == 0)
                continue;
            count++;
            assert_true(glyphs_mask(kinds[i], glyph, &back));
            assert_int_equal(back, mask);
        }
        assert_int_equal(count, counts[i]);
        unsigned ignored;
        assert_false(glyphs_mask(kinds[i], '@', &ignored));
        assert_false(glyphs_mask(kinds[i], 0, &ignored));
    }
}

static void glyphs_are_written_in_utf8(void **state)
{
    static const struct {
        uint32_t glyph;
        const char *bytes;
    } cases[] = {{'~', "~"},
                 {0xe9, "\xc3\xa9"},
                 {0x2580, "\xe2\x96\x80"},
                 {0x28ff, "\xe2\xa3\xbf"},
                 {0x1fb3b, "\xf0\x9f\xac\xbb"}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char bytes[5] = "";

        assert_int_equal(glyph_utf8(cases[i].glyph, bytes),
                         strlen(cases[i].bytes));
        assert_string_equal(bytes, cases[i].bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glyphs_are_those_of_the_charts),
        cmocka_unit_test(masks_are_found_from_glyphs),
        cmocka_unit_test(glyphs_are_written_in_utf8),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
