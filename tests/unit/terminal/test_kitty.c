// SPDX-License-Identifier: MIT
#include "tests/unit/pixels.h"

#include "terminal/kitty.h"

static struct kitty_pixels seen;

/* Encodes a part of a wider picture, in one and in many pieces. */
static void encoded_pixels_are_decoded(void **state)
{
    static uint8_t picture[3 * 300 * 80];
    uint64_t seed = 1;

    (void)state;
    for (size_t i = 0; i < sizeof picture; i++)
        picture[i] = (uint8_t)(256 * check_random(&seed));
    for (int round = 0; round < 60; round++) {
        int x = (int)(40 * check_random(&seed));
        int y = (int)(20 * check_random(&seed));
        struct kitty_image image = {.id = 1 + round,
                                    .cols = 3,
                                    .rows = 2,
                                    .width =
                                        1 + (int)(256 * check_random(&seed)),
                                    .height =
                                        1 + (int)(60 * check_random(&seed)),
                                    .rgb = picture + 3 * (300 * y + x),
                                    .stride_bytes = 3 * 300};
        size_t most = kitty_bytes_max(image.width, image.height);
        char *bytes = malloc(most + 1);
        size_t length = kitty_encode(&image, bytes);

        assert_true(length <= most);
        bytes[length] = '\0';
        assert_ptr_equal(kitty_read(bytes, &seen), bytes + length);
        free(bytes);
        assert_true(seen.cols == 3 && seen.rows == 2);
        assert_true(seen.id == image.id && seen.width == image.width &&
                    seen.height == image.height);
        for (int row = 0; row < image.height; row++)
            assert_memory_equal(seen.rgb + 3 * row * image.width,
                                image.rgb + row * 3 * 300,
                                3 * (size_t)image.width);
    }
}

static void one_image_is_erased(void **state)
{
    char bytes[128] = "";
    size_t length = kitty_erase(12345, bytes);

    (void)state;
    assert_true(length <= kitty_bytes_max(0, 0));
    assert_string_equal(bytes, "\033_Ga=d,d=I,i=12345,q=2\033\\");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encoded_pixels_are_decoded),
        cmocka_unit_test(one_image_is_erased),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
