// SPDX-License-Identifier: MIT
/*
 * test_difference.c - colours and frames of a picture of differences
 */
#include <stdlib.h>

#include "tests/unit/check.h"

#include "command/difference.h"

enum { SIDE = 32 };

static const uint8_t *pixel(const struct frame *frame, int x, int y)
{
    return frame->rgb + 3 * (y * frame->width + x);
}

/* The left half is brighter, one pixel at the right is darker. */
static void colors_tell_the_sign(void **state)
{
    static float a[3 * SIDE * SIDE], b[3 * SIDE * SIDE];
    struct picture_pair pair = {SIDE, SIDE, a, b};
    struct tile_test test;
    struct frame frame;
    struct error err;
    const uint8_t *p;

    (void)state;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        b[i] = 0.5f;
        a[i] = i / 3 % SIDE < SIDE / 2 ? 0.6f : 0.5f;
    }
    for (int c = 0; c < 3; c++)
        a[3 * (20 * SIDE + 25) + c] = 0.3f;
    assert_true(tile_test_init(&test, &pair, 2, 0.01, &err));
    assert_true(frame_init(&frame, SIDE, SIDE, &err));
    /* root mean square of 0.1 / sqrt(0.5^2 + 0.1^2) in half of the pixels, and
     * one of twice as much, times 3 */
    check_close(difference_draw(&pair, &test, &frame), 0.4168, 1e-3);
    p = pixel(&frame, 5, 5);
    assert_true(p[0] > p[2] && p[0] > 100);
    p = pixel(&frame, 25, 20);
    assert_true(p[2] > p[0] && p[2] > 100);
    p = pixel(&frame, 20, 5);
    assert_true(p[0] == 0 && p[1] == 0 && p[2] == 0);
    /* only tiles of the left half have a frame */
    assert_int_equal(pixel(&frame, 0, 0)[1], 255);
    assert_int_equal(pixel(&frame, 15, 9)[1], 255);
    assert_int_equal(pixel(&frame, 31, 9)[1], 0);
    frame_free(&frame);
    tile_test_free(&test);
}

static void equal_pictures_are_black(void **state)
{
    static float a[3 * SIDE * SIDE];
    struct picture_pair pair = {SIDE, SIDE, a, a};
    struct tile_test test;
    struct frame frame;
    struct error err;

    (void)state;
    assert_true(tile_test_init(&test, &pair, 2, 0.01, &err));
    assert_true(frame_init(&frame, SIDE, SIDE, &err));
    check_close(difference_draw(&pair, &test, &frame), 0, 0);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        assert_int_equal(frame.rgb[i], 0);
    frame_free(&frame);
    tile_test_free(&test);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_tell_the_sign),
        cmocka_unit_test(equal_pictures_are_black),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
