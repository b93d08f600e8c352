// SPDX-License-Identifier: MIT
/* test_flip.c - the visible difference of pictures, against values of the
 * authors' own program (flip-evaluator 1.7) */
#include "tests/unit/check.h"

#include <stdlib.h>

#include "command/flip.h"

#define WIDTH  48
#define HEIGHT 32

static float pictures[2][3 * WIDTH * HEIGHT];

/* Sets a channel of a pixel to value / 255. */
static void set(int picture, int x, int y, int channel, int value)
{
    pictures[picture][3 * (y * WIDTH + x) + channel] = (float)value / 255.0f;
}

static double flip(void)
{
    struct picture_pair pair = {WIDTH, HEIGHT, pictures[1], pictures[0]};
    struct error err;
    double mean = -1;

    assert_true(flip_mean(&pair, &mean, &err));
    return mean;
}

static void even_pictures(void **state)
{
    /* the reference, the picture, and FLIP */
    static const struct {
        int colors[2][3];
        double flip;
    } cases[] = {
        {{{0, 0, 0}, {255, 255, 255}}, 0.967399},
        {{{0, 255, 0}, {0, 0, 255}}, 1.000000},
        {{{128, 128, 128}, {140, 128, 120}}, 0.140671},
        {{{90, 20, 10}, {90, 20, 10}}, 0.000000},
        {{{3, 3, 3}, {1, 2, 9}}, 0.155930},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        for (int p = 0; p < 2; p++)
            for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
                set(p, i / 3 % WIDTH, i / 3 / WIDTH, i % 3,
                    cases[k].colors[p][i % 3]);
        check_close(flip(), cases[k].flip, 1e-4);
    }
}

/* Ramps, of which one has bright dots, edges and a little noise. */
static void dots_and_edges(void **state)
{
    static const double expected[] = {0.063471, 0.147233, 0.021292};

    (void)state;
    for (int k = 0; k < 3; k++) {
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                for (int c = 0; c < 3; c++) {
                    int v = 2 * x + (c + 1) * y;
                    int more[] = {(x * 7 + y * 5) % 31 == 0 ? 100 : 0,
                                  x > 20 && y > 10 ? 40 - 20 * c : 0,
                                  (x * 37 + y * 59 + c * 11) % 17 - 8};

                    set(0, x, y, c, v + 20);
                    set(1, x, y, c, v + 20 + more[k]);
                }
        check_close(flip(), expected[k], 1e-4);
    }
}

/* Light beyond what is shown is cut. */
static void bright_light_is_white(void **state)
{
    (void)state;
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        pictures[0][i] = 1;
        pictures[1][i] = i % 2 ? 1e30f : 7;
    }
    check_close(flip(), 0, 1e-9);
    pictures[1][0] = -1e30f;
    assert_true(flip() > 0 && flip() < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_pictures),
        cmocka_unit_test(dots_and_edges),
        cmocka_unit_test(bright_light_is_white),
    };

    return cmocka_run_group_tests_name("flip", tests, NULL, NULL);
}
