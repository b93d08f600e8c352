// SPDX-License-Identifier: MIT
/*
 * test_error_map.c - colours of errors, and files of them
 */
#include "tests/unit/check.h"

#include <math.h>
#include <unistd.h>

#include "image/image_read.h"
#include "inspect/false_color.h"
#include "tests/unit/files.h"

#define WIDTH  12
#define HEIGHT 7
#define PIXELS (WIDTH * HEIGHT)

/* Three decades have four steps: black, violet, red, yellow, white. */
static void colors_are_logarithmic(void **state)
{
    static const uint32_t colors[] = {0x000000, 0x591a99, 0xe63333, 0xffcc00,
                                      0xffffff};

    (void)state;
    for (int i = 0; i < 5; i++) {
        uint32_t color = error_map_color((float)(1e-3 * pow(10, 0.75 * i)));

        for (int c = 0; c < 24; c += 8) /* rounding */
            check_close(color >> c & 255, colors[i] >> c & 255, 1);
    }
    assert_int_equal(error_map_color(0), 0);
    assert_int_equal(error_map_color(1e-4f), 0);
    assert_int_equal(error_map_color(1e6f), 0xffffff);
}

/* Pixel (x, y) has the samples 1 + x / 256 and 1 - x / 256. */
static void make_film(struct film *film)
{
    struct error err;

    assert_true(film_init(film, WIDTH, HEIGHT, &err));
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            float a = 1 + (float)x / 256, b = 1 - (float)x / 256;
            struct path_sample samples[2] = {{.radiance = {a, a, a}},
                                             {.radiance = {b, b, b}}};

            film_add_row(film, (struct film_pixels){x, y, 1, 1}, samples, NULL,
                         (const int[]){2});
        }
}

/* Errors are x / 256, relative to 1 with the tenth of white; the root mean
 * square has the columns from x - 2 to x + 2. */
static double error_at(int x)
{
    double sum = 0, count = 0;

    for (int i = x - 2; i <= x + 2; i++) {
        if (i < 0 || i >= WIDTH)
            continue;
        sum += i / 256.0 * i / 256.0 / 1.01;
        count++;
    }
    return sqrt(sum / count);
}

static void check_numbers(const char *path, double tolerance)
{
    struct image_file file;
    struct image image;
    uint64_t clamped;
    struct film film;
    struct error err;

    make_film(&film);
    check_or_say(error_map_write(&film, 0, path, &err), err.text);
    check_or_say(image_open(&file, path, IMAGE_LINEAR, 0, &err), err.text);
    check_or_say(image_decode(&file, &image, &clamped, &err), err.text);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    for (int i = 0; i < 3 * PIXELS; i++)
        check_close((double)image.rgb[i], error_at(i / 3 % WIDTH), tolerance);
    image_free(&image);
    film_free(&film);
}

/* HDR files round to 8 bits. Weights of noisy pixels are corrected by 1e-4. */
static void files_have_the_errors(void **state)
{
    (void)state;
    check_numbers("map.pfm", 1e-5);
    check_numbers("map.hdr", 2e-4);
}

static void a_png_has_the_colors(void **state)
{
    struct image_file file;
    struct image image;
    uint64_t clamped;
    struct film film;
    struct error err;

    (void)state;
    make_film(&film);
    check_or_say(error_map_write(&film, 0, "map.png", &err), err.text);
    check_or_say(image_open(&file, "map.png", IMAGE_8BIT, 0, &err), err.text);
    check_or_say(image_decode(&file, &image, &clamped, &err), err.text);
    for (int i = 0; i < PIXELS; i++) {
        uint32_t color = error_map_color((float)error_at(i % WIDTH));

        for (int c = 0; c < 3; c++)
            check_close(image.rgba[4 * i + c], color >> (16 - 8 * c) & 255, 1);
    }
    image_free(&image);
    film_free(&film);
}

/* A pixel without a second sample has no error, and no file is written. */
static void unknown_errors_have_no_map(void **state)
{
    struct path_sample sample = {.radiance = {1, 1, 1}};
    struct film film;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 1, 1, &err));
    film_add_row(&film, (struct film_pixels){0, 0, 1, 1}, &sample, NULL,
                 (const int[]){1});
    assert_false(error_map_write(&film, 0, "none.png", &err));
    assert_string_equal(err.text, "none.png: found a pixel with less than two "
                                  "samples, which has no known error");
    assert_int_equal(access("none.png", F_OK), -1);
    film_free(&film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_logarithmic),
        cmocka_unit_test(files_have_the_errors),
        cmocka_unit_test(a_png_has_the_colors),
        cmocka_unit_test(unknown_errors_have_no_map),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
