// SPDX-License-Identifier: MIT
#include <math.h>

#include "image/color.h"
#include "tests/unit/check.h"

/* Tests colours with well-known HSV values, and greys. */
static void hsv_of_known_colours_is_right(void **state)
{
    static const struct {
        const char *hex;
        double h, s, v;
    } cases[] = {
        {"#ff0000", 0, 1, 1},
        {"#00ff00", 120, 1, 1},
        {"#0000ff", 240, 1, 1},
        {"#ffff00", 60, 1, 1},
        {"#00ffff", 180, 1, 1},
        {"#ff00ff", 300, 1, 1},
        {"#808080", 0, 0, 128 / 255.0},
        {"#000000", 0, 0, 0},
        {"#ffffff", 0, 0, 1},
        {"#800000", 0, 1, 128 / 255.0},
        {"#bf9f80", 29.52, 0.3298, 191 / 255.0},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double rgb[3], hsv[3], kelvin;
        char hex[COLOR_HEX_BYTES];

        assert_true(color_parse(cases[i].hex, rgb, &kelvin));
        assert_true(kelvin == 0);
        color_to_hsv(rgb, hsv);
        check_close(hsv[0], cases[i].h, 0.01);
        check_close(hsv[1], cases[i].s, 1e-4);
        check_close(hsv[2], cases[i].v, 1e-9);
        color_to_hex(rgb, hex);
        assert_string_equal(hex, cases[i].hex);
    }
}

static void hsv_and_srgb_are_inverted_exactly(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < 10000; i++) {
        double rgb[3] = {check_random(&seed), check_random(&seed),
                         check_random(&seed)};
        double hsv[3], back[3];

        if (i % 3 == 0)
            rgb[i / 3 % 3] = rgb[(i / 3 + 1) % 3];
        color_to_hsv(rgb, hsv);
        assert_true(hsv[0] >= 0 && hsv[0] < 360);
        color_from_hsv(hsv, back);
        for (int k = 0; k < 3; k++) {
            check_close(back[k], rgb[k], 1e-7);
            check_close(color_decoded(color_encoded(rgb[k])), rgb[k], 1e-7);
        }
    }
}

static void typed_colours_are_read_or_refused(void **state)
{
    static const char *const wrong[] = {
        "",       "#",    "#12", "#12345", "#gggggg", "red", "1 2",   "1 2 3 4",
        "-1 0 0", "3000", "0K",  "nanK",   "inf 0 0", "K",   "1,2,3",
    };
    double rgb[3], kelvin;

    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        if (color_parse(wrong[i], rgb, &kelvin))
            print_error("took '%s'\n", wrong[i]);
        assert_false(color_parse(wrong[i], rgb, &kelvin));
    }
    assert_true(color_parse("#F80", rgb, &kelvin));
    check_close(rgb[0], 1, 0);
    check_close(rgb[1], pow((0x88 / 255.0 + 0.055) / 1.055, 2.4), 1e-12);
    check_close(rgb[2], 0, 0);
    assert_true(color_parse(".5  .25 3", rgb, &kelvin));
    assert_true(rgb[0] == 0.5 && rgb[1] == 0.25 && rgb[2] == 3);
    /* White is near 6500 K, by the definition of D65. */
    assert_true(color_parse("6504K", rgb, &kelvin));
    assert_true(kelvin == 6504);
    for (int k = 0; k < 3; k++)
        check_close(rgb[k], 1, 0.06);
    assert_true(color_parse("2000k", rgb, &kelvin));
    check_close(rgb[0], 1, 0);
    assert_true(rgb[1] < 0.5 && rgb[2] < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hsv_of_known_colours_is_right),
        cmocka_unit_test(hsv_and_srgb_are_inverted_exactly),
        cmocka_unit_test(typed_colours_are_read_or_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
