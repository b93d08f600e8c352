// SPDX-License-Identifier: MIT
/*
 * Debian's libstb would do as well, but its limits are fixed, it decodes the
 * formats that we leave out, and its memory is not zeroed: a truncated file
 * would show what the memory held before.
 */
#include "picture/stb.h"

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

#include "picture/image_read.h"

/* What the decoders may still take. */
static _Thread_local size_t left_bytes;
static _Thread_local bool is_out_of_memory;

/* Counts what p, which may be NULL, has taken. */
static void *count(void *p)
{
    size_t size_bytes = malloc_usable_size(p);

    is_out_of_memory |= p == NULL;
    left_bytes -= size_bytes < left_bytes ? size_bytes : left_bytes;
    return p;
}

static void *limited_alloc(size_t size_bytes)
{
    return count(size_bytes <= left_bytes ? calloc(1, size_bytes) : NULL);
}

static void limited_free(void *p)
{
    left_bytes += malloc_usable_size(p);
    free(p);
}

static void *limited_realloc(void *p, size_t size_bytes)
{
    size_t old_bytes = malloc_usable_size(p);
    void *grown =
        size_bytes <= left_bytes + old_bytes ? realloc(p, size_bytes) : NULL;

    if (grown)
        left_bytes += old_bytes;
    return count(grown);
}

/* Reading past the end gives 0, as in stb. */
static unsigned byte_at(const unsigned char *data, size_t size_bytes, size_t i)
{
    return i < size_bytes ? data[i] : 0;
}

/* The segment of Huffman tables whose length field is at i. */
static bool are_tables_safe(const unsigned char *data, size_t size_bytes,
                            size_t i)
{
    int left = (int)(byte_at(data, size_bytes, i) << 8 |
                     byte_at(data, size_bytes, i + 1)) -
               2;

    for (i += 2; left > 0; left -= 17) {
        int codes = 0;
        for (size_t k = 1; k <= 16; k++)
            codes += (int)byte_at(data, size_bytes, i + k);
        if (codes > 256)
            return false;
        left -= codes;
        i += 17 + (size_t)codes;
    }
    return true;
}

/* Up to the first scan the file is read marker by marker, as stb does: text and
 * thumbnails are skipped. From there on every ff c4 is taken for tables: packed
 * pixels have none. */
bool stb_is_safe(const unsigned char *data, size_t size_bytes)
{
    enum { TABLES = 0xc4, START = 0xd8, SCAN = 0xda, PREFIX = 0xff };
    bool is_in_header = true;

    for (size_t i = 0; i + 1 < size_bytes;) {
        if (i == 0 && data[0] != PREFIX)
            return true; /* no JPEG */
        if (data[i] != PREFIX || data[i + 1] == PREFIX) {
            i++;
            continue;
        }
        unsigned marker = data[i + 1];
        i += 2;
        if (marker == TABLES && !are_tables_safe(data, size_bytes, i))
            return false;
        is_in_header = is_in_header && marker != SCAN;
        if (is_in_header && marker != START)
            i += byte_at(data, size_bytes, i) << 8 |
                 byte_at(data, size_bytes, i + 1);
    }
    return true;
}

/* stb copies nothing from or to NULL where a chunk is empty; memcpy() must not
 * be asked to. */
static void *copy_bytes(void *to, const void *from, size_t size_bytes)
{
    return size_bytes > 0 ? memcpy(to, from, size_bytes) : to;
}

#define memcpy                copy_bytes
#define STBI_MALLOC(size)     limited_alloc(size)
#define STBI_REALLOC(p, size) limited_realloc(p, size)
#define STBI_FREE(p)          limited_free(p)
#define STBI_MAX_DIMENSIONS   IMAGE_SIDE_MAX
#define STBI_FAILURE_USERMSG
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION

/* NULL + 0, for the same empty chunks: clang's sanitizer minds it */
#if defined(__clang__)
#pragma clang attribute push(__attribute__((no_sanitize("pointer-overflow"))), \
                             apply_to = function)
#endif
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#if defined(__clang__)
#pragma clang attribute pop
#endif

void stb_limit(size_t size_bytes)
{
    left_bytes = size_bytes;
    is_out_of_memory = false;
    stbi__g_failure_reason = NULL;
}

const char *stb_failure(void)
{
    return is_out_of_memory ? NULL : stbi__g_failure_reason;
}
