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
        unsigned mask;
        uint32_t glyph;
    } cases[] = {
        {0, ' '},
        {UPPER_LEFT, 0x2598},
        {UPPER_RIGHT, 0x259d},
        {LOWER_LEFT, 0x2596},
        {LOWER_RIGHT, 0x2597},
        {UPPER_LEFT + LOWER_RIGHT, 0x259a},
        {UPPER_RIGHT + LOWER_LEFT, 0x259e},
        {ALL - UPPER_RIGHT, 0x2599},
        {ALL - LOWER_RIGHT, 0x259b},
        {ALL - LOWER_LEFT, 0x259c},
        {ALL - UPPER_LEFT, 0x259f},
        {UPPER_LEFT + LOWER_LEFT, 0x258c}, /* left half */
        {UPPER_RIGHT + LOWER_RIGHT, 0x2590},
        {UPPER_LEFT + UPPER_RIGHT, 0x2580},
        {LOWER_LEFT + LOWER_RIGHT, 0x2584},
        {64 + 128, 0x2582},    /* lower quarter */
        {ALL - 1 - 2, 0x2586}, /* lower three quarters */
        {1 + 2, 0},            /* upper quarter */
        {1, 0},
        {ALL, 0x2588},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_int_equal(glyph_of_block(cases[i].mask), cases[i].glyph);
    assert_int_equal(glyph_of_braille(1), 0x2801);        /* 1 */
    assert_int_equal(glyph_of_braille(2), 0x2808);        /* 4 */
    assert_int_equal(glyph_of_braille(64 + 128), 0x28c0); /* 78 */
    assert_int_equal(glyph_of_braille(255), 0x28ff);
}

/* Each mask with a block has its own, from which the mask is found again. */
static void masks_are_found_from_blocks(void **state)
{
    unsigned back;
    int count = 0;

    (void)state;
    for (unsigned mask = 0; mask < 256; mask++) {
        uint32_t glyph = glyph_of_block(mask);

        if (glyph == 0)
            continue;
        count++;
        assert_true(glyph_block_mask(glyph, &back));
        assert_int_equal(back, mask);
    }
    assert_int_equal(count, 18);
    assert_false(glyph_block_mask('@', &back));
    assert_false(glyph_block_mask(0, &back));
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
        cmocka_unit_test(masks_are_found_from_blocks),
        cmocka_unit_test(glyphs_are_written_in_utf8),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
