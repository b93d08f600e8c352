// SPDX-License-Identifier: MIT
/*
 * Debian's libstb would do as well, but its limits are fixed, it decodes the
 * formats that we leave out, and its memory is not zeroed: a truncated file
 * would show what the memory held before.
 */
#include "glim/stb.h"

#include <stdlib.h>
#include <string.h>

#include "glim/image.h"

static _Thread_local size_t limit_bytes;

void stb_limit(size_t size_bytes)
{
    limit_bytes = size_bytes;
}

static void *limited_alloc(size_t size_bytes)
{
    return size_bytes <= limit_bytes ? calloc(1, size_bytes) : NULL;
}

static void *limited_realloc(void *p, size_t size_bytes)
{
    return size_bytes <= limit_bytes ? realloc(p, size_bytes) : NULL;
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
#define STBI_FREE(p)          free(p)
#define STBI_MAX_DIMENSIONS   IMAGE_SIDE_MAX
#define STBI_FAILURE_USERMSG
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_ONLY_PNM
#define STBI_ONLY_HDR
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
