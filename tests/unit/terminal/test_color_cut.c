// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>
#include <string.h>

#include "terminal/color_cut.h"

#define WIDTH  96
#define HEIGHT 64
#define PIXELS (WIDTH * HEIGHT)

static struct color_cut cut;
static uint8_t rgb[3 * PIXELS], numbers[PIXELS];

static void make(int most)
{
    struct color_cut_image image = {rgb, WIDTH, HEIGHT, 0, 0};

    color_cut(&cut, &image, most, numbers);
    assert_in_range(cut.count, 1, most);
}

static int channel(int number, int c)
{
    const struct rgb *color = &cut.colors[number];

    return c == 0 ? color->r : c == 1 ? color->g : color->b;
}

/* Each colour is the mean of its pixels, and has some. */
static void check_means(void)
{
    static double sum[COLOR_CUT_MAX][3];
    static int count[COLOR_CUT_MAX];

    memset(sum, 0, sizeof sum);
    memset(count, 0, sizeof count);
    for (int i = 0; i < PIXELS; i++) {
        assert_in_range(numbers[i], 0, cut.count - 1);
        count[numbers[i]]++;
        for (int c = 0; c < 3; c++)
            sum[numbers[i]][c] += rgb[3 * i + c];
    }
    for (int n = 0; n < cut.count; n++) {
        assert_true(count[n] > 0);
        for (int c = 0; c < 3; c++)
            check_close(channel(n, c), sum[n][c] / count[n], 0.5 + 1e-9);
    }
}

/* As many colours as the palette has are exact, if they are not close. */
static void few_colors_stay(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int most = 1; most <= 64; most *= 4) {
        for (int i = 0; i < PIXELS; i++) {
            int color = (int)(most * check_random(&seed));

            for (int c = 0; c < 3; c++)
                rgb[3 * i + c] = (uint8_t)(85 * (color >> 2 * c & 3));
        }
        make(most);
        assert_int_equal(cut.count, most);
        check_means();
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++)
                assert_int_equal(channel(numbers[i], c), rgb[3 * i + c]);
    }
}

/* Mean of a channel over 4x4 pixels, of the image or of what is shown. */
static double block_mean(int x, int y, int c, bool is_shown)
{
    double sum = 0;

    for (int i = 0; i < 16; i++) {
        int at = (y + i / 4) * WIDTH + x + i % 4;

        sum += is_shown ? channel(numbers[at], c) : rgb[3 * at + c];
    }
    return sum / 16;
}

/* A slow change of grey in 16 colours, whose levels are 16 apart, has no steps
 * where the dither of eight levels reaches: the means over 4x4 pixels are
 * nearer than those of the nearest colours, which are off by 4 on average. */
static void ramps_have_small_steps(void **state)
{
    double error = 0;

    (void)state;
    for (int i = 0; i < PIXELS; i++)
        memset(rgb + 3 * i, 255 * (i % WIDTH) / WIDTH, 3);
    make(16);
    check_means();
    for (int x = 0; x < WIDTH; x += 4)
        error += fabs(block_mean(x, 0, 0, true) - block_mean(x, 0, 0, false)) *
                 4 / WIDTH;
    check_at_most(error, 3.0);
    make(64);
    check_means();
    for (int x = 0; x < WIDTH; x += 4)
        check_close(block_mean(x, 0, 0, true), block_mean(x, 0, 0, false), 1.5);
}

/* Squared errors. That of random colours is hardly larger than that of a
 * division of the cube into as many cells, 6x6x3, where a cell has the variance
 * of a uniform distribution. Of groups of colours only the variance of 0, 1 and
 * 2 around their centres is left, and what rounding adds. */
static void colors_go_where_pixels_are(void **state)
{
    uint64_t seed = 2;
    double error = 0, uniform = (2 * 42.5 * 42.5 + 85.0 * 85.0) / 12;

    (void)state;
    for (int i = 0; i < 3 * PIXELS; i++)
        rgb[i] = (uint8_t)(256 * check_random(&seed));
    make(108);
    check_means();
    for (int i = 0; i < 3 * PIXELS; i++)
        error += pow(rgb[i] - channel(numbers[i / 3], i % 3), 2) / PIXELS;
    check_at_most(error, 1.2 * uniform);
    for (int i = 0; i < PIXELS; i++) {
        int centre = (int)(27 * check_random(&seed));

        for (int c = 0; c < 3; c++, centre /= 3)
            rgb[3 * i + c] = (uint8_t)(30 + centre % 3 * 80 +
                                       (int)(3 * check_random(&seed)));
    }
    make(108);
    error = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        error += pow(rgb[i] - channel(numbers[i / 3], i % 3), 2) / PIXELS;
    check_at_most(error, 3 * (2.0 / 3 + 0.25));
}

/* The numbers are a function of the image and of its place in the pattern. */
static void still_images_stay(void **state)
{
    static uint8_t before[PIXELS];
    struct color_cut_image image = {rgb, WIDTH, HEIGHT, 4, 8};
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < 3 * PIXELS; i++)
        rgb[i] = (uint8_t)(256 * check_random(&seed));
    make(COLOR_CUT_MAX);
    memcpy(before, numbers, PIXELS);
    color_cut(&cut, &image, COLOR_CUT_MAX, numbers);
    assert_memory_equal(numbers, before, PIXELS);
}

static int set_up(void **state)
{
    struct error err;

    (void)state;
    return color_cut_init(&cut, &err) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    color_cut_free(&cut);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_colors_stay),
        cmocka_unit_test(ramps_have_small_steps),
        cmocka_unit_test(colors_go_where_pixels_are),
        cmocka_unit_test(still_images_stay),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
