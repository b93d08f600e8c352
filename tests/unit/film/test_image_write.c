// SPDX-License-Identifier: MIT
/* test_image_write.c - the contents of PNG, HDR and PFM files */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/unit/files.h"
#include "tests/unit/film/written_films.h"
#include "tests/unit/whole_image.h"

/* Values over five decades, and black. */
static float wide_range(int x, int y, int c)
{
    if (x == 5 && y == 5)
        return 0;
    return powf(10.0f, (float)((x * 7 + y * 13 + c * 5) % 50) / 10 - 3);
}

static void format_follows_the_ending(void **state)
{
    (void)state;
    assert_int_equal(image_write_format_of("a.png"), IMAGE_WRITE_PNG);
    assert_int_equal(image_write_format_of("a.b/C.PNG"), IMAGE_WRITE_PNG);
    assert_int_equal(image_write_format_of("-"), IMAGE_WRITE_PNG);
    assert_int_equal(image_write_format_of("a.hdr"), IMAGE_WRITE_HDR);
    assert_int_equal(image_write_format_of("a.pfm"), IMAGE_WRITE_PFM);
    assert_int_equal(image_write_format_of("png"), IMAGE_WRITE_UNKNOWN);
    assert_int_equal(image_write_format_of(""), IMAGE_WRITE_UNKNOWN);
    assert_int_equal(image_write_format_of("a.jpg"), IMAGE_WRITE_UNKNOWN);
}

static void png_has_the_frame_s_bytes(void **state)
{
    struct film film;
    struct frame frame;
    struct error err;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, wide_range);
    assert_true(frame_init(&frame, WIDTH, HEIGHT, &err));
    for (float exposure = -2; exposure <= 2; exposure += 2) {
        film_resolve(&film, develop_linear(exposure), &frame);
        assert_true(
            image_write(&film, develop_linear(exposure), NULL, "a.png", &err));
        has_bytes("a.png", &frame);
    }
    frame_free(&frame);
    film_free(&film);
}

static void hdr_has_the_film_s_means(void **state)
{
    struct film film;
    struct image image;
    struct error err;
    uint64_t clamped;
    double excess = 0;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, wide_range);
    assert_true(image_write(&film, develop_linear(3), NULL, "a.hdr", &err));
    film_free(&film);
    assert_true(image_read_linear(&image, "a.hdr", &clamped, &err));
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    const float *rgb = image.rgb;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float expected[3], greatest = 0;
        for (int c = 0; c < 3; c++) {
            expected[c] = wide_range(i % WIDTH, i / WIDTH, c);
            greatest = fmaxf(greatest, expected[c]);
        }
        /* The bound is half a step of 8 bits, at the worst mantissa. */
        for (int c = 0; c < 3; c++) {
            check_close(rgb[3 * i + c], expected[c], greatest / 256);
            if (greatest > 0)
                excess +=
                    (double)(rgb[3 * i + c] - expected[c]) / (double)greatest;
        }
    }
    /* The mean is no darker. */
    check_close(excess / (3 * WIDTH * HEIGHT), 0, 3e-4);
    image_free(&image);
}

static float near_powers(int x, int y, int c)
{
    (void)c;
    return ldexpf(1 - ldexpf(1, -24 + y), x - 18);
}

/* The greatest mantissas round up to the next exponent. */
static void hdr_is_right_beside_powers_of_two(void **state)
{
    struct film film;
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, near_powers);
    assert_true(image_write(&film, develop_linear(0), NULL, "p.hdr", &err));
    film_free(&film);
    assert_true(image_read_linear(&image, "p.hdr", &clamped, &err));
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float expected = near_powers(i % WIDTH, i / WIDTH, 0);
        check_close(image.rgb[3 * i], expected, expected / 256);
    }
    image_free(&image);
}

static void pfm_has_the_film_s_exact_means(void **state)
{
    static const char header[] = "PF\n37 23\n-1.0\n";
    struct film film;
    struct error err;
    size_t size;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, wide_range);
    float *linear = calloc(WIDTH * HEIGHT * 3, sizeof *linear);
    assert_non_null(linear);
    film_linear(&film, linear);
    assert_true(image_write(&film, develop_linear(5), NULL, "a.pfm", &err));
    film_free(&film);
    char *text = read_file("a.pfm", &size);
    size_t head = strlen(header);
    assert_int_equal(size, head + sizeof(float) * WIDTH * HEIGHT * 3);
    assert_memory_equal(text, header, head);
    for (int y = 0; y < HEIGHT; y++) {
        const char *row =
            text + head + sizeof(float) * WIDTH * 3 * (size_t)(HEIGHT - 1 - y);
        float first;
        assert_memory_equal(row, linear + y * WIDTH * 3,
                            sizeof(float) * WIDTH * 3);
        memcpy(&first, row, sizeof first);
        check_close(first, wide_range(0, y, 0),
                    2.5e-7 * (double)wide_range(0, y, 0));
    }
    free(text);
    free(linear);
}

static void small_pictures_are_written(void **state)
{
    static const char *const paths[] = {"s.png", "s.hdr", "s.pfm"};
    static const int sizes[][2] = {{1, 1}, {1, 300}, {300, 1}, {8, 8}};
    struct error err;

    (void)state;
    for (size_t i = 0; i < 4; i++) {
        struct film film;
        make_film(&film, sizes[i][0], sizes[i][1], light);
        for (int k = 0; k < 3; k++)
            assert_true(
                image_write(&film, develop_linear(0), NULL, paths[k], &err));
        struct frame frame;
        assert_true(frame_init(&frame, sizes[i][0], sizes[i][1], &err));
        film_resolve(&film, develop_linear(0), &frame);
        has_bytes("s.png", &frame);
        frame_free(&frame);
        film_free(&film);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(format_follows_the_ending),
        cmocka_unit_test(png_has_the_frame_s_bytes),
        cmocka_unit_test(hdr_has_the_film_s_means),
        cmocka_unit_test(hdr_is_right_beside_powers_of_two),
        cmocka_unit_test(pfm_has_the_film_s_exact_means),
        cmocka_unit_test(small_pictures_are_written),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
