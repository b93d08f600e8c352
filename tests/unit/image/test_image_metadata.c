// SPDX-License-Identifier: MIT
/*
 * test_image_metadata.c - the texts in PNG and HDR files, read by a parser of
 * their specifications, and the files still read as pictures
 */
#include <stdlib.h>
#include <string.h>

#include "tests/unit/files.h"
#include "tests/unit/film/written_films.h"
#include "tests/unit/whole_image.h"

/* ---- a reader of chunks ---- */

/* Returns the CRC-32 by the table of ISO 3309, which is filled by polynomial
 * division from the highest term; glim divides from the lowest. */
static uint32_t reflect(uint32_t bits, int count)
{
    uint32_t result = 0;

    for (int i = 0; i < count; i++)
        result |= (bits >> i & 1) << (count - 1 - i);
    return result;
}

static uint32_t crc_by_table(const unsigned char *bytes, size_t size)
{
    static uint32_t table[256];
    uint32_t crc = 0xffffffff;

    for (uint32_t i = 0; i < 256; i++) {
        uint32_t rest = i << 24;
        for (int bit = 0; bit < 8; bit++)
            rest = rest & 0x80000000 ? rest << 1 ^ 0x04c11db7 : rest << 1;
        table[i] = rest;
    }
    for (size_t i = 0; i < size; i++)
        crc = crc << 8 ^ table[crc >> 24 ^ reflect(bytes[i], 8)];
    return reflect(~crc, 32);
}

static uint32_t be32(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 |
           p[3];
}

/* Checks order and CRC of all chunks, and appends "TYPE key=value;" of each
 * text. */
static void read_chunks(const char *path, char texts[8192])
{
    size_t size, at = 8;
    unsigned char *png = (unsigned char *)read_file(path, &size);
    char order[256] = "";

    texts[0] = '\0';
    assert_memory_equal(png, "\x89PNG\r\n\x1a\n", 8);
    while (at < size) {
        uint32_t length = be32(png + at);
        const char *type = (const char *)png + at + 4;
        const char *key = type + 4;
        char value[512] = "";
        size_t skipped = strlen(key) + 1;

        assert_true(at + 12 + length <= size);
        assert_int_equal(crc_by_table(png + at + 4, length + 4),
                         be32(png + at + 8 + length));
        strncat(order, type, 4);
        if (memcmp(type, "iTXt", 4) == 0) {
            assert_memory_equal(key + skipped, "\0\0\0\0", 4);
            skipped += 4;
        }
        if (memcmp(type + 1, "TXt", 3) == 0 ||
            memcmp(type + 1, "EXt", 3) == 0) {
            strncat(value, key + skipped, length - skipped);
            strncat(texts, type, 4);
            strcat(strcat(strcat(texts, " "), key), "=");
            strcat(strcat(texts, value), ";");
        }
        at += 12 + length;
    }
    assert_int_equal(at, size);
    assert_memory_equal(order, "IHDR", 4);
    assert_string_equal(order + strlen(order) - 8, "IDATIEND");
    free(png);
}

static void crcs_are_the_published_ones(void **state)
{
    (void)state;
    /* the check value of CRC-32/ISO-HDLC, and the CRC of every IEND chunk */
    assert_int_equal(crc_by_table((const unsigned char *)"123456789", 9),
                     0xcbf43926);
    assert_int_equal(crc_by_table((const unsigned char *)"IEND", 4),
                     0xae426082);
}

/* ---- tests ---- */

static struct image_metadata two_texts(void)
{
    struct image_metadata m = {.count = 0};

    image_metadata_add(&m, IMAGE_KEY_SOFTWARE, "glim %d.%d", 0, 1);
    image_metadata_add(&m, "glim:scene", "%s",
                       "gr\xc3\xb6\xc3\x9f"
                       "e.obj");
    return m;
}

static void png_files_have_the_texts(void **state)
{
    struct image_metadata m = two_texts();
    char texts[8192];
    struct film film;
    struct frame frame;
    struct error err;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, light);
    assert_true(frame_init(&frame, WIDTH, HEIGHT, &err));
    film_resolve(&film, develop_linear(0), &frame);
    assert_true(image_write(&film, develop_linear(0), &m, "m.png", &err));
    read_chunks("m.png", texts);
    assert_string_equal(texts, "tEXt Software=glim 0.1;"
                               "iTXt glim:scene=gr\xc3\xb6\xc3\x9f"
                               "e.obj;");
    has_bytes("m.png", &frame);
    assert_true(image_write(&film, develop_linear(0), NULL, "m.png", &err));
    read_chunks("m.png", texts);
    assert_string_equal(texts, "");
    frame_free(&frame);
    film_free(&film);
}

static void hdr_files_have_comments(void **state)
{
    static const char begin[] = "#?RADIANCE\n# Software=glim 0.1\n"
                                "# glim:scene=gr\xc3\xb6\xc3\x9f"
                                "e.obj\n";
    struct image_metadata m = two_texts();
    struct film film;
    struct image with, without;
    struct error err;
    uint64_t clamped;
    size_t size;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, light);
    assert_true(image_write(&film, develop_linear(0), &m, "m.hdr", &err));
    assert_true(image_write(&film, develop_linear(0), NULL, "n.hdr", &err));
    film_free(&film);
    char *text = read_file("m.hdr", &size);
    assert_memory_equal(text, begin, strlen(begin));
    free(text);
    assert_true(image_read_linear(&with, "m.hdr", &clamped, &err));
    assert_true(image_read_linear(&without, "n.hdr", &clamped, &err));
    assert_memory_equal(with.rgb, without.rgb,
                        sizeof(float) * 3 * WIDTH * HEIGHT);
    image_free(&with);
    image_free(&without);
}

static void pfm_files_have_none(void **state)
{
    struct image_metadata m = two_texts();
    struct film film;
    struct error err;
    size_t sizes[2];

    (void)state;
    make_film(&film, WIDTH, HEIGHT, light);
    assert_true(image_write(&film, develop_linear(0), &m, "m.pfm", &err));
    assert_true(image_write(&film, develop_linear(0), NULL, "n.pfm", &err));
    film_free(&film);
    char *a = read_file("m.pfm", &sizes[0]);
    char *b = read_file("n.pfm", &sizes[1]);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(a, b, sizes[0]);
    free(a);
    free(b);
}

/* A name from outside cannot add a line to the header of an HDR file, nor a
 * byte that is no UTF-8. */
static void values_are_one_line_of_utf8(void **state)
{
    static const struct {
        const char *given, *expected;
    } cases[] = {
        {"a\nFORMAT=x\n-Y 1 +X 1", "a?FORMAT=x?-Y 1 +X 1"},
        {"\x1b[2J\x7f", "?[2J?"},
        {"\xff\xfe\xc3", "???"},
        {"\xe2\x80\xae"
         "cba",
         "?cba"}, /* right to left */
        {"\xf0\x9f\x98\x80", "\xf0\x9f\x98\x80"},
        {"", ""},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct image_metadata m = {.count = 0};

        image_metadata_add(&m, "k", "%s", cases[i].given);
        assert_string_equal(m.texts[0].value, cases[i].expected);
    }
}

/* The longest texts fit, and are not cut within a character. */
static void long_values_are_cut(void **state)
{
    struct image_metadata m = {.count = 0};
    const size_t longest = (IMAGE_VALUE_BYTES - 1) / 3 * 3;
    char name[3 * 1000 + 1] = "";
    unsigned char bytes[IMAGE_METADATA_BYTES];

    (void)state;
    for (int i = 0; i < 1000; i++)
        strcat(name, "\xe2\x82\xac"); /* the euro sign */
    for (int i = 0; i < IMAGE_METADATA_MAX; i++)
        image_metadata_add(&m, "abcdefghijklmnopqrstuvwxyz01234", "%s", name);
    assert_int_equal(strlen(m.texts[0].value), longest);
    assert_int_equal(image_metadata_png(&m, bytes),
                     IMAGE_METADATA_MAX * (12 + 32 + 4 + longest));
    assert_int_equal(image_metadata_hdr(&m, bytes),
                     IMAGE_METADATA_MAX * (2 + 31 + 1 + longest + 1));
}

/* Texts are found again in files of each format, and in any beginning of one
 * there are no others. */
static void texts_are_found_again(void **state)
{
    static const char *const names[] = {"m.png", "m.hdr", "m.exr", "m.pfm"};
    struct image_metadata m = two_texts(), found;
    struct film film;
    struct error err;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, light);
    for (int i = 0; i < 4; i++) {
        size_t size;

        assert_true(image_write(&film, develop_linear(0), &m, names[i], &err));
        char *bytes = read_file(names[i], &size);
        for (size_t k = 0; k <= size; k++) {
            char *part = malloc(k + 1); /* of this size, for sanitizers */

            memcpy(part, bytes, k);
            image_metadata_find(&found, part, k);
            free(part);
            assert_in_range(found.count, 0, m.count);
            for (int t = 0; t < found.count; t++) {
                assert_string_equal(found.texts[t].key, m.texts[t].key);
                assert_string_equal(found.texts[t].value, m.texts[t].value);
            }
        }
        assert_int_equal(found.count, i < 3 ? 2 : 0);
        free(bytes);
    }
    film_free(&film);
    assert_true(image_metadata_value(&m, "glim:seed") == NULL);
    assert_string_equal(image_metadata_value(&m, IMAGE_KEY_SOFTWARE),
                        "glim 0.1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crcs_are_the_published_ones),
        cmocka_unit_test(png_files_have_the_texts),
        cmocka_unit_test(hdr_files_have_comments),
        cmocka_unit_test(pfm_files_have_none),
        cmocka_unit_test(values_are_one_line_of_utf8),
        cmocka_unit_test(long_values_are_cut),
        cmocka_unit_test(texts_are_found_again),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
