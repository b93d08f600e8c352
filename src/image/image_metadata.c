// SPDX-License-Identifier: MIT
#include "image/image_metadata.h"

#include <assert.h>
#include <stdarg.h>
#include <stdbool.h>
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
