// SPDX-License-Identifier: MIT
/*
 * test_image_kinds.c - PNM, GIF and PSD files have the pixels that their
 * specifications give them, and broken ones their message
 *
 * The GIF file is the example of M. Flickinger's "What's In A GIF", which
 * explains each of its bytes.
 */
#include <stdlib.h>
#include <string.h>

#include "tests/unit/files.h"
#include "tests/unit/whole_image.h"

static const uint8_t sample[] = {'G',  'I',  'F',  '8',  '9',  'a',  10,   0,
                                 10,   0,    0x91, 0,    0,    0xff, 0xff, 0xff,
                                 0xff, 0,    0,    0,    0,    0xff, 0,    0,
                                 0,    0x21, 0xf9, 4,    0,    0,    0,    0,
                                 0,    0x2c, 0,    0,    0,    0,    10,   0,
                                 10,   0,    0,    2,    0x16, 0x8c, 0x2d, 0x99,
                                 0x87, 0x2a, 0x1c, 0xdc, 0x33, 0xa0, 2,    0x75,
                                 0xec, 0x95, 0xfa, 0xa8, 0xde, 0x60, 0x8c, 4,
                                 0x91, 0x4c, 1,    0,    0x3b};

/* Offsets in the file. */
enum {
    SCREEN_WIDTH = 6,
    BACKGROUND = 11,
    CONTROL_FLAGS = 28,
    CONTROL_COLOR = 31,
    LEFT = 34,
    FLAGS = 42
};

static const char *const colors[10] = {"1111122222", "1111122222", "1111122222",
                                       "1110000222", "1110000222", "2220000111",
                                       "2220000111", "2222211111", "2222211111",
                                       "2222211111"};

static const uint8_t palette[3][3] = {{255, 255, 255},
                                      {255, 0, 0},
                                      {0, 0, 255}};

static struct image read_image(const void *bytes, size_t size_bytes)
{
    struct image image;
    struct error err;

    put_bytes("a.img", bytes, size_bytes);
    check_or_say(image_read_8bit(&image, "a.img", &err), err.text);
    return image;
}

static void check_row(const struct image *image, int y, const char *row)
{
    for (int x = 0; x < 10; x++) {
        const uint8_t *p = image->rgba + 4 * (10 * y + x);

        assert_memory_equal(p, palette[row[x] - '0'], 3);
        assert_int_equal(p[3], 255);
    }
}

static void gif_has_the_pixels_of_the_example(void **state)
{
    /* rows of the file, as four passes over the image order them */
    static const int interlaced[10] = {0, 8, 4, 2, 6, 1, 3, 5, 7, 9};
    uint8_t bytes[sizeof sample];
    struct image image = read_image(sample, sizeof sample);

    (void)state;
    assert_int_equal(image.width, 10);
    assert_int_equal(image.height, 10);
    for (int y = 0; y < 10; y++)
        check_row(&image, y, colors[y]);
    image_free(&image);
    memcpy(bytes, sample, sizeof bytes);
    bytes[FLAGS] = 0x40;
    image = read_image(bytes, sizeof bytes);
    for (int y = 0; y < 10; y++)
        check_row(&image, interlaced[y], colors[y]);
    image_free(&image);
}

static void gif_has_a_transparent_colour(void **state)
{
    uint8_t bytes[sizeof sample];
    struct image image;

    (void)state;
    memcpy(bytes, sample, sizeof bytes);
    bytes[CONTROL_FLAGS] = 1;
    bytes[CONTROL_COLOR] = 2;
    bytes[SCREEN_WIDTH] = 20; /* the rest is free, whatever the background */
    bytes[BACKGROUND] = 1;
    bytes[LEFT] = 4;
    image = read_image(bytes, sizeof bytes);
    for (int i = 0; i < 200; i++) {
        int x = i % 20 - 4, y = i / 20;

        assert_int_equal(image.rgba[4 * i + 3],
                         x < 0 || x > 9 || colors[y][x] == '2' ? 0 : 255);
    }
    image_free(&image);
}

static void check_rgb(const void *bytes, size_t size_bytes,
                      const uint8_t expected[6])
{
    struct image image = read_image(bytes, size_bytes);

    assert_int_equal(image.width, 2);
    assert_int_equal(image.height, 1);
    for (int i = 0; i < 2; i++) {
        assert_memory_equal(image.rgba + 4 * i, expected + 3 * i, 3);
        assert_int_equal(image.rgba[4 * i + 3], 255);
    }
    image_free(&image);
}

static void pnm_has_the_values_of_the_file(void **state)
{
    static const char p6[] = "P6\n# a comment\n2 1\n255\nabcdef";
    static const char p5[] = "P5 2 1 255\n\xff\x55";

    (void)state;
    check_rgb(p6, sizeof p6 - 1, (const uint8_t *)"abcdef");
    check_rgb(p5, sizeof p5 - 1, (const uint8_t[]){255, 255, 255, 85, 85, 85});
}

/* As a sky, sRGB 188 is half of white (IEC 61966-2-1). */
static void linear_values_are_decoded(void **state)
{
    struct image image;
    struct error err;
    uint64_t clamped;

    (void)state;
    put_bytes("a.img", "P6 1 1 255\n\xff\xbc\0", 14);
    check_or_say(image_read_linear(&image, "a.img", &clamped, &err), err.text);
    check_close((double)image.rgb[0], 1, 1e-6);
    check_close((double)image.rgb[1], .5029, 1e-4);
    check_close((double)image.rgb[2], 0, 0);
    image_free(&image);
}

static void fails(const void *bytes, size_t size_bytes, const char *expected)
{
    struct image image;
    struct error err;

    put_bytes("a.img", bytes, size_bytes);
    assert_false(image_read_8bit(&image, "a.img", &err));
    assert_string_equal(err.text, expected);
}

static void broken_files_have_their_message(void **state)
{
    (void)state;
    fails("P6\n2 x\n255\nabcdef", 17,
          "a.img: found P6 with values up to 0, expected P5 or P6 with values "
          "up to 255");
    fails(
        "P3 2 1 255 1 2 3 4 5 6", 22,
        "a.img: found P3 with values up to 255, expected P5 or P6 with values "
        "up to 255");
    fails("P5 2 1 65535\n\xff\xff\x80\x80", 17,
          "a.img: found P5 with values up to 65535, expected P5 or P6 with "
          "values up to 255");
    fails("P6 2 1 255\nabcde", 16,
          "a.img: found 16 bytes, expected more for 2x1 pixels");
    fails("P6 99999999999 1 255\nabc", 24,
          "a.img: found P6 with values up to 1, expected P5 or P6 with values "
          "up to 255");
    fails(sample, 6,
          "a.img: found no image that can be read, expected PNG, JPEG, BMP, "
          "WebP, PNM, GIF, PSD, Radiance HDR, PFM, OpenEXR or TGA");
    fails(sample, sizeof sample - 6,
          "a.img: found 63 bytes, expected more for 10x10 pixels");
    fails(sample, 20, "a.img: found 20 bytes, expected more for 10x10 pixels");
    fails("GIF89a\xff\x7f\xff\x7f\0\0\0", 13,
          "a.img: found 32767x32767 pixels, expected 268435456 in all at most");
    fails("GIF89a\xff\x3f\xff\x3f\0\0\0", 13,
          "a.img: found 13 bytes, expected more for 16383x16383 pixels");
}

/* ---- PSD ---- */

/* Header of a file of 3 x 2 pixels with 3 channels and empty parts. */
enum {
    PSD_CHANNELS = 13,
    PSD_DEPTH = 23,
    PSD_MODE = 25,
    PSD_PACKED = 39,
    PSD_HEADER = 40
};

static size_t put_psd_header(uint8_t *to)
{
    static const uint8_t header[PSD_HEADER] = {'8', 'B', 'P', 'S', 0, 1, 0,
                                               0,   0,   0,   0,   0, 0, 3,
                                               0,   0,   0,   2,   0, 0, 0,
                                               3,   0,   8,   0,   3};

    memcpy(to, header, sizeof header);
    return sizeof header;
}

/* Pixel i has the red 10 i, the green 10 i + 1 and the blue 10 i + 2. */
static void check_psd(const void *bytes, size_t size_bytes)
{
    struct image image = read_image(bytes, size_bytes);

    assert_int_equal(image.width, 3);
    assert_int_equal(image.height, 2);
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 4; c++)
            assert_int_equal(image.rgba[4 * i + c], c == 3 ? 255 : 10 * i + c);
    image_free(&image);
}

static void psd_has_its_pixels(void **state)
{
    uint8_t bytes[128];
    size_t size = put_psd_header(bytes);

    (void)state;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 6; i++)
            bytes[size++] = (uint8_t)(10 * i + c);
    check_psd(bytes, size);
    size = put_psd_header(bytes);
    bytes[PSD_PACKED] = 1;
    for (int row = 0; row < 6; row++) { /* lengths of the rows */
        bytes[size++] = 0;
        bytes[size++] = 4;
    }
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < 2; y++) {
            bytes[size++] = 2; /* three bytes follow */
            for (int x = 0; x < 3; x++)
                bytes[size++] = (uint8_t)(10 * (3 * y + x) + c);
        }
    check_psd(bytes, size);
}

/* Colours are mixed with white: half of red at half of alpha, or nearly. */
static void psd_loses_the_white(void **state)
{
    uint8_t bytes[PSD_HEADER + 4 * 6 * 2] = {0};
    struct image image;

    (void)state;
    put_psd_header(bytes);
    bytes[PSD_CHANNELS] = 4;
    bytes[PSD_DEPTH] = 16;
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < 6; i++)
            bytes[PSD_HEADER + 2 * (6 * c + i)] = c == 0   ? 255
                                                  : c == 3 ? 128
                                                           : 127;
    image = read_image(bytes, sizeof bytes);
    assert_int_equal(image.rgba[0], 255);
    assert_int_equal(image.rgba[1], 0);
    assert_int_equal(image.rgba[2], 0);
    assert_int_equal(image.rgba[3], 128);
    image_free(&image);
}

static void broken_psd_has_a_message(void **state)
{
    static const char another_kind[] =
        "a.img: found a PSD file of another kind, expected red, green and blue "
        "of 8 or 16 bits";
    uint8_t bytes[PSD_HEADER + 18] = {0};

    (void)state;
    put_psd_header(bytes);
    fails(bytes, sizeof bytes - 1,
          "a.img: found 57 bytes, expected more for 3x2 pixels");
    bytes[PSD_MODE] = 4; /* cyan, magenta, yellow and black */
    fails(bytes, sizeof bytes, another_kind);
    bytes[PSD_MODE] = 3;
    bytes[PSD_CHANNELS] = 0;
    fails(bytes, sizeof bytes, another_kind);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gif_has_the_pixels_of_the_example),
        cmocka_unit_test(gif_has_a_transparent_colour),
        cmocka_unit_test(pnm_has_the_values_of_the_file),
        cmocka_unit_test(linear_values_are_decoded),
        cmocka_unit_test(broken_files_have_their_message),
        cmocka_unit_test(psd_has_its_pixels),
        cmocka_unit_test(psd_loses_the_white),
        cmocka_unit_test(broken_psd_has_a_message),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
