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
                                    .is_virtual = round % 2,
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
    struct kitty_image image = {.id = 123};
    size_t length = kitty_erase(&image, bytes);

    (void)state;
    assert_true(length <= kitty_bytes_max(0, 0));
    assert_string_equal(bytes, "\033_Ga=d,d=I,i=123,q=2\033\\");
    image.is_virtual = true;
    length = kitty_erase(&image, bytes);
    assert_true(length <= kitty_bytes_max(0, 0));
    assert_string_equal(
        bytes, "\033Ptmux;\033\033_Ga=d,d=I,i=123,q=2\033\033\\\033\\");
}

/* The placeholder is U+10EEEE. Rows 0 and 3 are the combining characters U+0305
 * and U+0310, column 0 is U+0305. */
static void placeholders_have_row_and_column(void **state)
{
    struct kitty_image image = {.id = 77, .cols = 3, .rows = 4};
    char bytes[64] = "";

    (void)state;
    assert_true(kitty_cells(&image, 0, bytes) <= kitty_cells_bytes_max(3));
    assert_string_equal(bytes, "\033[38;5;77m\xf4\x8e\xbb\xae\xcc\x85\xcc\x85"
                               "\xf4\x8e\xbb\xae\xf4\x8e\xbb\xae");
    memset(bytes, 0, sizeof bytes);
    kitty_cells(&image, 3, bytes);
    assert_string_equal(bytes, "\033[38;5;77m\xf4\x8e\xbb\xae\xcc\x90\xcc\x85"
                               "\xf4\x8e\xbb\xae\xf4\x8e\xbb\xae");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encoded_pixels_are_decoded),
        cmocka_unit_test(one_image_is_erased),
        cmocka_unit_test(placeholders_have_row_and_column),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
