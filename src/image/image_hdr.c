// SPDX-License-Identifier: MIT
#include "image/image_hdr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "image/color.h"
#include "image/image_header.h"

/* ---- Radiance ---- */

/* One of the two axes of the resolution line, such as "-Y 512": `length` steps
 * in the direction of its sign. y points up. */
struct axis {
    char name; /* 'X' or 'Y' */
    bool is_negative;
    int length;
};

struct hdr {
    double factors[3]; /* that pixels were multiplied by */
    bool is_xyz;
    struct axis slow, fast; /* from row to row of the file, and within one */
    const char *pixels;
};

bool image_hdr_is(const struct image_file *f)
{
    static const char *const marks[] = {"#?RADIANCE", "#?RGBE"};

    for (int i = 0; i < 2; i++) {
        size_t length = strlen(marks[i]);
        if (f->size_bytes > length && memcmp(f->data, marks[i], length) == 0)
            return true;
    }
    return false;
}

/* ---- header ---- */

/* Takes the next line, which ends with LF or CRLF. Returns false if there is no
 * end of a line. */
static bool next_line(const char **p, const char *end, const char **line,
                      const char **line_end)
{
    const char *lf = memchr(*p, '\n', (size_t)(end - *p));

    if (!lf)
        return false;
    *line = *p;
    *line_end = lf > *p && lf[-1] == '\r' ? lf - 1 : lf;
    *p = lf + 1;
    return true;
}

static bool skip_text(const char **p, const char *end, const char *text)
{
    size_t length = strlen(text);

    if ((size_t)(end - *p) < length || memcmp(*p, text, length) != 0)
        return false;
    *p += length;
    return true;
}

static void skip_blanks(const char **p, const char *end)
{
    while (*p < end && (**p == ' ' || **p == '\t'))
        ++*p;
}

/* Multiplies `count` factors by the numbers of a line. A single number is one
 * for all three. Numbers that no picture can be multiplied by are ignored. */
static void take_factors(struct hdr *h, const char *p, const char *end,
                         int count)
{
    double numbers[3];

    for (int i = 0; i < count; i++) {
        skip_blanks(&p, end);
        if (!decimal_parse(&p, end, &numbers[i]) || !(numbers[i] > 0) ||
            isinf(numbers[i]))
            return;
    }
    for (int k = 0; k < 3; k++)
        h->factors[k] *= numbers[count == 1 ? 0 : k];
}

/* Reads a line of the header. Returns true if it names a format that is
 * known. */
static bool read_variable(struct hdr *h, const char *p, const char *end)
{
    if (skip_text(&p, end, "EXPOSURE="))
        take_factors(h, p, end, 1);
    else if (skip_text(&p, end, "COLORCORR="))
        take_factors(h, p, end, 3);
    else if (skip_text(&p, end, "FORMAT=")) {
        skip_blanks(&p, end);
        h->is_xyz = skip_text(&p, end, "32-bit_rle_xyze");
        return h->is_xyz || skip_text(&p, end, "32-bit_rle_rgbe");
    }
    return false;
}

static bool read_axis(const struct image_file *f, const char **p,
                      const char *end, struct axis *axis, bool *is_axis,
                      struct error *err)
{
    double length;

    skip_blanks(p, end);
    *is_axis = end - *p > 2 && (**p == '-' || **p == '+') &&
               ((*p)[1] == 'X' || (*p)[1] == 'Y');
    if (!*is_axis)
        return true;
    axis->is_negative = **p == '-';
    axis->name = (*p)[1];
    *p += 2;
    skip_blanks(p, end);
    *is_axis = decimal_parse(p, end, &length);
    return !*is_axis || image_take_side(f, length, &axis->length, err);
}

static bool read_header(const struct image_file *f, struct hdr *h,
                        struct error *err)
{
    const char *p = f->data, *end = f->data + f->size_bytes;
    const char *line = p, *line_end = p;
    bool has_format = false, is_slow = false, is_fast = false;

    *h = (struct hdr){.factors = {1, 1, 1}};
    while (next_line(&p, end, &line, &line_end) && line < line_end)
        has_format |= read_variable(h, line, line_end);
    if (!has_format)
        return fail(err,
                    "%s: expected a header with FORMAT=32-bit_rle_rgbe or "
                    "FORMAT=32-bit_rle_xyze, and an empty line",
                    f->path);
    if (next_line(&p, end, &line, &line_end) &&
        (!read_axis(f, &line, line_end, &h->slow, &is_slow, err) ||
         !read_axis(f, &line, line_end, &h->fast, &is_fast, err)))
        return false;
    h->pixels = p;
    return (is_slow && is_fast && line == line_end &&
            h->slow.name != h->fast.name) ||
           fail(err,
                "%s: expected a line such as '-Y height +X width' after the "
                "header",
                f->path);
}

/* Returns the fewest bytes that encode a row of this width: one pixel and two
 * repeats of it, of which the first covers up to 255 pixels and the second any
 * number. */
static size_t row_bytes_min(int width)
{
    if (width == 1)
        return 4;
    return width <= 256 ? 8 : 12;
}

bool image_hdr_header(struct image_file *f, struct error *err)
{
    struct hdr h;
    size_t found;

    if (!read_header(f, &h, err))
        return false;
    f->width = h.slow.name == 'X' ? h.slow.length : h.fast.length;
    f->height = h.slow.name == 'X' ? h.fast.length : h.slow.length;
    if (!image_expect_limits(f, err))
        return false;
    found = f->size_bytes - (size_t)(h.pixels - f->data);
    return found / row_bytes_min(h.fast.length) >= (size_t)h.slow.length ||
           fail(err, "%s: found %zu bytes of pixels, expected more for %dx%d",
                f->path, found, f->width, f->height);
}

/* ---- pixels ---- */

/* Decodes a row with its four channels apart, each in runs (128 + n: n times
 * the next byte) and copies (n: the next n bytes). Returns false if the file or
 * a run ends in the wrong place. */
static bool packed_row(const unsigned char **p, const unsigned char *end,
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
static bool flat_row(const unsigned char **p, const unsigned char *end,
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

static bool read_row(const unsigned char **p, const unsigned char *end,
                     int width, unsigned char *rgbe)
{
    const unsigned char *q = *p;

    if (end - q < 4)
        return false;
    if (q[0] != 2 || q[1] != 2 || (q[2] << 8 | q[3]) != width)
        return flat_row(p, end, width, rgbe);
    *p += 4;
    return packed_row(p, end, width, rgbe);
}

/* Returns the column or the row, from the top, after some steps. */
static size_t place_on(const struct axis *axis, int steps)
{
    bool is_backward = axis->is_negative == (axis->name == 'X');

    return (size_t)(is_backward ? axis->length - 1 - steps : steps);
}

/* Decodes a pixel: a value is mantissa * 2^(exponent - 136), and black if the
 * exponent is 0. */
static void decode_pixel(const struct hdr *h, const unsigned char rgbe[4],
                         float *rgb)
{
    double from[3], linear[3];

    for (int k = 0; k < 3; k++)
        from[k] = (rgbe[3] ? ldexp(rgbe[k], rgbe[3] - 136) : 0) / h->factors[k];
    if (h->is_xyz)
        observer_rgb(from, linear);
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)(h->is_xyz ? linear[k] : from[k]);
}

float *image_hdr_decode(const struct image_file *f, struct error *err)
{
    struct hdr h;
    bool ok = read_header(f, &h, err);
    const unsigned char *p = (const unsigned char *)h.pixels;
    const unsigned char *end = (const unsigned char *)f->data + f->size_bytes;
    size_t width = (size_t)f->width;
    unsigned char *rgbe = ok ? alloc_array((size_t)h.fast.length, 4) : NULL;
    float *rgb =
        ok ? alloc_array(width * (size_t)f->height, 3 * sizeof *rgb) : NULL;

    if (ok && !(rgbe && rgb))
        ok = fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
                  f->height);
    for (int i = 0; ok && i < h.slow.length; i++) {
        size_t slow = place_on(&h.slow, i);

        if (!read_row(&p, end, h.fast.length, rgbe))
            ok = fail(err, "%s: found no end of row %d of %d", f->path, i + 1,
                      h.slow.length);
        for (int k = 0; ok && k < h.fast.length; k++) {
            size_t fast = place_on(&h.fast, k);
            size_t at =
                h.slow.name == 'Y' ? slow * width + fast : fast * width + slow;

            decode_pixel(&h, rgbe + 4 * (size_t)k, rgb + 3 * at);
        }
    }
    free(rgbe);
    if (ok)
        return rgb;
    free(rgb);
    return NULL;
}

/* ---- PFM ---- */

static size_t pixels_of(const struct image_file *f)
{
    return (size_t)f->width * (size_t)f->height;
}

static bool fail_memory(const struct image_file *f, struct error *err)
{
    return fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
                f->height);
}

bool image_pfm_is(const struct image_file *f)
{
    return f->size_bytes > 2 && f->data[0] == 'P' &&
           (f->data[1] == 'F' || f->data[1] == 'f') &&
           (f->data[2] == '\n' || f->data[2] == '\r' || f->data[2] == ' ');
}

/* Reads the header of a PFM file: "PF" or "Pf", width, height, scale, one white
 * space. Rows come from the bottom up, little endian if the scale is negative.
 */
bool image_pfm_header(struct image_file *f, struct error *err)
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
    if (!image_take_side(f, numbers[0], &f->width, err) ||
        !image_take_side(f, numbers[1], &f->height, err))
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

float *image_pfm_decode(const struct image_file *f, struct error *err)
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
