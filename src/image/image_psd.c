// SPDX-License-Identifier: MIT
#include "image/image_psd.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/image_bytes.h"
#include "image/image_header.h"

/* Offsets in the header, all numbers with the highest byte first. Behind it are
 * three parts, each after its length of 4 bytes. */
enum { CHANNELS = 12, HEIGHT = 14, WIDTH = 18, DEPTH = 22, MODE = 24 };
enum { HEADER_BYTES = 26, PART_COUNT = 3 };

/* Colour mode of red, green and blue. */
#define MODE_RGB 3

#define CHANNELS_MAX 56

/* Bytes of a packed run that two bytes may stand for. */
#define RUN_MAX 128

bool image_psd_is(const struct image_file *f)
{
    return f->size_bytes >= HEADER_BYTES && memcmp(f->data, "8BPS\0\1", 6) == 0;
}

static bool is_packed(const struct image_file *f)
{
    return big16(bytes_of(f), f->pixels_at) != 0;
}

static size_t value_bytes(const struct image_file *f)
{
    return f->value_max > 255 ? 2 : 1;
}

static bool fail_length(const struct image_file *f, struct error *err)
{
    return fail(err, "%s: found %zu bytes, expected more for %dx%d pixels",
                f->path, f->size_bytes, f->width, f->height);
}

/* Returns the least bytes of the pixels: of a packed row, its length of two
 * bytes and a run of two bytes for RUN_MAX values. */
static size_t least_bytes(const struct image_file *f)
{
    size_t rows = (size_t)f->channels * (size_t)f->height;
    size_t values = (size_t)f->width * value_bytes(f);

    return 2 + rows * (is_packed(f) ? 2 + 2 * ((values + RUN_MAX - 1) / RUN_MAX)
                                    : values);
}

static int clamped_int(uint32_t n)
{
    return n > INT_MAX ? INT_MAX : (int)n;
}

bool image_psd_header(struct image_file *f, struct error *err)
{
    uint32_t channels = big16(bytes_of(f), CHANNELS),
             depth = big16(bytes_of(f), DEPTH);
    size_t at = HEADER_BYTES;

    f->width = clamped_int(big32(bytes_of(f), WIDTH));
    f->height = clamped_int(big32(bytes_of(f), HEIGHT));
    if (!image_expect_limits(f, err))
        return false;
    for (int i = 0; i < PART_COUNT && at < f->size_bytes; i++)
        at += 4 + (size_t)big32(bytes_of(f), at);
    f->pixels_at = at;
    if (big16(bytes_of(f), MODE) != MODE_RGB || channels < 3 ||
        channels > CHANNELS_MAX || (depth != 8 && depth != 16) ||
        big16(bytes_of(f), at) > 1)
        return fail(err,
                    "%s: found a PSD file of another kind, expected red, green "
                    "and blue of 8 or 16 bits",
                    f->path);
    f->channels = (int)channels;
    f->value_max = depth == 8 ? 255 : 65535;
    return (at < f->size_bytes && f->size_bytes - at >= least_bytes(f)) ||
           fail_length(f, err);
}

/* ---- rows ---- */

/* Unpacks `count` bytes: a byte n below 128 is followed by n + 1 bytes, one
 * above by a byte that is repeated 257 - n times. Advances *at. Returns false
 * if the file ends, or a run is too long. */
static bool unpack(const struct image_file *f, size_t *at, size_t count,
                   uint8_t *to)
{
    while (count > 0) {
        size_t n = byte_at(bytes_of(f), *at),
               length = n < 128 ? n + 1 : 257 - n;

        if (n == 128) { /* nothing */
            if (++*at >= f->size_bytes)
                return false;
            continue;
        }
        if (length > count || *at + 1 + (n < 128 ? length : 1) > f->size_bytes)
            return false;
        if (n < 128)
            memcpy(to, f->data + *at + 1, length);
        else
            memset(to, (int)byte_at(bytes_of(f), *at + 1), length);
        *at += 1 + (n < 128 ? length : 1);
        to += length;
        count -= length;
    }
    return true;
}

/* Reads the next row of a channel. Returns false if it is malformed. */
static bool read_row(const struct image_file *f, size_t *at, uint8_t *row)
{
    size_t count = (size_t)f->width * value_bytes(f);

    if (is_packed(f))
        return unpack(f, at, count, row);
    memcpy(row, f->data + *at, count);
    *at += count;
    return true;
}

/* Writes a row of a channel to the pixels. The first byte of a value suffices:
 * the result has 8 bits. */
static void put_row(const struct image_file *f, const uint8_t *row, int channel,
                    uint8_t *rgba)
{
    for (int x = 0; x < f->width; x++)
        rgba[4 * x + channel] = row[(size_t)x * value_bytes(f)];
}

static bool read_channels(const struct image_file *f, uint8_t *row,
                          uint8_t *rgba)
{
    size_t rows = (size_t)f->channels * (size_t)f->height;
    size_t at = f->pixels_at + 2 + (is_packed(f) ? 2 * rows : 0);

    for (int c = 0; c < 4 && c < f->channels; c++)
        for (int y = 0; y < f->height; y++) {
            if (!read_row(f, &at, row))
                return false;
            put_row(f, row, c, rgba + 4 * (size_t)y * (size_t)f->width);
        }
    return true;
}

/* Removes the white that Photoshop mixes with colours according to alpha. */
static void remove_white(uint8_t *rgba, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++, rgba += 4)
        for (int c = 0; c < 3 && rgba[3] > 0; c++) {
            int color = 255 - (255 - rgba[c]) * 255 / rgba[3];

            rgba[c] = (uint8_t)(color > 0 ? color : 0);
        }
}

uint8_t *image_psd_decode(const struct image_file *f, struct error *err)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    uint8_t *rgba = alloc_array(pixels, 4);
    uint8_t *row = alloc_array((size_t)f->width, value_bytes(f));

    if (rgba != NULL)
        memset(rgba, 255, 4 * pixels);
    if (rgba == NULL || row == NULL) {
        fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
             f->height);
        free(rgba);
        rgba = NULL;
    } else if (!read_channels(f, row, rgba)) {
        fail(err, "%s: found a row of another length than %d pixels", f->path,
             f->width);
        free(rgba);
        rgba = NULL;
    } else if (f->channels > 3) {
        remove_white(rgba, pixels);
    }
    free(row);
    return rgba;
}
