// SPDX-License-Identifier: MIT
#include "tests/unit/files.h"
#include "tests/unit/shared.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/error.h"
#include "image/stb.h"
#include "tests/unit/whole_image.h"

static char png_suite[500];

/* Finds the suite before the current folder changes. */
static int enter(void **state)
{
    char *real = realpath(shared_folder(), NULL);

    snprintf(png_suite, sizeof png_suite, "%s/suites/png",
             real ? real : shared_folder());
    free(real);
    return enter_folder(state);
}

static void put_text(const char *path, const char *text)
{
    put_bytes(path, text, strlen(text));
}

static void append(void *context, void *data, int size_bytes)
{
    fwrite(data, 1, (size_t)size_bytes, context);
}

static void both_fail(const char *path, const char *expected)
{
    struct error err;
    struct image image;
    uint64_t clamped;

    err.text[0] = '\0';
    assert_false(image_read_8bit(&image, path, &err));
    if (!strstr(err.text, expected))
        print_error("found '%s', expected '%s'\n", err.text, expected);
    assert_non_null(strstr(err.text, expected));
    assert_null(image.rgba);
    err.text[0] = '\0';
    assert_false(image_read_linear(&image, path, &clamped, &err));
    assert_non_null(strstr(err.text, expected));
    assert_null(image.rgb);
}

/* The sRGB curve in the form of the standard. */
static double srgb_decode(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static void png_gives_its_bytes_and_linear_light(void **state)
{
    uint8_t pixels[16 * 16 * 4];
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    for (int i = 0; i < 256; i++) {
        pixels[4 * i] = (uint8_t)i;
        pixels[4 * i + 1] = (uint8_t)(255 - i);
        pixels[4 * i + 2] = (uint8_t)(i * 7);
        pixels[4 * i + 3] = (uint8_t)(i * 3);
    }
    FILE *f = fopen("a.png", "wb");
    assert_non_null(f);
    stbi_write_png_to_func(append, f, 16, 16, 4, pixels, 64);
    fclose(f);
    assert_true(image_read_8bit(&image, "a.png", &err));
    assert_int_equal(image.width, 16);
    assert_int_equal(image.height, 16);
    assert_null(image.rgb);
    assert_memory_equal(image.rgba, pixels, sizeof pixels);
    image_free(&image);
    assert_true(image_read_linear(&image, "a.png", &clamped, &err));
    assert_int_equal(clamped, 0);
    assert_null(image.rgba);
    for (int i = 0; i < 256; i++) {
        for (int c = 0; c < 3; c++)
            check_close(image.rgb[3 * i + c],
                        srgb_decode(pixels[4 * i + c] / 255.0), 6e-8);
    }
    assert_true(image.rgb[0] == 0 && image.rgb[1] == 1);
    image_free(&image);
}

/* Pixels of a 2x1 picture, written by hand: (m, e) means m * 2^(e - 136). */
static void hdr_values_are_exact(void **state)
{
    static const char text[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"
                               "-Y 2 +X 1\n"
                               "\x80\x40\x01\x81"
                               "\xff\x00\x80\x90";
    static const float expected[] = {1.0f,         0.5f, 1.0f / 128,
                                     255 * 256.0f, 0,    128 * 256.0f};
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    put_bytes("a.hdr", text, sizeof text - 1);
    assert_true(image_read_linear(&image, "a.hdr", &clamped, &err));
    assert_int_equal(image.width, 1);
    assert_int_equal(image.height, 2);
    for (int i = 0; i < 6; i++)
        assert_true(image.rgb[i] == expected[i]);
    image_free(&image);
    assert_true(image_read_8bit(&image, "a.hdr", &err));
    assert_null(image.rgb);
    static const uint8_t bytes[] = {255, 188, 22, 255, 255, 0, 255, 255};
    assert_memory_equal(image.rgba, bytes, sizeof bytes);
    image_free(&image);
}

#define HDR_HEAD "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n"

/* Rows of 8 pixels: one with separate channels in runs and copies, one of whole
 * pixels with the old repeats. */
static void packed_hdr_rows_are_unpacked(void **state)
{
    static const char text[] = HDR_HEAD "-Y 2 +X 8\n"
                                        "\x02\x02\x00\x08"
                                        "\x88\x80"
                                        "\x03\x40\x20\x10\x85\x00"
                                        "\x87\x01\x01\x02"
                                        "\x01\x00\x87\x81"
                                        "\x80\x00\x00\x81"
                                        "\x01\x01\x01\x06"
                                        "\x00\x80\x00\x82";
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    put_bytes("packed.hdr", text, sizeof text - 1);
    assert_true(image_read_linear(&image, "packed.hdr", &clamped, &err));
    assert_int_equal(image.width, 8);
    assert_int_equal(image.height, 2);
    for (int x = 0; x < 8; x++) {
        static const float green[] = {0, 0.25f, 0.125f, 0, 0, 0, 0, 0};
        const float *low = image.rgb + 3 * x, *high = low + 24;
        float blue = x == 7 ? 2.0f / 128 : 1.0f / 128;
        /* Exponent 0 is black for all mantissas. */
        assert_true(low[0] == (x == 0 ? 0.0f : 1.0f));
        assert_true(low[1] == green[x]);
        assert_true(low[2] == (x == 0 ? 0.0f : blue));
        assert_true(high[0] == (x == 7 ? 0.0f : 1.0f));
        assert_true(high[1] == (x == 7 ? 2.0f : 0.0f));
        assert_true(high[2] == 0.0f);
    }
    image_free(&image);
    for (size_t size = 60; size < sizeof text - 1; size++) {
        put_bytes("cut.hdr", text, size);
        assert_false(image_read_linear(&image, "cut.hdr", &clamped, &err));
    }
    assert_string_equal(err.text, "cut.hdr: found no end of row 2 of 2");
}

/* Reads a file of one pixel or more with these lines and pixels of 4 bytes. */
static struct image read_hdr(const char *lines, const char *pixels,
                             size_t size_bytes)
{
    char text[256];
    size_t length = strlen(lines);
    struct image image;
    struct error err;
    uint64_t clamped;

    memcpy(text, lines, length);
    memcpy(text + length, pixels, size_bytes);
    put_bytes("a.hdr", text, length + size_bytes);
    check_or_say(image_read_linear(&image, "a.hdr", &clamped, &err), err.text);
    return image;
}

/* Radiance: pixels were multiplied by all of EXPOSURE and COLORCORR. Lines may
 * end with CRLF. */
static void hdr_factors_are_divided_by(void **state)
{
    struct image image = read_hdr("#?RADIANCE\nEXPOSURE=2.0\n"
                                  "FORMAT=32-bit_rle_rgbe\nEXPOSURE= 4\n"
                                  "COLORCORR=1 .5 .25\nEXPOSURE=x\n\n"
                                  "-Y 1 +X 1\n",
                                  "\x80\x40\x20\x84", 4);

    (void)state;
    check_close((double)image.rgb[0], 8 / 8., 0);
    check_close((double)image.rgb[1], 4 / (8 * .5), 0);
    check_close((double)image.rgb[2], 2 / (8 * .25), 0);
    image_free(&image);
    image = read_hdr("#?RGBE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n"
                     "-Y 1 +X 1\r\n",
                     "\x80\x40\x20\x81", 4);
    check_close((double)image.rgb[1], .5, 0);
    image_free(&image);
}

/* The white of D65 in XYZ is white, and the primaries are those of Rec.709:
 * red has x = .64, y = .33 and Y = .2126. */
static void xyz_pixels_are_converted(void **state)
{
    struct image image = read_hdr("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n"
                                  "-Y 1 +X 2\n",
                                  "\xf3\xff\xff\x80"
                                  "\xd3\x6d\x0a\x7f",
                                  8);

    (void)state;
    check_close((double)image.rgb[3], 1, 5e-3);
    check_close((double)image.rgb[4], 0, 5e-3);
    check_close((double)image.rgb[5], 0, 5e-3);
    check_close(0.2126 * (double)image.rgb[0] + 0.7152 * (double)image.rgb[1] +
                    0.0722 * (double)image.rgb[2],
                255 / 256., 1e-3); /* Y is luminance */
    image_free(&image);
}

/* The first axis is that of the file's rows. +Y goes up, +X to the right. */
static void hdr_rows_come_in_eight_orders(void **state)
{
    /* for each order, where the pixels 1 to 6 of a 3x2 image are in the file */
    static const struct {
        const char *line;
        unsigned char pixels[6];
    } orders[8] = {{"-Y 2 +X 3\n", {1, 2, 3, 4, 5, 6}},
                   {"-Y 2 -X 3\n", {3, 2, 1, 6, 5, 4}},
                   {"+Y 2 +X 3\n", {4, 5, 6, 1, 2, 3}},
                   {"+Y 2 -X 3\n", {6, 5, 4, 3, 2, 1}},
                   {"+X 3 -Y 2\n", {1, 4, 2, 5, 3, 6}},
                   {"-X 3 -Y 2\n", {3, 6, 2, 5, 1, 4}},
                   {"+X 3 +Y 2\n", {4, 1, 5, 2, 6, 3}},
                   {"-X 3 +Y 2\n", {6, 3, 5, 2, 4, 1}}};

    (void)state;
    for (int i = 0; i < 8; i++) {
        char lines[80], pixels[24];
        struct image image;

        snprintf(lines, sizeof lines, HDR_HEAD "%s", orders[i].line);
        for (int k = 0; k < 6; k++)
            memcpy(pixels + 4 * k,
                   (const char[]){(char)orders[i].pixels[k], 0, 0, (char)136},
                   4);
        image = read_hdr(lines, pixels, sizeof pixels);
        assert_int_equal(image.width, 3);
        assert_int_equal(image.height, 2);
        for (int k = 0; k < 6; k++)
            check_close((double)image.rgb[3 * k], k + 1, 0);
        image_free(&image);
    }
}

static void broken_hdr_files_have_their_message(void **state)
{
    static const char no_end[] = HDR_HEAD "-Y 1 +X 8\n\2\2\0\x08\0\0\0\0";
    static const char repeat[] = HDR_HEAD "-Y 1 +X 2\n\1\1\1\1\0\0\0\0";

    (void)state;
    put_text("e.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_hsve\n\n-Y 1 +X 1\n1234");
    both_fail("e.hdr", "e.hdr: expected a header with FORMAT=32-bit_rle_rgbe");
    put_text("e.hdr", "#?RADIANCE\n");
    both_fail("e.hdr", "e.hdr: expected a header");
    put_text("e.hdr", HDR_HEAD "+X 1 -X 1\n1234");
    both_fail("e.hdr", "e.hdr: expected a line such as '-Y height +X width'");
    put_text("e.hdr", HDR_HEAD "-Y 1");
    both_fail("e.hdr", "e.hdr: expected a line such as '-Y height +X width'");
    put_text("e.hdr", HDR_HEAD "-Y nan +X 1\n1234");
    both_fail("e.hdr", "e.hdr: found a side of nan pixels, expected a whole");
    put_text("e.hdr", HDR_HEAD "-Y 1.5 +X 1\n1234");
    both_fail("e.hdr", "e.hdr: found a side of 1.5 pixels, expected a whole");
    put_text("e.hdr", HDR_HEAD "-Y 1 +X 1.5\n1234");
    both_fail("e.hdr", "e.hdr: found a side of 1.5 pixels, expected a whole");
    put_text("e.hdr", HDR_HEAD "-Y 99999 +X 99999\n1234");
    both_fail("e.hdr", "e.hdr: found 99999x99999 pixels, expected sides");
    put_bytes("e.hdr", no_end, sizeof no_end - 1);
    both_fail("e.hdr", "e.hdr: found no end of row 1 of 1");
    put_bytes("e.hdr", repeat, sizeof repeat - 1);
    both_fail("e.hdr", "e.hdr: found no end of row 1 of 1");
}

/* stb_image 2.27 writes out of bounds for these files, in the header and
 * between two scans. */
static void jpeg_tables_too_large_are_refused(void **state)
{
    unsigned char jpeg[600] = "\xff\xd8\xff\xe0\0\x06\xff\xc4\xff\xff"
                              "\xff\xc4\x02\0\x10";

    (void)state;
    memset(jpeg + 15, 16, 16); /* 16 codes of each length: 256 */
    assert_true(stb_is_safe(jpeg, sizeof jpeg));
    jpeg[20] = 17;
    assert_false(stb_is_safe(jpeg, sizeof jpeg));
    put_bytes("tables.jpg", jpeg, sizeof jpeg);
    both_fail("tables.jpg", "tables.jpg: found a Huffman table of more than");
    memcpy(jpeg + 2, "\xff\xda\0\x04zz", 6); /* a scan comes first */
    assert_false(stb_is_safe(jpeg, sizeof jpeg));
    jpeg[0] = 0; /* not a JPEG */
    assert_true(stb_is_safe(jpeg, sizeof jpeg));
}

/* The greatest RGBE values exceed the limit of what is kept. */
static void hdr_values_are_clamped(void **state)
{
    static const char text[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"
                               "-Y 1 +X 1\n\xff\x01\x00\xff";
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    put_bytes("b.hdr", text, sizeof text - 1);
    assert_true(image_read_linear(&image, "b.hdr", &clamped, &err));
    assert_int_equal(clamped, 2);
    assert_true(image.rgb[0] == 1e30f);
    assert_true(image.rgb[2] == 0);
    image_free(&image);
}

static void put_pfm(const char *path, const char *header, const float *values,
                    size_t count)
{
    FILE *f = fopen(path, "wb");

    assert_non_null(f);
    fputs(header, f);
    fwrite(values, sizeof *values, count, f);
    fclose(f);
}

static void pfm_values_are_exact(void **state)
{
    static const float values[] = {1,  2,        3,      4, 5, 6,
                                   -1, INFINITY, 1e-40f, 7, 8, 9};
    static const float expected[] = {0, 1e30f, 1e-40f, 7, 8, 9,
                                     1, 2,     3,      4, 5, 6};
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    put_pfm("a.pfm", "PF\n2 2\n-1.0\n", values, 12);
    assert_true(image_read_linear(&image, "a.pfm", &clamped, &err));
    assert_int_equal(clamped, 2);
    assert_int_equal(image.width, 2);
    assert_int_equal(image.height, 2);
    assert_memory_equal(image.rgb, expected, sizeof expected);
    image_free(&image);

    put_bytes("big.pfm", "Pf 1 1 1\n\x3f\x80\x00\x00", 13);
    assert_true(image_read_linear(&image, "big.pfm", &clamped, &err));
    for (int c = 0; c < 3; c++)
        assert_true(image.rgb[c] == 1);
    image_free(&image);

    static const float nan[] = {0, NAN, 0};
    put_pfm("nan.pfm", "PF\n1 1\n-1.0\n", nan, 3);
    both_fail("nan.pfm", "nan.pfm: found a pixel that is not a number");
    put_pfm("short.pfm", "PF\n2 2\n-1.0\n", values, 11);
    both_fail("short.pfm", "short.pfm: found 44 bytes of pixels, expected 48");
    put_text("head.pfm", "PF\n2 x\n");
    both_fail("head.pfm",
              "head.pfm: expected width, height and scale after 'PF'");
    put_text("huge.pfm", "PF\n99999999999 1\n-1\n");
    both_fail("huge.pfm", "huge.pfm: found a side of 1e+11 pixels");
    put_text("wide.pfm", "PF\n70000 1\n-1\n");
    both_fail("wide.pfm", "expected sides of 1 to 65536");
}

/* Writes a signature and an IHDR whose CRC stb ignores. */
static void put_png_header(const char *path, uint32_t width, uint32_t height)
{
    unsigned char png[33] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR";

    for (int i = 0; i < 4; i++) {
        png[16 + i] = (unsigned char)(width >> (24 - 8 * i));
        png[20 + i] = (unsigned char)(height >> (24 - 8 * i));
    }
    png[24] = 8; /* depth */
    png[25] = 6; /* RGBA */
    put_bytes(path, png, sizeof png);
}

static void unreadable_files_have_their_message(void **state)
{
    (void)state;
    both_fail("nothing.png", "nothing.png: no such file");
    both_fail(".", ".: found a folder");
    put_text("empty.png", "");
    both_fail("empty.png", "empty.png: found no image that can be read");
    put_text("text.png", "This is not a picture at all, it is text.\n");
    both_fail("text.png", "text.png: found no image that can be read");
    put_bytes("a.ktx2", "\xabKTX 20\xbb\r\n\x1a\n", 13);
    both_fail("a.ktx2", "a.ktx2: found a KTX2 image, expected PNG");
    put_png_header("wide.png", 65537, 65535);
    both_fail("wide.png", "wide.png: found 65537x65535 pixels, expected sides");
    put_png_header("large.png", 32768, 32767);
    both_fail("large.png", "large.png: found 32768x32767 pixels, expected");
    put_png_header("cut.png", 16, 16);
    both_fail("cut.png", "cut.png: found an image that cannot be read (PNG");
}

/* A scanline of zeros compresses a thousandfold. A file of some megabytes for
 * one pixel that would inflate to gigabytes takes little memory. */
static void compression_bombs_take_little_memory(void **state)
{
    int side = 5000;
    char *zeros = calloc((size_t)side, (size_t)side * 3);
    struct rusage before, after;

    (void)state;
    assert_non_null(zeros);
    FILE *f = fopen("bomb.png", "wb");
    assert_non_null(f);
    stbi_write_png_to_func(append, f, side, side, 3, zeros, side * 3);
    free(zeros);
    fseek(f, 16, SEEK_SET);
    fwrite("\0\0\0\1\0\0\0\1", 1, 8, f);
    fclose(f);
    getrusage(RUSAGE_SELF, &before);
    struct error err;
    struct image image;
    if (image_read_8bit(&image, "bomb.png", &err))
        image_free(&image);
    getrusage(RUSAGE_SELF, &after);
    check_at_most((double)(after.ru_maxrss - before.ru_maxrss), 64 << 10);
}

/* Each part of a file, and each file with some bytes changed, gives an image or
 * an error. */
static void broken_files_give_an_image_or_an_error(void **state)
{
    static const char *const paths[] = {"a.png", "a.hdr", "packed.hdr",
                                        "a.pfm"};
    uint64_t random = 1;
    struct error err;
    struct image image;
    uint64_t clamped;

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        char bytes[4096];
        FILE *f = fopen(paths[k], "rb");
        assert_non_null(f);
        size_t size = fread(bytes, 1, sizeof bytes, f);
        fclose(f);
        for (int i = 0; i < 600; i++) {
            char changed[4096];
            memcpy(changed, bytes, size);
            for (int j = 0; j < i % 5; j++)
                changed[(size_t)(check_random(&random) * (double)size)] =
                    (char)(unsigned char)(check_random(&random) * 256);
            size_t kept =
                i % 2 ? size : (size_t)(check_random(&random) * (double)size);
            put_bytes("changed", changed, kept);
            if (image_read_8bit(&image, "changed", &err))
                image_free(&image);
            if (image_read_linear(&image, "changed", &clamped, &err))
                image_free(&image);
        }
    }
}

/* Runs the system's sha256sum on a file. */
static void sha256_of(const char *path, char sum[65])
{
    char command[256];

    snprintf(command, sizeof command, "sha256sum < %s", path);
    FILE *f = popen(command, "r");
    assert_non_null(f);
    assert_int_equal(fread(sum, 1, 64, f), 64);
    sum[64] = '\0';
    pclose(f);
}

/* Returns the value of a line `"key": value,` without quotes, or NULL. */
static char *value_of(char *line, const char *key)
{
    size_t length = strlen(key);

    if (line[0] != '"' || strncmp(line + 1, key, length) != 0 ||
        line[1 + length] != '"')
        return NULL;
    char *value = line + length + 4;
    value += *value == '"';
    value[strcspn(value, "\",\n")] = '\0';
    return value;
}

/* Reads one file of the suite. `sum` is "" for a file that is broken on
 * purpose, which may be read or refused. */
static int read_one(const char *suites, const char *name, const char *sum)
{
    char path[1000], found[65];
    struct error err;
    struct image image;
    uint64_t clamped;

    snprintf(path, sizeof path, "%s/%s", suites, name);
    bool is_linear = image_read_linear(&image, path, &clamped, &err);
    image_free(&image);
    if (*sum != '\0' && !is_linear) {
        print_error("%s\n", err.text);
        return 1;
    }
    if (!image_read_8bit(&image, path, &err)) {
        if (*sum != '\0')
            print_error("%s\n", err.text);
        return *sum != '\0';
    }
    put_bytes("pixels", image.rgba,
              4 * (size_t)image.width * (size_t)image.height);
    image_free(&image);
    if (*sum == '\0')
        return 0;
    sha256_of("pixels", found);
    if (strcmp(found, sum) != 0)
        print_error("%s: other pixels than expected\n", name);
    return strcmp(found, sum) != 0;
}

/* Reads PNG files of many programs and compares the pixels with those of a
 * strict decoder. */
static void png_suite_has_the_right_pixels(void **state)
{
    char line[1000], name[300] = "", sum[65] = "", path[700];
    int files = 0, whole = 0, wrong = 0;

    (void)state;
    snprintf(path, sizeof path, "%s/expected.json", png_suite);
    FILE *f = fopen(path, "r");
    if (!f) {
        print_message("skipped: there is no %s\n", path);
        skip();
    }
    while (fgets(line, sizeof line, f)) {
        char *value;
        if (strncmp(line, "\"png/", 5) == 0) {
            snprintf(name, sizeof name, "%.*s", (int)strcspn(line + 5, "\""),
                     line + 5);
            sum[0] = '\0';
        } else if ((value = value_of(line, "rgba8_sha256"))) {
            snprintf(sum, sizeof sum, "%.64s", value);
        } else if (value_of(line, "valid")) {
            files++;
            whole += sum[0] != '\0';
            wrong += read_one(png_suite, name, sum);
        }
    }
    fclose(f);
    print_message("%d files, %d of them whole\n", files, whole);
    assert_true(files > 700 && whole > 100);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(png_gives_its_bytes_and_linear_light),
        cmocka_unit_test(hdr_values_are_exact),
        cmocka_unit_test(packed_hdr_rows_are_unpacked),
        cmocka_unit_test(hdr_factors_are_divided_by),
        cmocka_unit_test(xyz_pixels_are_converted),
        cmocka_unit_test(hdr_rows_come_in_eight_orders),
        cmocka_unit_test(broken_hdr_files_have_their_message),
        cmocka_unit_test(jpeg_tables_too_large_are_refused),
        cmocka_unit_test(hdr_values_are_clamped),
        cmocka_unit_test(pfm_values_are_exact),
        cmocka_unit_test(unreadable_files_have_their_message),
        cmocka_unit_test(compression_bombs_take_little_memory),
        cmocka_unit_test(broken_files_give_an_image_or_an_error),
        cmocka_unit_test(png_suite_has_the_right_pixels),
    };

    return cmocka_run_group_tests_name("image", tests, enter, remove_folder);
}
