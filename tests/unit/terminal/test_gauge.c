// SPDX-License-Identifier: MIT
/*
 * test_gauge.c - the ink of a gauge is its fraction, and the handle of a slider
 * is seen on any colour
 */
#include "terminal/gauge.h"
#include "tests/unit/check.h"

#define COLS 10

static const struct text_style style = {0x00ff00, 0x202020, 0};

/* Returns the eighths of a cell that a glyph of Unicode's block elements
 * fills. */
static int eighths_of(uint32_t glyph)
{
    if (glyph == ' ')
        return 0;
    assert_in_range(glyph, 0x2588, 0x258f);
    return 8 - (int)(glyph - 0x2588);
}

static void ink_is_the_fraction(void **state)
{
    struct cell cells[COLS];

    (void)state;
    for (int i = -10; i <= 1010; i++) {
        double fraction = i / 1000.0;
        double within = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
        int ink = 0;

        gauge_cells(cells, COLS, fraction, style, true);
        for (int col = 0; col < COLS; col++) {
            assert_int_equal(cells[col].fg, style.fg);
            ink += eighths_of(cells[col].glyph);
            /* a cell begins when the one before it is full */
            if (col > 0 && cells[col].glyph != ' ')
                assert_int_equal(eighths_of(cells[col - 1].glyph), 8);
        }
        check_close(ink / (8.0 * COLS), within, 0.5 / (8 * COLS) + 1e-9);
    }
}

static void ascii_is_enough(void **state)
{
    struct cell cells[COLS];
    char text[COLS + 1] = "";

    (void)state;
    gauge_cells(cells, COLS, 0.42, style, false);
    for (int col = 0; col < COLS; col++)
        text[col] = (char)cells[col].glyph;
    assert_string_equal(text, "====......");
}

static void handles_are_seen(void **state)
{
    static const enum palette palettes[] = {PALETTE_16, PALETTE_256,
                                            PALETTE_24BIT};

    (void)state;
    for (size_t p = 0; p < 3; p++) {
        for (int grey = 0; grey < 256; grey += 5) {
            struct cell cells[COLS];
            int handles = 0;

            for (int col = 0; col < COLS; col++)
                cells[col] =
                    cells_of_color((struct rgb){grey, grey, grey}, palettes[p]);
            gauge_handle(cells, COLS, grey / 255.0, palettes[p], true);
            for (int col = 0; col < COLS; col++) {
                if (cells[col].glyph == ' ')
                    continue;
                handles++;
                assert_true(cells[col].fg != cells[col].bg);
                check_close((col + 0.5) / COLS, grey / 255.0, 0.6 / COLS);
            }
            assert_int_equal(handles, 1);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ink_is_the_fraction),
        cmocka_unit_test(ascii_is_enough),
        cmocka_unit_test(handles_are_seen),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
