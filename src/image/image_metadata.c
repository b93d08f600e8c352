// SPDX-License-Identifier: MIT
#include "image/image_metadata.h"

#include <assert.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/print.h"

/* Copies the longest beginning of the text that fits, with a '?' for what is
 * not shown. */
static void copy_shown(char to[IMAGE_VALUE_BYTES], const char *text)
{
    size_t at = 0;

    while (*text != '\0') {
        size_t length = utf8_length(text);
        bool is_shown = length > 0 && print_shows(utf8_code(text, length));
        size_t more = is_shown ? length : 1;

        if (at + more >= IMAGE_VALUE_BYTES)
            break;
        memcpy(to + at, is_shown ? text : "?", more);
        at += more;
        text += length > 0 ? length : 1;
    }
    to[at] = '\0';
}

void image_metadata_add(struct image_metadata *m, const char *key,
                        const char *format, ...)
{
    char text[2 * IMAGE_VALUE_BYTES];
    struct image_text *added = &m->texts[m->count++];
    va_list values;

    assert(m->count <= IMAGE_METADATA_MAX && strlen(key) < IMAGE_KEY_BYTES);
    snprintf(added->key, sizeof added->key, "%s", key);
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    copy_shown(added->value, text);
}

/* Returns the CRC of PNG, ISO 3309. The texts are short, so there is no
 * table. */
static uint32_t crc_of(const unsigned char *bytes, size_t size_bytes)
{
    uint32_t crc = 0xffffffff;

    for (size_t i = 0; i < size_bytes; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

static void put_be32(unsigned char *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(value >> (24 - 8 * i));
}

static bool is_ascii(const char *text)
{
    for (; *text != '\0'; text++) {
        if ((unsigned char)*text >= 0x80)
            return false;
    }
    return true;
}

/* Appends bytes and returns their end. */
static unsigned char *put(unsigned char *to, const void *bytes, size_t count)
{
    memcpy(to, bytes, count);
    return to + count;
}

/* Writes length, type, data and CRC of a chunk. */
static unsigned char *put_chunk(unsigned char *chunk,
                                const struct image_text *t)
{
    /* iTXt: not compressed, no language, no translated key */
    static const unsigned char plain[4] = {0};
    bool is_latin = is_ascii(t->value);
    unsigned char *end = put(chunk + 4, is_latin ? "tEXt" : "iTXt", 4);

    end = put(end, t->key, strlen(t->key) + 1);
    if (!is_latin)
        end = put(end, plain, sizeof plain);
    end = put(end, t->value, strlen(t->value));
    put_be32(chunk, (uint32_t)(end - chunk) - 8);
    put_be32(end, crc_of(chunk + 4, (size_t)(end - chunk) - 4));
    return end + 4;
}

size_t image_metadata_png(const struct image_metadata *m,
                          unsigned char to[IMAGE_METADATA_BYTES])
{
    unsigned char *end = to;

    for (int i = 0; i < m->count; i++)
        end = put_chunk(end, &m->texts[i]);
    return (size_t)(end - to);
}

size_t image_metadata_hdr(const struct image_metadata *m,
                          unsigned char to[IMAGE_METADATA_BYTES])
{
    size_t size_bytes = 0;

    for (int i = 0; i < m->count; i++)
        size_bytes +=
            (size_t)snprintf((char *)to + size_bytes,
                             IMAGE_METADATA_BYTES - size_bytes, "# %s=%s\n",
                             m->texts[i].key, m->texts[i].value);
    return size_bytes;
}

/* ---- texts of files ---- */

/* Bytes of a file from `p` on, none of which is known to be right. */
struct rest {
    const unsigned char *p;
    size_t count;
};

static void skip(struct rest *r, size_t count)
{
    r->p += count;
    r->count -= count;
}

/* Takes the bytes up to a zero, which is skipped. Returns NULL if there is
 * none. */
static const char *take_name(struct rest *r)
{
    const char *name = (const char *)r->p;
    const void *end = r->count > 0 ? memchr(r->p, '\0', r->count) : NULL;

    if (end == NULL)
        return NULL;
    skip(r, (size_t)((const unsigned char *)end - r->p) + 1);
    return name;
}

/* Keeps a text that fits. Bytes of the value that no text of glim has become
 * question marks. */
static void keep(struct image_metadata *m, const char *key, struct rest value)
{
    char text[IMAGE_VALUE_BYTES];

    if (m->count == IMAGE_METADATA_MAX || strlen(key) >= IMAGE_KEY_BYTES ||
        value.count >= sizeof text)
        return;
    memcpy(text, value.p, value.count);
    text[value.count] = '\0';
    image_metadata_add(m, key, "%s", text);
}

static uint32_t be32(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 |
           p[3];
}

static void find_png(struct image_metadata *m, struct rest r)
{
    while (r.count >= 12 && be32(r.p) <= r.count - 12) {
        struct rest chunk = {r.p + 8, be32(r.p)};
        bool is_utf8 = memcmp(r.p + 4, "iTXt", 4) == 0;
        bool is_text = is_utf8 || memcmp(r.p + 4, "tEXt", 4) == 0;
        const char *key = is_text ? take_name(&chunk) : NULL;

        skip(&r, chunk.count + (size_t)(chunk.p - r.p) + 4);
        if (is_utf8 && chunk.count >= 4)
            skip(&chunk, 4); /* as put_chunk() has them */
        if (key != NULL)
            keep(m, key, chunk);
    }
}

static void find_hdr(struct image_metadata *m, struct rest r)
{
    const unsigned char *end;

    while (r.count > 1 && r.p[0] == '#' &&
           (end = memchr(r.p, '\n', r.count)) != NULL) {
        struct rest line = {r.p + 2, (size_t)(end - r.p)};
        const unsigned char *equals = memchr(r.p, '=', line.count);
        char key[IMAGE_KEY_BYTES] = "";

        if (equals != NULL && equals > line.p &&
            (size_t)(equals - line.p) < sizeof key) {
            memcpy(key, line.p, (size_t)(equals - line.p));
            line = (struct rest){equals + 1, (size_t)(end - equals) - 1};
            keep(m, key, line);
        }
        skip(&r, (size_t)(end - r.p) + 1);
    }
}

static void find_exr(struct image_metadata *m, struct rest r)
{
    const char *key, *type;

    while ((key = take_name(&r)) != NULL && key[0] != '\0' &&
           (type = take_name(&r)) != NULL && r.count >= 4) {
        size_t size = (size_t)r.p[0] | (size_t)r.p[1] << 8 |
                      (size_t)r.p[2] << 16 | (size_t)r.p[3] << 24;

        skip(&r, 4);
        if (size > r.count)
            return;
        if (strcmp(type, "string") == 0)
            keep(m, key, (struct rest){r.p, size});
        skip(&r, size);
    }
}

void image_metadata_find(struct image_metadata *m, const void *bytes,
                         size_t size_bytes)
{
    static const struct {
        const char *begin;
        size_t begin_bytes, skipped;
        void (*find)(struct image_metadata *m, struct rest r);
    } formats[] = {
        {"\x89PNG\r\n\x1a\n", 8, 8, find_png},
        {"#?RADIANCE\n", 11, 11, find_hdr},
        {"\x76\x2f\x31\x01", 4, 8, find_exr}, /* and the version */
    };

    m->count = 0;
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++)
        if (size_bytes >= formats[i].skipped &&
            memcmp(bytes, formats[i].begin, formats[i].begin_bytes) == 0)
            formats[i].find(m, (struct rest){(const unsigned char *)bytes +
                                                 formats[i].skipped,
                                             size_bytes - formats[i].skipped});
}

const char *image_metadata_value(const struct image_metadata *m,
                                 const char *key)
{
    for (int i = 0; i < m->count; i++)
        if (strcmp(m->texts[i].key, key) == 0)
            return m->texts[i].value;
    return NULL;
}
