// SPDX-License-Identifier: MIT
#include "tests/unit/pixels.h"

#include "terminal/sixel.h"

static struct sixels seen;
static uint8_t numbers[PIXELS_MAX];
static struct rgb colors[256];

/* Encodes, decodes and compares an image. Returns the number of bytes. */
static size_t check_image(int width, int height)
{
    struct sixel_image image = {width, height, colors, numbers};
    size_t most = sixel_bytes_max(width, height);
    char *bytes = malloc(most + 1);
    size_t length = sixel_encode(&image, bytes);

    assert_true(length <= most);
    bytes[length] = '\0';
    assert_ptr_equal(sixels_read(bytes, &seen), bytes + length);
    free(bytes);
    assert_true(seen.width == width && seen.height == height);
    for (int i = 0; i < width * height; i++)
        assert_int_equal(seen.number[i], numbers[i]);
    for (int n = 0; n < 256; n++) {
        if (seen.percent[n][0] < 0)
            continue;
        check_close(seen.percent[n][0] * 2.55, colors[n].r, 1.28);
        check_close(seen.percent[n][1] * 2.55, colors[n].g, 1.28);
        check_close(seen.percent[n][2] * 2.55, colors[n].b, 1.28);
    }
    return length;
}

/* Tests sizes that are not multiples of a band, with few colours in runs and
 * many in noise. Every pixel is set once, to its colour. */
static void encoded_pixels_are_decoded(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int n = 0; n < 256; n++)
        colors[n] = (struct rgb){n, 255 - n, n * 7 % 256};
    for (int round = 0; round < 60; round++) {
        int count = round % 2 ? 16 : 256;
        int width = 1 + (int)(SIXEL_WIDTH_MAX * check_random(&seed));
        int height = 1 + (int)(40 * check_random(&seed));
        double change = round % 3 == 0 ? 1 : 0.1;
        int n = 0;

        for (int i = 0; i < width * height; i++) {
            if (i == 0 || check_random(&seed) < change)
                n = (int)(count * check_random(&seed));
            numbers[i] = (uint8_t)n;
        }
        check_image(width, height);
    }
}

/* A flat image has one run per band: 6 rows of 256 pixels in a few bytes. */
static void flat_images_are_short(void **state)
{
    (void)state;
    memset(numbers, 196, sizeof numbers);
    check_at_most((double)check_image(256, 60),
                  40 + 18 + 10 * strlen("#196!256~-"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encoded_pixels_are_decoded),
        cmocka_unit_test(flat_images_are_short),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
