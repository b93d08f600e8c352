// SPDX-License-Identifier: MIT
#include "picture/image_float.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "picture/image_exr_read.h"
#include "picture/image_header.h"

static size_t pixels_of(const struct image_file *f)
{
    return (size_t)f->width * (size_t)f->height;
}

static bool fail_memory(const struct image_file *f, struct error *err)
{
    return fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
                f->height);
}

/* Sets a side from the number in the header. Fails if it is out of range. */
static bool take_side(const struct image_file *f, double number, int *side,
                      struct error *err)
{
    if (!(number >= 1 && number <= INT_MAX) || number != floor(number))
        return fail(err,
                    "%s: found a side of %g pixels, expected a whole number "
                    "from 1 to %d",
                    f->path, number, IMAGE_SIDE_MAX);
    *side = (int)number;
    return true;
}

static bool is_pfm(const struct image_file *f)
{
    return f->size_bytes > 2 && f->data[0] == 'P' &&
           (f->data[1] == 'F' || f->data[1] == 'f') &&
           (f->data[2] == '\n' || f->data[2] == '\r' || f->data[2] == ' ');
}

/* Reads the header of a PFM file: "PF" or "Pf", width, height, scale, one white
 * space. Rows come from the bottom up, little endian if the scale is negative.
 */
static bool pfm_header(struct image_file *f, struct error *err)
{
    const char *p = f->data + 2;
    const char *end = f->data + f->size_bytes;
    double numbers[3] = {0};

    for (int i = 0; i < 3; i++) {
        while (p < end && memchr(" \t\r\n", *p, 4))
            p++;
        if (!decimal_parse(&p, end, &numbers[i]) || p == end)
            return fail(err, "%s: expected width, height and scale after 'P%c'",
                        f->path, f->data[1]);
    }
    if (!take_side(f, numbers[0], &f->width, err) ||
        !take_side(f, numbers[1], &f->height, err))
        return false;
    f->pixels_at = (size_t)(p + 1 - f->data);
    f->channels = f->data[1] == 'F' ? 3 : 1;
    f->is_big_endian = numbers[2] > 0;
    if (!image_expect_limits(f, err))
        return false;
    size_t found = f->size_bytes - f->pixels_at;
    size_t expected = 4 * (size_t)f->channels * pixels_of(f);
    return found >= expected ||
           fail(err, "%s: found %zu bytes of pixels, expected %zu", f->path,
                found, expected);
}

static float pfm_value(const struct image_file *f, size_t index)
{
    const unsigned char *b =
        (const unsigned char *)f->data + f->pixels_at + 4 * index;
    uint32_t bits;
    float value;

    if (f->is_big_endian)
        bits = (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 |
               (uint32_t)b[2] << 8 | b[3];
    else
        bits = (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 |
               (uint32_t)b[1] << 8 | b[0];
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float *pfm_pixels(const struct image_file *f, struct error *err)
{
    size_t row = (size_t)f->width * (size_t)f->channels;
    float *rgb = alloc_array(pixels_of(f), 3 * sizeof *rgb);
    size_t to = 0;

    if (!rgb) {
        fail_memory(f, err);
        return NULL;
    }
    for (int y = f->height - 1; y >= 0; y--) {
        for (int x = 0; x < f->width; x++) {
            size_t from = (size_t)y * row + (size_t)(x * f->channels);
            for (int c = 0; c < 3; c++)
                rgb[to++] = pfm_value(f, from + (size_t)(c % f->channels));
        }
    }
    return rgb;
}

static bool is_hdr(const struct image_file *f)
{
    static const char *const marks[] = {"#?RADIANCE", "#?RGBE"};

    for (int i = 0; i < 2; i++) {
        size_t length = strlen(marks[i]);
        if (f->size_bytes > length && memcmp(f->data, marks[i], length) == 0)
            return true;
    }
    return false;
}

static bool skip_text(const char **p, const char *end, const char *text)
{
    size_t length = strlen(text);

    if ((size_t)(end - *p) < length || memcmp(*p, text, length) != 0)
        return false;
    *p += length;
    return true;
}

/* Returns the fewest bytes that encode a row of this width: one pixel and two
 * repeats of it, of which the first covers up to 255 pixels and the second any
 * number. */
static size_t hdr_row_bytes_min(int width)
{
    if (width == 1)
        return 4;
    return width <= 256 ? 8 : 12;
}

/* Reads the header of an HDR file: lines of text up to an empty one, then "-Y
 * height +X width". */
static bool hdr_header(struct image_file *f, struct error *err)
{
    static const char blank[] = "\n\n", format[] = "FORMAT=32-bit_rle_rgbe";
    const char *end = f->data + f->size_bytes;
    const char *p = memmem(f->data, f->size_bytes, blank, 2);
    double height, width;

    if (!p || !memmem(f->data, (size_t)(p - f->data), format, strlen(format)))
        return fail(err, "%s: expected a header with %s", f->path, format);
    p += strlen(blank);
    if (!skip_text(&p, end, "-Y ") || !decimal_parse(&p, end, &height) ||
        !skip_text(&p, end, " +X ") || !decimal_parse(&p, end, &width) ||
        !skip_text(&p, end, "\n"))
        return fail(err, "%s: expected '-Y height +X width' after the header",
                    f->path);
    f->pixels_at = (size_t)(p - f->data);
    if (!take_side(f, width, &f->width, err) ||
        !take_side(f, height, &f->height, err) || !image_expect_limits(f, err))
        return false;
    size_t found = f->size_bytes - f->pixels_at;
    return found / hdr_row_bytes_min(f->width) >= (size_t)f->height ||
           fail(err, "%s: found %zu bytes of pixels, expected more for %dx%d",
                f->path, found, f->width, f->height);
}

/* Decodes a row with its four channels apart, each in runs (128 + n: n times
 * the next byte) and copies (n: the next n bytes). Returns false if the file or
 * a run ends in the wrong place. */
static bool hdr_packed_row(const unsigned char **p, const unsigned char *end,
                           int width, unsigned char *rgbe)
{
    for (int c = 0; c < 4; c++) {
        for (int x = 0; x < width;) {
            if (end - *p < 2)
                return false;
            int count = *(*p)++;
            bool is_run = count > 128;
            count -= is_run ? 128 : 0;
            if (count == 0 || count > width - x ||
                end - *p < (is_run ? 1 : count))
                return false;
            for (int i = 0; i < count; i++)
                rgbe[4 * x++ + c] = is_run ? **p : (*p)[i];
            *p += is_run ? 1 : count;
        }
    }
    return true;
}

/* Decodes a row of whole pixels. A pixel 1 1 1 n repeats the last one n times;
 * n counts 256 times as much in the second of two such pixels. */
static bool hdr_flat_row(const unsigned char **p, const unsigned char *end,
                         int width, unsigned char *rgbe)
{
    int shift = 0;

    for (int x = 0; x < width;) {
        if (end - *p < 4)
            return false;
        const unsigned char *pixel = *p;
        *p += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(rgbe + 4 * x++, pixel, 4);
            shift = 0;
            continue;
        }
        if (x == 0 || shift > 8 || pixel[3] << shift > width - x)
            return false;
        for (int n = pixel[3] << shift; n > 0; n--, x++)
            memcpy(rgbe + 4 * x, rgbe + 4 * (x - 1), 4);
        shift += 8;
    }
    return true;
}

static bool hdr_row(const unsigned char **p, const unsigned char *end,
                    int width, unsigned char *rgbe)
{
    const unsigned char *q = *p;

    if (end - q < 4)
        return false;
    if (q[0] != 2 || q[1] != 2 || (q[2] << 8 | q[3]) != width)
        return hdr_flat_row(p, end, width, rgbe);
    *p += 4;
    return hdr_packed_row(p, end, width, rgbe);
}

/* Decodes all pixels. A value is mantissa * 2^(exponent - 136); an exponent of
 * 0 means black. */
static float *hdr_pixels(const struct image_file *f, struct error *err)
{
    const unsigned char *data = (const unsigned char *)f->data;
    const unsigned char *p = data + f->pixels_at, *end = data + f->size_bytes;
    unsigned char *rgbe = malloc(4 * (size_t)f->width);
    float *rgb = alloc_array(pixels_of(f), 3 * sizeof *rgb);
    bool ok = (rgbe && rgb) || fail_memory(f, err);

    for (int y = 0; ok && y < f->height; y++) {
        float *row = rgb + 3 * (size_t)y * (size_t)f->width;
        if (!hdr_row(&p, end, f->width, rgbe))
            ok = fail(err, "%s: found no end of row %d of %d", f->path, y + 1,
                      f->height);
        for (int i = 0; ok && i < 3 * f->width; i++) {
            const unsigned char *pixel = rgbe + 4 * (i / 3);
            row[i] = pixel[3] ? ldexpf(pixel[i % 3], pixel[3] - 136) : 0;
        }
    }
    free(rgbe);
    if (ok)
        return rgb;
    free(rgb);
    return NULL;
}

enum image_kind image_float_kind(const struct image_file *file)
{
    if (image_exr_is(file))
        return IMAGE_EXR;
    if (is_pfm(file))
        return IMAGE_PFM;
    return is_hdr(file) ? IMAGE_HDR : IMAGE_UNKNOWN;
}

bool image_float_header(struct image_file *file, struct error *err)
{
    if (file->kind == IMAGE_EXR)
        return image_exr_header(file, err);
    return file->kind == IMAGE_PFM ? pfm_header(file, err)
                                   : hdr_header(file, err);
}

float *image_float_decode(const struct image_file *file, struct error *err)
{
    if (file->kind == IMAGE_EXR)
        return image_exr_decode(file, err);
    return file->kind == IMAGE_PFM ? pfm_pixels(file, err)
                                   : hdr_pixels(file, err);
}
