// SPDX-License-Identifier: MIT
#include "picture/image_exr_read.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/memory.h"
#include "picture/image_bytes.h"
#include "picture/image_header.h"

#include "kernels/vec.h"

/* Number that says that a file is OpenEXR. */
#define MAGIC 20000630u

/* Flags of tiles, deep data and several parts. */
#define OTHER_KINDS 0x1a00u

/* Bytes that one byte of zlib's can stand for, at most. */
#define RATIO_MAX 1032

enum { PACKED_NOT, PACKED_RLE, PACKED_ZIPS, PACKED_ZIP, PACKINGS };

static const char *const packings[] = {"none",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                       "PXR24", "B44", "B44A", "DWAA", "DWAB"};

enum pixel_type { PIXEL_UINT, PIXEL_HALF, PIXEL_FLOAT, PIXEL_TYPES };

struct channel {
    bool is_there;
    uint32_t type;   /* enum pixel_type */
    uint64_t before; /* bytes of a pixel in earlier channels */
};

struct exr_header {
    struct channel rgby[4];
    uint64_t pixel_bytes; /* of all channels */
    uint32_t packing;
    int64_t window[4]; /* least x and y, greatest x and y */
    bool has_channels, has_window;
    size_t table_at; /* offsets of the blocks */
};

static bool fail_broken(const struct image_file *f, const char *what,
                        struct error *err)
{
    return fail(err, "%s: found an OpenEXR file with %s", f->path, what);
}

bool image_exr_is(const struct image_file *f)
{
    return little32(bytes_of(f), 0) == MAGIC;
}

/* ---- header ---- */

/* Moves *at behind the text that begins there. Returns false if it has no
 * end. */
static bool skip_text(struct bytes b, size_t *at)
{
    const unsigned char *end =
        *at < b.size ? memchr(b.data + *at, 0, b.size - *at) : NULL;

    if (end == NULL)
        return false;
    *at = (size_t)(end - b.data) + 1;
    return true;
}

static bool is_text(struct bytes b, size_t at, const char *text)
{
    size_t length = strlen(text) + 1;

    return at < b.size && b.size - at >= length &&
           memcmp(b.data + at, text, length) == 0;
}

/* Reads the list of channels, which ends with an empty name. */
static bool read_channels(const struct image_file *f, struct exr_header *h,
                          size_t at, struct error *err)
{
    static const char *const names[4] = {"R", "G", "B", "Y"};
    struct bytes b = bytes_of(f);

    while (byte_at(b, at) != 0) {
        struct channel c = {true, 0, h->pixel_bytes};
        size_t name = at;

        if (!skip_text(b, &at) || b.size - at < 16)
            return fail_broken(f, "no end of its channels", err);
        c.type = little32(b, at);
        if (c.type >= PIXEL_TYPES || little32(b, at + 8) != 1 ||
            little32(b, at + 12) != 1)
            return fail_broken(f, "channels that glim does not read", err);
        for (int i = 0; i < 4; i++)
            if (is_text(b, name, names[i]))
                h->rgby[i] = c;
        h->pixel_bytes += c.type == PIXEL_HALF ? 2 : 4;
        at += 16;
    }
    h->has_channels = true;
    return true;
}

static bool read_attribute(const struct image_file *f, struct exr_header *h,
                           size_t name, size_t at, struct error *err)
{
    struct bytes b = bytes_of(f);

    if (is_text(b, name, "channels") && !h->has_channels)
        return read_channels(f, h, at, err);
    if (is_text(b, name, "compression"))
        h->packing = byte_at(b, at);
    if (is_text(b, name, "dataWindow")) {
        for (size_t i = 0; i < 4; i++)
            h->window[i] = (int32_t)little32(b, at + 4 * i);
        h->has_window = true;
    }
    return true;
}

static bool read_attributes(const struct image_file *f, struct exr_header *h,
                            struct error *err)
{
    struct bytes b = bytes_of(f);
    size_t at = 8;

    while (byte_at(b, at) != 0) {
        size_t name = at, size_bytes;

        if (!skip_text(b, &at) || !skip_text(b, &at) || b.size - at < 4)
            return fail_broken(f, "no end of its header", err);
        size_bytes = little32(b, at);
        at += 4;
        if (size_bytes > b.size - at)
            return fail_broken(f, "no end of its header", err);
        if (!read_attribute(f, h, name, at, err))
            return false;
        at += size_bytes;
    }
    h->table_at = at + 1;
    return at < b.size || fail_broken(f, "no end of its header", err);
}

static bool is_color(const struct exr_header *h)
{
    return h->rgby[0].is_there && h->rgby[1].is_there && h->rgby[2].is_there;
}

static bool read_header(const struct image_file *f, struct exr_header *h,
                        struct error *err)
{
    uint32_t version = little32(bytes_of(f), 4);

    *h = (struct exr_header){.packing = PACKED_NOT};
    if ((version & 0xff) != 2 || (version & OTHER_KINDS) != 0)
        return fail_broken(f,
                           "tiles, deep data or several parts, expected "
                           "one picture of lines",
                           err);
    if (!read_attributes(f, h, err))
        return false;
    if (!h->has_window || !h->has_channels)
        return fail_broken(f, "no window or no channels", err);
    if (!is_color(h) && !h->rgby[3].is_there)
        return fail_broken(f, "no channels R, G and B, or Y", err);
    if (h->packing >= PACKINGS)
        return fail(err,
                    "%s: found the compression %s, expected none, RLE, ZIPS or "
                    "ZIP",
                    f->path,
                    h->packing < sizeof packings / sizeof packings[0]
                        ? packings[h->packing]
                        : "of another version");
    return true;
}

/* ---- blocks ---- */

static int block_lines(const struct image_file *f, const struct exr_header *h)
{
    int most = h->packing == PACKED_ZIP ? 16 : 1;

    return f->height < most ? f->height : most;
}

static uint64_t line_bytes(const struct image_file *f,
                           const struct exr_header *h)
{
    return (uint64_t)f->width * h->pixel_bytes;
}

bool image_exr_header(struct image_file *f, struct error *err)
{
    struct exr_header h;
    int64_t width, height;

    if (!read_header(f, &h, err))
        return false;
    width = h.window[2] - h.window[0] + 1;
    height = h.window[3] - h.window[1] + 1;
    if (width < 1 || height < 1 || width > INT_MAX || height > INT_MAX)
        return fail_broken(f, "an impossible window", err);
    f->width = (int)width;
    f->height = (int)height;
    if (!image_expect_limits(f, err))
        return false;
    if (line_bytes(f, &h) * (uint64_t)f->height / RATIO_MAX > f->size_bytes)
        return fail(err, "%s: found %zu bytes, expected more for %dx%d",
                    f->path, f->size_bytes, f->width, f->height);
    f->decoder_bytes =
        2 * (size_t)line_bytes(f, &h) * (size_t)block_lines(f, &h);
    return true;
}

/* Decodes runs: n and a byte that is there n + 1 times, or -n and n bytes. */
static bool unpack_runs(const unsigned char *from, size_t size_bytes,
                        unsigned char *to, size_t expected)
{
    const unsigned char *end = from + size_bytes;
    size_t done = 0;

    while (end - from >= 2) {
        int run = *from < 128 ? *from : *from - 256;
        size_t count = (size_t)(run < 0 ? -run : run + 1);

        from++;
        if (count > expected - done ||
            (run < 0 && end - from < (ptrdiff_t)count))
            return false;
        if (run < 0)
            memcpy(to + done, from, count);
        else
            memset(to + done, *from, count);
        from += run < 0 ? count : 1;
        done += count;
    }
    return done == expected;
}

/* Undoes the order that image_exr.c describes. */
static void restore_bytes(unsigned char *sorted, size_t count,
                          unsigned char *to)
{
    size_t half = (count + 1) / 2;

    for (size_t i = 1; i < count; i++)
        sorted[i] = (unsigned char)(sorted[i - 1] + sorted[i] - 128);
    for (size_t i = 0; i < count; i++)
        to[i] = sorted[i / 2 + (i % 2) * half];
}

/* Decoded lines, and a buffer for their packed order. */
struct block {
    unsigned char *lines, *sorted;
};

static bool unpack(const struct exr_header *h, const unsigned char *from,
                   size_t size_bytes, struct block *b, size_t expected)
{
    uLongf found = expected;

    if (size_bytes == expected) { /* packing would have made it longer */
        memcpy(b->lines, from, expected);
        return true;
    }
    if (h->packing == PACKED_NOT)
        return false;
    if (h->packing == PACKED_RLE
            ? !unpack_runs(from, size_bytes, b->sorted, expected)
            : uncompress(b->sorted, &found, from, size_bytes) != Z_OK ||
                  found != expected)
        return false;
    restore_bytes(b->sorted, expected, b->lines);
    return true;
}

static float half_value(uint32_t bits)
{
    uint32_t exponent = bits >> 10 & 31, mantissa = bits & 1023;
    float size = exponent == 0 ? ldexpf((float)mantissa, -24)
                 : exponent == 31
                     ? (mantissa != 0 ? NAN : INFINITY)
                     : ldexpf((float)(1024 + mantissa), (int)exponent - 25);

    return (bits >> 15) != 0 ? -size : size;
}

static float value_at(struct bytes line, const struct channel *c,
                      uint64_t width, uint64_t x)
{
    size_t at = (size_t)(c->before * width);

    if (c->type == PIXEL_HALF)
        return half_value(little16(line, at + 2 * (size_t)x));
    if (c->type == PIXEL_UINT)
        return (float)little32(line, at + 4 * (size_t)x);
    return bits_float(little32(line, at + 4 * (size_t)x));
}

static void put_lines(const struct image_file *f, const struct exr_header *h,
                      const struct block *b, int count, float *to)
{
    uint64_t width = (uint64_t)f->width, bytes = line_bytes(f, h);

    for (int y = 0; y < count; y++) {
        struct bytes line = {b->lines + (size_t)y * bytes, (size_t)bytes};

        for (uint64_t x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                *to++ = value_at(line, &h->rgby[is_color(h) ? c : 3], width, x);
    }
}

/* Reads the block of this number in the table. Its lines may be anywhere. */
static bool read_block(const struct image_file *f, const struct exr_header *h,
                       size_t number, struct block *block, float *rgb,
                       struct error *err)
{
    struct bytes b = bytes_of(f);
    size_t entry = h->table_at + 8 * number;
    uint64_t at = little32(b, entry) | (uint64_t)little32(b, entry + 4) << 32;
    int lines = block_lines(f, h), count;
    int64_t y;
    size_t size_bytes, expected;

    if (at > b.size || b.size - at < 8)
        return fail_broken(f, "no end of its lines", err);
    y = (int32_t)little32(b, (size_t)at) - h->window[1];
    size_bytes = little32(b, (size_t)at + 4);
    if (y < 0 || y >= f->height || y % lines != 0 ||
        size_bytes > b.size - at - 8)
        return fail_broken(f, "no end of its lines", err);
    count = f->height - (int)y < lines ? f->height - (int)y : lines;
    expected = (size_t)line_bytes(f, h) * (size_t)count;
    if (!unpack(h, b.data + at + 8, size_bytes, block, expected))
        return fail_broken(f, "broken lines", err);
    put_lines(f, h, block, count, rgb + 3 * (size_t)y * (size_t)f->width);
    return true;
}

float *image_exr_decode(const struct image_file *f, struct error *err)
{
    struct exr_header h;
    struct block b = {NULL, NULL};
    float *rgb = NULL;
    bool ok = read_header(f, &h, err);
    size_t lines = ok ? (size_t)block_lines(f, &h) : 1;

    if (ok) {
        b.lines = alloc_array(lines, (size_t)line_bytes(f, &h));
        b.sorted = alloc_array(lines, (size_t)line_bytes(f, &h));
        rgb =
            alloc_array((size_t)f->width * (size_t)f->height, 3 * sizeof *rgb);
        ok = (b.lines != NULL && b.sorted != NULL && rgb != NULL) ||
             fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
                  f->height);
    }
    for (size_t i = 0; ok && i * lines < (size_t)f->height; i++)
        ok = read_block(f, &h, i, &b, rgb, err);
    free(b.lines);
    free(b.sorted);
    if (ok)
        return rgb;
    free(rgb);
    return NULL;
}
