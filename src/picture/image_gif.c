// SPDX-License-Identifier: MIT
#include "picture/image_gif.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "picture/image_header.h"

/* Codes of LZW have up to 12 bits. */
#define CODE_BITS 12
#define CODES     (1 << CODE_BITS)

/* Most pixels of one byte: a code of 12 bits stands for up to CODES pixels. */
#define RATIO (CODES * 8 / CODE_BITS)

enum { EXTENSION = 0x21, PICTURE = 0x2c, GRAPHIC_CONTROL = 0xf9 };

/* Flags of the screen and of a picture. */
enum { HAS_PALETTE = 0x80, IS_INTERLACED = 0x40, PALETTE_BITS = 7 };

#define NO_COLOR 256

/* The file, and the position in it. Bytes behind the end are 0. */
struct reader {
    const unsigned char *data;
    size_t size, at;
};

static uint32_t next_byte(struct reader *r)
{
    return r->at < r->size ? r->data[r->at++] : 0;
}

static uint32_t next_16(struct reader *r)
{
    uint32_t low = next_byte(r);

    return low | next_byte(r) << 8;
}

static struct reader reader_of(const struct image_file *f, size_t at)
{
    return (struct reader){(const unsigned char *)f->data, f->size_bytes, at};
}

bool image_gif_is(const struct image_file *f)
{
    return f->size_bytes >= 6 && (memcmp(f->data, "GIF87a", 6) == 0 ||
                                  memcmp(f->data, "GIF89a", 6) == 0);
}

bool image_gif_header(struct image_file *f, struct error *err)
{
    struct reader r = reader_of(f, 6);

    f->width = (int)next_16(&r);
    f->height = (int)next_16(&r);
    if (!image_expect_limits(f, err))
        return false;
    return (uint64_t)f->width * (uint64_t)f->height / RATIO <= f->size_bytes ||
           fail(err, "%s: found %zu bytes, expected more for %dx%d pixels",
                f->path, f->size_bytes, f->width, f->height);
}

/* The first picture of the file. */
struct picture {
    uint32_t left, top, width, height;
    bool is_interlaced;
    uint32_t transparent; /* colour, or NO_COLOR */
    uint8_t palette[256][3];
};

static void read_palette(struct reader *r, uint32_t flags, struct picture *p)
{
    int count = (flags & HAS_PALETTE) != 0 ? 2 << (flags & PALETTE_BITS) : 0;

    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            p->palette[i][k] = (uint8_t)next_byte(r);
}

static void skip_blocks(struct reader *r)
{
    uint32_t length;

    while ((length = next_byte(r)) != 0)
        r->at += length;
}

/* Reads everything before the codes. Returns false if there is no picture. */
static bool read_picture(struct reader *r, struct picture *p)
{
    uint32_t flags, kind;

    *p = (struct picture){.transparent = NO_COLOR};
    r->at = 10;
    flags = next_byte(r);
    r->at = 13;
    read_palette(r, flags, p);
    while ((kind = next_byte(r)) == EXTENSION) {
        bool is_control = next_byte(r) == GRAPHIC_CONTROL;
        struct reader control = *r;

        skip_blocks(r);
        if (!is_control || next_byte(&control) != 4)
            continue;
        flags = next_byte(&control);
        control.at += 2; /* delay */
        p->transparent = (flags & 1) != 0 ? next_byte(&control) : NO_COLOR;
    }
    p->left = next_16(r);
    p->top = next_16(r);
    p->width = next_16(r);
    p->height = next_16(r);
    flags = next_byte(r);
    p->is_interlaced = (flags & IS_INTERLACED) != 0;
    read_palette(r, flags, p);
    return kind == PICTURE && r->at < r->size;
}

/* Reads codes from the sub-blocks of the file. */
struct codes {
    struct reader *reader;
    uint32_t left; /* bytes of the sub-block */
    uint32_t bits; /* that were read and not used, the first at the bottom */
    int bit_count;
};

/* Returns the next code, or CODES at the end of the data. */
static uint32_t next_code(struct codes *c, int size)
{
    uint32_t code;

    while (c->bit_count < size) {
        if (c->left == 0)
            c->left = next_byte(c->reader);
        if (c->left == 0 || c->reader->at >= c->reader->size)
            return CODES;
        c->bits |= next_byte(c->reader) << c->bit_count;
        c->bit_count += 8;
        c->left--;
    }
    code = c->bits & ((1u << size) - 1);
    c->bits >>= size;
    c->bit_count -= size;
    return code;
}

/* Returns the row of a picture that comes as number y in the file: with
 * interlacing every eighth row, then those between in three more passes. */
static uint32_t row_of(const struct picture *p, uint32_t y)
{
    static const uint32_t first[] = {0, 4, 2, 1}, step[] = {8, 8, 4, 2};

    for (int pass = 0; p->is_interlaced && pass < 4; pass++) {
        uint32_t rows = p->height > first[pass]
                            ? (p->height - first[pass] - 1) / step[pass] + 1
                            : 0;

        if (y < rows)
            return first[pass] + y * step[pass];
        y -= rows;
    }
    return y;
}

/* A picture on its way to the screen. */
struct target {
    const struct image_file *file;
    const struct picture *picture;
    uint8_t *rgba;
    uint64_t done, pixels;
};

static void put(struct target *t, uint32_t color)
{
    const struct picture *p = t->picture;
    uint32_t x, y;
    uint8_t *to;

    if (t->done == t->pixels)
        return;
    x = p->left + (uint32_t)(t->done % p->width);
    y = p->top + row_of(p, (uint32_t)(t->done / p->width));
    t->done++;
    if (color == p->transparent || x >= (uint32_t)t->file->width ||
        y >= (uint32_t)t->file->height)
        return;
    to = t->rgba + 4 * ((size_t)y * (size_t)t->file->width + x);
    memcpy(to, p->palette[color], 3);
    to[3] = 255;
}

/* The strings of LZW: each is an earlier one and one more colour. */
struct strings {
    uint16_t before[CODES];
    uint8_t last[CODES];
};

/* Puts the string of a code. Returns its first colour. */
static uint8_t put_string(struct target *t, const struct strings *s,
                          uint32_t code, uint32_t clear)
{
    uint8_t stack[CODES];
    int depth = 0;

    for (; code > clear; code = s->before[code])
        stack[depth++] = s->last[code];
    stack[depth++] = (uint8_t)code;
    for (int i = depth; i-- > 0;)
        put(t, stack[i]);
    return stack[depth - 1];
}

/* Puts all pixels. Returns false for a code that cannot be there. A string may
 * end with the first colour of itself, if its code is the one that is being
 * made. */
static bool put_picture(struct target *t, struct codes *c, int least_bits)
{
    struct strings s;
    uint32_t clear = 1u << least_bits, next = clear + 2, old = CODES;
    int size = least_bits + 1;
    uint32_t code;

    while (t->done < t->pixels) {
        uint8_t first;

        code = next_code(c, size);
        if (code == CODES || code == clear + 1)
            return false;
        if (code == clear) {
            next = clear + 2;
            size = least_bits + 1;
            old = CODES;
            continue;
        }
        if (code > next || (code == next && (old == CODES || next == CODES)))
            return false;
        first = put_string(t, &s, code == next ? old : code, clear);
        if (code == next)
            put(t, first);
        if (old != CODES && next < CODES) {
            s.before[next] = (uint16_t)old;
            s.last[next++] = first;
            size += next == 1u << size && size < CODE_BITS;
        }
        old = code;
    }
    return true;
}

uint8_t *image_gif_decode(const struct image_file *f, struct error *err)
{
    struct reader r = reader_of(f, 0);
    struct picture p;
    struct codes c = {.reader = &r};
    struct target t = {.file = f, .picture = &p};
    uint32_t least_bits;
    bool ok = read_picture(&r, &p);

    t.pixels = (uint64_t)p.width * p.height;
    least_bits = next_byte(&r);
    ok = ok && t.pixels > 0 && least_bits >= 1 && least_bits <= 8;
    t.rgba = alloc_array((size_t)f->width * (size_t)f->height, 4);
    if (t.rgba == NULL) {
        fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
             f->height);
        return NULL;
    }
    if (ok && put_picture(&t, &c, (int)least_bits))
        return t.rgba;
    free(t.rgba);
    fail(err, "%s: found a broken GIF image", f->path);
    return NULL;
}
