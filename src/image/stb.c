// SPDX-License-Identifier: MIT
/*
 * stb_image and stb_image_write are compiled here instead of linked from
 * Debian's libstb, whose limits are fixed, which decodes the formats that we
 * leave out, and which does not zero memory: a truncated file would show
 * earlier contents of the memory.
 */
#include "image/stb.h"

#include <malloc.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "image/image_read.h"

/* Memory that the decoders may still allocate. */
static _Thread_local size_t left_bytes;
static _Thread_local bool is_out_of_memory;

/* Subtracts the size of block p from the limit. NULL means that an allocation
 * has failed. */
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

/* Returns byte i; bytes behind the end are 0, as in stb_image. */
static unsigned byte_at(const unsigned char *data, size_t size_bytes, size_t i)
{
    return i < size_bytes ? data[i] : 0;
}

/* Checks the segment of Huffman tables whose length field is at i. */
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

/* Follows the markers up to the first scan as stb_image does, which skips text
 * and thumbnails. From there on every ff c4 is taken for tables, since
 * entropy-coded data contains none. */
bool stb_is_safe(const unsigned char *data, size_t size_bytes)
{
    enum { TABLES = 0xc4, START = 0xd8, SCAN = 0xda, PREFIX = 0xff };
    bool is_in_header = true;

    for (size_t i = 0; i + 1 < size_bytes;) {
        if (i == 0 && data[0] != PREFIX)
            return true; /* not a JPEG file */
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

/* Allocated block of an encoder. The encoders do not check their allocations:
 * one that fails leaves the encoder by longjmp(), and then all blocks in this
 * list are freed. */
struct block {
    _Alignas(max_align_t) struct block *prev;
    struct block *next;
};

static _Thread_local struct block blocks; /* head of the list, not an allocated
                                             block */
static _Thread_local jmp_buf *failed;     /* NULL while no encoder runs */

static void list_block(struct block *b)
{
    b->prev = &blocks;
    b->next = blocks.next;
    if (b->next)
        b->next->prev = b;
    blocks.next = b;
}

static void unlist_block(struct block *b)
{
    b->prev->next = b->next;
    if (b->next)
        b->next->prev = b->prev;
}

static void encoder_free(void *p)
{
    struct block *b = p ? (struct block *)p - 1 : NULL;

    if (b)
        unlist_block(b);
    free(b);
}

static void *encoder_realloc(void *p, size_t size_bytes)
{
    struct block *old = p ? (struct block *)p - 1 : NULL;
    struct block *b;

    if (old)
        unlist_block(old);
    b = realloc(old, sizeof *b + size_bytes);
    if (b) {
        list_block(b);
        return b + 1;
    }
    if (old)
        list_block(old);
    if (failed)
        longjmp(*failed, 1);
    return NULL;
}

static void *encoder_alloc(size_t size_bytes)
{
    return encoder_realloc(NULL, size_bytes);
}

/* Replaces memcpy(), which must not get NULL even for 0 bytes. stb_image_write
 * passes NULL for empty chunks. */
static void *copy_bytes(void *to, const void *from, size_t size_bytes)
{
    return size_bytes > 0 ? memcpy(to, from, size_bytes) : to;
}

#define memcpy                 copy_bytes
#define STBI_MALLOC(size)      limited_alloc(size)
#define STBI_REALLOC(p, size)  limited_realloc(p, size)
#define STBI_FREE(p)           limited_free(p)
#define STBIW_MALLOC(size)     encoder_alloc(size)
#define STBIW_REALLOC(p, size) encoder_realloc(p, size)
#define STBIW_FREE(p)          encoder_free(p)
#define STBI_MAX_DIMENSIONS    IMAGE_SIDE_MAX
#define STBI_FAILURE_USERMSG
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_ONLY_GIF
#define STBI_ONLY_PNM
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION

/* stb_image_write computes NULL + 0 for empty chunks, and stb_image shifts bits
 * of broken JPEG files by more than their type has, which only makes other
 * pixels. Clang's sanitizer reports both. */
#if defined(__clang__)
#pragma clang attribute push(__attribute__((no_sanitize("pointer-overflow",  \
                                                        "shift-exponent"))), \
                             apply_to = function)
#endif
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#if defined(__clang__)
#pragma clang attribute pop
#endif

/* Calls the encoder of the picture's format. */
static bool encode(const struct stb_picture *picture, stbi_write_func *write,
                   void *context)
{
    const struct stb_picture *p = picture;

    return p->bytes
               ? stbi_write_png_to_func(write, context, p->width, p->height, 3,
                                        p->bytes, 3 * p->width) != 0
               : stbi_write_hdr_to_func(write, context, p->width, p->height, 3,
                                        p->floats) != 0;
}

/* Encodes as encode() does, but returns false if an allocation has failed. */
static bool try_encode(const struct stb_picture *picture,
                       stbi_write_func *write, void *context)
{
    jmp_buf here;

    failed = &here;
    return setjmp(here) == 0 && encode(picture, write, context);
}

bool stb_encode(const struct stb_picture *picture, stbi_write_func *write,
                void *context)
{
    bool ok = try_encode(picture, write, context);
    struct block *next;

    failed = NULL;
    for (struct block *b = blocks.next; b != NULL; b = next) {
        next = b->next;
        free(b);
    }
    blocks.next = NULL;
    return ok;
}

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
