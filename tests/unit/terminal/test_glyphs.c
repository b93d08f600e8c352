// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "terminal/glyphs.h"

/* Compares with the charts of the Unicode standard, whose names contain the
 * dots: "BLOCK SEXTANT-135", "QUADRANT UPPER LEFT AND ...", "BRAILLE PATTERN
 * DOTS-". Dots here are counted along the rows, so braille's 1234 are 0, 2, 4,
 * 1. */
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
        {GLYPHS_QUADRANT, 1, 0x2598},
        {GLYPHS_QUADRANT, 2, 0x259d},
        {GLYPHS_QUADRANT, 4, 0x2596},
        {GLYPHS_QUADRANT, 8, 0x2597},
        {GLYPHS_QUADRANT, 1 + 8, 0x259a}, /* upper left and lower right */
        {GLYPHS_QUADRANT, 2 + 4, 0x259e},
        {GLYPHS_QUADRANT, 1 + 4 + 8, 0x2599},
        {GLYPHS_QUADRANT, 1 + 2 + 4, 0x259b},
        {GLYPHS_QUADRANT, 1 + 2 + 8, 0x259c},
        {GLYPHS_QUADRANT, 2 + 4 + 8, 0x259f},
        {GLYPHS_QUADRANT, 1 + 4, 0x258c}, /* left half */
        {GLYPHS_QUADRANT, 2 + 8, 0x2590},
        {GLYPHS_QUADRANT, 1 + 2, 0x2580},
        {GLYPHS_QUADRANT, 4 + 8, 0x2584},
        {GLYPHS_SEXTANT, 1, 0x1fb00},      /* 1 */
        {GLYPHS_SEXTANT, 2, 0x1fb01},      /* 2 */
        {GLYPHS_SEXTANT, 1 + 2, 0x1fb02},  /* 12 */
        {GLYPHS_SEXTANT, 32, 0x1fb1e},     /* 6 */
        {GLYPHS_SEXTANT, 4 + 16, 0x1fb13}, /* 35 */
        {GLYPHS_SEXTANT, 2 + 4 + 16, 0x1fb14},
        {GLYPHS_SEXTANT, 1 + 8 + 32, 0x1fb27},
        {GLYPHS_SEXTANT, 1 + 2 + 8 + 32, 0x1fb28},
        {GLYPHS_SEXTANT, 62, 0x1fb3b}, /* 23456 */
        {GLYPHS_SEXTANT, 1 + 4 + 16, 0x258c},
        {GLYPHS_SEXTANT, 2 + 8 + 32, 0x2590},
        {GLYPHS_SEXTANT, 63, 0x2588},
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

/* Each mask has its own glyph, from which the mask is found again. */
static void masks_are_found_from_glyphs(void **state)
{
    static const enum glyphs kinds[] = {GLYPHS_HALF, GLYPHS_QUADRANT,
                                        GLYPHS_SEXTANT, GLYPHS_BRAILLE};

    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        struct glyph_grid grid = glyphs_grid(kinds[i]);

        for (unsigned mask = 0; mask < 1u << grid.across * grid.down; mask++) {
            unsigned back;

            assert_true(
                glyphs_mask(kinds[i], glyphs_of_mask(kinds[i], mask), &back));
            assert_int_equal(back, mask);
        }
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
