// SPDX-License-Identifier: MIT
#include "image/image_pfm.h"

#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "image/image_header.h"

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
