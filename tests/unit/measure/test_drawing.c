// SPDX-License-Identifier: MIT
/*
 * test_drawing.c - areas of drawn lines and dots, compared with geometry, and
 * places of text
 */
#include <math.h>
#include <string.h>

#include "tests/unit/check.h"

#include "measure/drawing.h"

#define SIDE 100
#define PI   3.14159265358979323846

static struct frame white(void)
{
    struct frame f;
    struct error err;

    assert_true(frame_init(&f, SIDE, SIDE, &err));
    memset(f.rgb, 255, 3 * SIDE * SIDE);
    return f;
}

/* Returns the area of black, and the box of pixels that are not white. */
static double black_area(const struct frame *f, int box[4])
{
    double sum = 0;

    box[0] = box[1] = SIDE;
    box[2] = box[3] = -1;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            int value = f->rgb[3 * (y * SIDE + x)];

            sum += (255 - value) / 255.0;
            if (value == 255)
                continue;
            box[0] = x < box[0] ? x : box[0];
            box[1] = y < box[1] ? y : box[1];
            box[2] = x > box[2] ? x : box[2];
            box[3] = y > box[3] ? y : box[3];
        }
    return sum;
}

/* The area of a line is its length times its thickness, and of its round ends
 * a disc. */
static void lines_have_their_area(void **state)
{
    (void)state;
    for (int i = 0; i < 24; i++) {
        double angle = i * PI / 12, thickness = 1 + 0.5 * i;
        double x[2] = {50.3, 50.3 + 30 * cos(angle)};
        double y[2] = {49.6, 49.6 + 30 * sin(angle)};
        struct frame f = white();
        int box[4];

        drawing_line(&f, 2, x, y, thickness, 0);
        check_close(black_area(&f, box),
                    30 * thickness + PI * thickness * thickness / 4,
                    0.4 + 0.02 * 30 * thickness);
        frame_free(&f);
    }
}

static void dots_have_their_area(void **state)
{
    (void)state;
    for (double diameter = 2; diameter < 30; diameter += 3) {
        double x = 40.25, y = 61.8;
        struct frame f = white();
        int box[4];

        drawing_line(&f, 1, &x, &y, diameter, 0);
        check_close(black_area(&f, box), PI * diameter * diameter / 4,
                    0.3 + 0.01 * diameter * diameter);
        frame_free(&f);
    }
}

/* A corner is not darker than the rest: a line that goes back over itself has
 * the area of a simple one. */
static void parts_of_a_line_do_not_add(void **state)
{
    double x[3] = {20, 80, 20}, y[3] = {50, 50, 50};
    struct frame f = white();
    int box[4];

    (void)state;
    drawing_line(&f, 3, x, y, 3, 0);
    check_close(black_area(&f, box), 60 * 3 + PI * 9 / 4, 4);
    frame_free(&f);
}

static void drawings_are_clipped(void **state)
{
    double x[2] = {-50, 150}, y[2] = {-20, 120};
    struct frame f = white();
    int box[4];

    (void)state;
    drawing_line(&f, 2, x, y, 5, 0);
    drawing_box(&f, -5, 90, 20, 30, 0);
    drawing_text(&f, 90, 5, 20, DRAWING_LEFT, "WWW", 0);
    assert_true(black_area(&f, box) > 500);
    frame_free(&f);
}

static void text_has_its_place(void **state)
{
    static const double at[] = {10, 50, 90};
    double width = drawing_text_width(12, "Hello");

    (void)state;
    for (int align = DRAWING_LEFT; align <= DRAWING_RIGHT; align++) {
        struct frame f = white();
        int box[4];
        double left = at[align] - 0.5 * align * width;

        drawing_text(&f, at[align], 60, 12, (enum drawing_align)align, "Hello",
                     0);
        black_area(&f, box);
        check_close(box[0], left, 2);
        check_close(box[2] + 1, left + width, 2);
        check_close(box[1], 60 - 12, 2);
        check_close(box[3] + 1, 60, 2);
        frame_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_have_their_area),
        cmocka_unit_test(dots_have_their_area),
        cmocka_unit_test(parts_of_a_line_do_not_add),
        cmocka_unit_test(drawings_are_clipped),
        cmocka_unit_test(text_has_its_place),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
