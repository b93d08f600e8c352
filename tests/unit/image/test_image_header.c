// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/files.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/machine.h"
#include "tests/unit/whole_image.h"

/* Most memory that the process may gain from a file that promises gigabytes. */
#define GROWTH_KIB 8192

static long resident_kib(void)
{
    struct rusage usage;

    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

/* Checks that the image is refused in either form and takes no memory. */
static void fails(const char *path, const char *expected)
{
    long before = resident_kib();
    struct image image;
    struct error err;
    uint64_t clamped;

    assert_false(image_read_8bit(&image, path, &err));
    assert_string_equal(err.text, expected);
    assert_false(image_read_linear(&image, path, &clamped, &err));
    assert_string_equal(err.text, expected);
    if (!IS_SANITIZED)
        check_at_most((double)(resident_kib() - before), GROWTH_KIB);
}

static void reads(const char *path, int width, int height)
{
    struct image image;
    struct error err;
    uint64_t clamped;

    check_or_say(image_read_8bit(&image, path, &err), err.text);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    image_free(&image);
    check_or_say(image_read_linear(&image, path, &clamped, &err), err.text);
    image_free(&image);
}

/* Checks that the whole file can be read, and that it is too short without its
 * last byte. */
static void is_just_enough(const char *path, const void *data,
                           size_t size_bytes, int width, int height)
{
    char expected[200];

    put_bytes(path, data, size_bytes);
    reads(path, width, height);
    put_bytes(path, data, size_bytes - 1);
    snprintf(expected, sizeof expected,
             "%s: found %zu bytes, expected more for %dx%d pixels", path,
             size_bytes - 1, width, height);
    fails(path, expected);
}

static void tga_files_too_short_for_their_size_are_refused(void **state)
{
    static const char short_raw[] = "\0\0\2\0\0\0\0\0\0\0\0\0\xff\x7f\xff\x1f"
                                    "\x20\0x";
    static const char raw[] = "\2\0\2\0\0\0\0\0\0\0\0\0\3\0\2\0\x18\0"
                              "idabcdefghijklmnopqr";
    /* Three equal pixels, then two runs of two different ones, of which the
     * last is beyond the picture. */
    static const char runs[] = "\0\0\12\0\0\0\0\0\0\0\0\0\3\0\2\0\x10\0"
                               "\x82"
                               "ab\1cdef\1ghij";
    static const char palette[] = "\0\1\1\0\0\2\0\x18\0\0\0\0\2\0\2\0\10\0"
                                  "abcdef\0\1\0\1";
    static const char palette_runs[] = "\0\1\11\0\0\2\0\x20\0\0\0\0\x00\1\2\0"
                                       "\10\0abcdefgh\xff\0\xff\1\xff\0\xff\1";

    (void)state;
    put_bytes("a.tga", short_raw, sizeof short_raw - 1);
    fails("a.tga",
          "a.tga: found 19 bytes, expected more for 32767x8191 pixels");
    is_just_enough("a.tga", raw, sizeof raw - 1, 3, 2);
    is_just_enough("a.tga", runs, sizeof runs - 1, 3, 2);
    is_just_enough("a.tga", palette, sizeof palette - 1, 2, 2);
    is_just_enough("a.tga", palette_runs, sizeof palette_runs - 1, 256, 2);
}

/* The first row is padded to 12 bytes; the last one need not be. */
static void bmp_files_too_short_for_their_size_are_refused(void **state)
{
    static const char head[54] = "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0"
                                 "\3\0\0\0\2\0\0\0\1\0\x18";
    char bmp[54 + 12 + 9] = "";

    (void)state;
    memcpy(bmp, head, sizeof head);
    is_just_enough("a.bmp", bmp, sizeof bmp, 3, 2);
    /* A negative height: rows from the top down. */
    memcpy(bmp + 22, "\xfe\xff\xff\xff", 4);
    is_just_enough("a.bmp", bmp, sizeof bmp, 3, 2);
    memcpy(bmp + 18, "\0\x40\0\0\0\x40\0\0", 8);
    put_bytes("a.bmp", bmp, sizeof bmp);
    fails("a.bmp",
          "a.bmp: found 75 bytes, expected more for 16384x16384 pixels");
    memcpy(bmp + 10, "\xff\xff\xff\x7f", 4); /* offset of the pixels */
    memcpy(bmp + 18, "\1\0\0\0\1\0\0\0", 8);
    put_bytes("a.bmp", bmp, sizeof bmp);
    fails("a.bmp", "a.bmp: found 75 bytes, expected more for 1x1 pixels");
}

/* Writes a grey JPEG of `blocks` blocks with two bits each, the fewest
 * possible: the only codes of the two tables mean that the average stays the
 * same and that the block ends. */
static void put_jpeg(const char *path, int side, int blocks)
{
    static const char tables[] = "\xff\xdb\0\x43\0";
    static const char frame[] = "\xff\xc0\0\x0b\10SIDE\1\1\x11\0";
    static const char codes[] = "\xff\xc4\0\x14\0\1\0\0\0\0\0\0\0\0\0\0\0"
                                "\0\0\0\0\0";
    static const char scan[] = "\xff\xda\0\x08\1\1\0\0\x3f\0";
    char jpeg[2000] = "\xff\xd8", *p = jpeg + 2;

    p = (char *)mempcpy(p, tables, sizeof tables - 1);
    memset(p, 1, 64);
    p = (char *)mempcpy(p + 64, frame, sizeof frame - 1);
    p[-8] = p[-6] = (char)(side >> 8);
    p[-7] = p[-5] = (char)side;
    for (char table = 0; table < 2; table++) {
        p = (char *)mempcpy(p, codes, sizeof codes - 1);
        p[-18] = (char)(table << 4);
    }
    p = (char *)mempcpy(p, scan, sizeof scan - 1) + blocks / 4;
    p = (char *)mempcpy(p, "\xff\xd9", 2);
    put_bytes(path, jpeg, (size_t)(p - jpeg));
}

static void jpeg_files_too_short_for_their_size_are_refused(void **state)
{
    (void)state;
    put_jpeg("a.jpg", 256, 32 * 32);
    reads("a.jpg", 256, 256);
    put_jpeg("a.jpg", 16384, 32 * 32);
    fails("a.jpg", "a.jpg: found 396 bytes, expected more for 16384x16384 "
                   "pixels");
    put_bytes("a.jpg", "\xff\xd8\xff\xe0\0\4zz\xff\xd9", 10);
    fails("a.jpg", "a.jpg: found an image that cannot be read (JPEG without a "
                   "frame that is known)");
}

/* Writes a signature, a header, and a chunk of this many zeros. */
static void put_png(const char *path, uint32_t side, char depth, char color,
                    size_t zeros)
{
    unsigned char head[33] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR";
    char *data = calloc(1, sizeof head + zeros);

    for (int i = 0; i < 8; i++)
        head[16 + i] = (unsigned char)(side >> (24 - 8 * (i % 4)));
    head[24] = (unsigned char)depth;
    head[25] = (unsigned char)color;
    memcpy(data, head, sizeof head);
    put_bytes(path, data, sizeof head + zeros);
    free(data);
}

static void png_files_too_short_for_their_size_are_refused(void **state)
{
    (void)state;
    put_png("a.png", 16384, 8, 0, 1000);
    fails("a.png", "a.png: found 1033 bytes, expected more for 16384x16384 "
                   "pixels");
    /* The message is about PNG, although other formats are tried too. */
    put_png("a.png", 16384, 16, 2, 2 << 20);
    fails("a.png", "a.png: found 16384x16384 pixels of 16 bits a channel, "
                   "expected less than 2 GiB of them");
    put_png("a.png", 16, 8, 7, 100);
    fails("a.png", "a.png: found an image that cannot be read (Corrupt PNG)");
    put_png("a.png", 16, 8, 6, 100);
    fails("a.png", "a.png: found an image that cannot be read (PNG not "
                   "supported: unknown PNG chunk type)");
    put_bytes("a.png", "\x89PNG\r\n\x1a\n", 8);
    fails("a.png", "a.png: found an image that cannot be read (PNG without a "
                   "header)");
}

static void hdr_files_too_short_for_their_size_are_refused(void **state)
{
    static const char head[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\n123456789";
    char whole[100] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 65536\n";
    size_t length = strlen(whole);

    (void)state;
    put_bytes("a.hdr", head, sizeof head - 1);
    fails("a.hdr", "a.hdr: found 9 bytes of pixels, expected more for "
                   "16384x16384");
    /* The fewest bytes of the longest row: a pixel, and runs of 255 and of 255
     * * 256 pixels, 65536 in all. */
    memcpy(whole + length, "abcd\1\1\1\xff\1\1\1\xff", 12);
    put_bytes("a.hdr", whole, length + 12);
    reads("a.hdr", 65536, 1);
    put_bytes("a.hdr", whole, length + 11);
    fails("a.hdr", "a.hdr: found 11 bytes of pixels, expected more for "
                   "65536x1");
}

/* An image that does not fit into the budget is refused before it is
 * decoded. */
static void images_beyond_the_budget_are_not_decoded(void **state)
{
    struct memory_quota quota = cgroup_quota_memory("");
    uint64_t budget = quota.size_bytes / 4 * 3, room = 100 << 20;
    long before = resident_kib();
    char expected[300];
    struct image_file file;
    struct error err;

    (void)state;
    put_png("a.png", 4096, 8, 0, 20000);
    assert_true(image_open(&file, "a.png", IMAGE_8BIT, 0, &err));
    /* Packed and unpacked grey pixels, then 4 channels. */
    assert_true(file.memory_bytes >= (UINT64_C(5) << 24) + 20000 &&
                file.memory_bytes <= UINT64_C(10) << 24);
    uint64_t needed = file.memory_bytes;
    image_close(&file);
    assert_true(image_open(&file, "a.png", IMAGE_8BIT, budget - needed, &err));
    image_close(&file);
    assert_false(
        image_open(&file, "a.png", IMAGE_8BIT, budget - needed + 1, &err));
    assert_true(file.is_beyond);
    assert_false(image_open(&file, "a.png", IMAGE_8BIT, budget - room, &err));
    snprintf(expected, sizeof expected,
             "a.png: found an image that takes 146 MiB to read, expected 100 "
             "MiB at most (all images: three quarters of the %.0f MiB %s)",
             (double)quota.size_bytes / (1 << 20), quota.place);
    assert_string_equal(err.text, expected);
    /* The file alone exceeds the budget, so it is not read. */
    assert_false(image_open(&file, "a.png", IMAGE_8BIT, budget - 1000, &err));
    assert_true(file.is_beyond);
    assert_false(image_open(&file, "a.png", IMAGE_8BIT, UINT64_MAX, &err));
    check_at_most((double)(resident_kib() - before), GROWTH_KIB);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tga_files_too_short_for_their_size_are_refused),
        cmocka_unit_test(bmp_files_too_short_for_their_size_are_refused),
        cmocka_unit_test(jpeg_files_too_short_for_their_size_are_refused),
        cmocka_unit_test(png_files_too_short_for_their_size_are_refused),
        cmocka_unit_test(hdr_files_too_short_for_their_size_are_refused),
        cmocka_unit_test(images_beyond_the_budget_are_not_decoded),
    };

    return cmocka_run_group_tests_name("image_header", tests, enter_folder,
                                       remove_folder);
}
