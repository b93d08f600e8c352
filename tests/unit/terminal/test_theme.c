// SPDX-License-Identifier: MIT
/*
 * test_theme.c - text of every role is legible: its contrast, computed as
 * WCAG 2.1 defines it (relative luminance of sRGB), is at least 4.5:1 in both
 * themes with 24 bits, 256 and 16 colours
 */
#include <math.h>
#include <stdbool.h>

#include "terminal/theme.h"
#include "tests/unit/check.h"

static double linear_of(double byte)
{
    double c = byte / 255;

    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double luminance(uint32_t color, enum palette palette)
{
    struct rgb c = {(int)(color >> 16 & 255), (int)(color >> 8 & 255),
                    (int)(color & 255)};

    if (palette != PALETTE_24BIT)
        c = dither_value(color, palette);
    return 0.2126 * linear_of(c.r) + 0.7152 * linear_of(c.g) +
           0.0722 * linear_of(c.b);
}

/* Many terminals show bold text of the first eight colours in the bright ones.
 */
static double contrast(struct text_style style, enum palette palette,
                       bool bold_is_bright)
{
    bool is_brighter = palette == PALETTE_16 && bold_is_bright &&
                       style.fg < 8 && style.attributes & TEXT_BOLD;
    double a = luminance(style.fg + (is_brighter ? 8 : 0), palette);
    double b = luminance(style.bg, palette);

    return (fmax(a, b) + 0.05) / (fmin(a, b) + 0.05);
}

static void check_contrast(enum theme theme, enum palette palette)
{
    for (int role = ROLE_TEXT; role < ROLES; role++) {
        /* lines and gauges are no text: 3:1 is asked of them (1.4.11) */
        double least = role == ROLE_FRAME || role == ROLE_GAUGE ? 3 : 4.5;
        struct text_style style =
            theme_style(theme, palette, (enum text_role)role);
        double got = fmin(contrast(style, palette, false),
                          contrast(style, palette, true));

        if (got < least)
            print_error("theme %d, palette %d, role %d: contrast %.2f, "
                        "expected %.1f\n",
                        theme, palette, role, got, least);
        assert_true(got >= least);
    }
}

static void text_is_legible(void **state)
{
    (void)state;
    for (int theme = THEME_DARK; theme <= THEME_LIGHT; theme++) {
        check_contrast((enum theme)theme, PALETTE_24BIT);
        check_contrast((enum theme)theme, PALETTE_256);
        check_contrast((enum theme)theme, PALETTE_16);
    }
}

/* Without colours, parts differ by attributes. */
static void no_colors_are_set_without_colors(void **state)
{
    (void)state;
    for (int role = 0; role < ROLES; role++) {
        struct text_style style =
            theme_style(THEME_DARK, PALETTE_MONO, (enum text_role)role);

        assert_int_equal(style.fg, CELL_DEFAULT);
        assert_int_equal(style.bg, CELL_DEFAULT);
    }
    assert_true(
        theme_style(THEME_LIGHT, PALETTE_MONO, ROLE_SELECTED).attributes ==
        TEXT_REVERSE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_legible),
        cmocka_unit_test(no_colors_are_set_without_colors),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
