// SPDX-License-Identifier: MIT
/*
 * Debian's libstb would do as well, but its limits are fixed, it decodes the
 * formats that we leave out, and its memory is not zeroed: a truncated file
 * would show what the memory held before.
 */
#include "glim/stb.h"

#include <stdlib.h>

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
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
