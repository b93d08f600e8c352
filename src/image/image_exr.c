// SPDX-License-Identifier: MIT
#include "image/image_exr.h"

#include <assert.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/memory.h"

#include "kernels/vec.h"

/* Numbers of the file format. */
enum { VERSION = 2, COMPRESSION_ZIP = 3, PIXEL_FLOAT = 2, BLOCK_LINES = 16 };

/* Level of zlib. Noise of floats hardly shrinks at higher levels, which take
 * longer; OpenEXR has the same default. */
#define ZIP_LEVEL 4

struct channel {
    char name[32];
    const float *values; /* the first one; the next is 3 further */
};

/* File in memory that grows while it is written. */
struct exr_file {
    uint8_t *bytes;
    size_t size_bytes, capacity;
    bool is_cut; /* incomplete because memory was out */
    struct channel channels[EXR_CHANNELS_MAX];
    int channel_count, width, height;
};

static void put(struct exr_file *f, const void *bytes, size_t count)
{
    void *grown = f->bytes;

    if (f->is_cut ||
        !grow_array(&grown, &f->capacity, f->size_bytes + count, 1)) {
        f->is_cut = true;
        return;
    }
    f->bytes = grown;
    memcpy(f->bytes + f->size_bytes, bytes, count);
    f->size_bytes += count;
}

static void store32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> 8 * i);
}

static void put32(struct exr_file *f, uint32_t value)
{
    uint8_t bytes[4];

    store32(bytes, value);
    put(f, bytes, sizeof bytes);
}

static void put_text(struct exr_file *f, const char *text)
{
    put(f, text, strlen(text) + 1);
}

/* ---- header ---- */

static void put_attribute(struct exr_file *f, const char *name,
                          const char *type, size_t size_bytes)
{
    put_text(f, name);
    put_text(f, type);
    put32(f, (uint32_t)size_bytes);
}

static void put_byte(struct exr_file *f, const char *name, const char *type,
                     uint8_t value)
{
    put_attribute(f, name, type, 1);
    put(f, &value, 1);
}

/* Writes an attribute of numbers of 4 bytes each. */
static void put_numbers(struct exr_file *f, const char *name, const char *type,
                        const uint32_t *numbers, size_t count)
{
    put_attribute(f, name, type, 4 * count);
    for (size_t i = 0; i < count; i++)
        put32(f, numbers[i]);
}

static void put_channels(struct exr_file *f)
{
    size_t size_bytes = 1;

    for (int i = 0; i < f->channel_count; i++)
        size_bytes += strlen(f->channels[i].name) + 1 + 16;
    put_attribute(f, "channels", "chlist", size_bytes);
    for (int i = 0; i < f->channel_count; i++) {
        put_text(f, f->channels[i].name);
        put32(f, PIXEL_FLOAT);
        put32(f, 0); /* a hint for lossy compression, and padding */
        put32(f, 1); /* every pixel has a value */
        put32(f, 1);
    }
    put(f, "", 1);
}

static void put_header(struct exr_file *f, const struct image_metadata *m)
{
    const uint32_t window[4] = {0, 0, (uint32_t)f->width - 1,
                                (uint32_t)f->height - 1};
    const uint32_t center[2] = {0, 0}, one = float_bits(1.0f);

    put32(f, 20000630); /* says that the file is OpenEXR */
    put32(f, VERSION);
    put_channels(f);
    put_byte(f, "compression", "compression", COMPRESSION_ZIP);
    put_numbers(f, "dataWindow", "box2i", window, 4);
    put_numbers(f, "displayWindow", "box2i", window, 4);
    put_byte(f, "lineOrder", "lineOrder", 0); /* from the top */
    put_numbers(f, "pixelAspectRatio", "float", &one, 1);
    put_numbers(f, "screenWindowCenter", "v2f", center, 2);
    put_numbers(f, "screenWindowWidth", "float", &one, 1);
    for (int i = 0; m != NULL && i < m->count; i++) {
        const char *value = m->texts[i].value;

        put_attribute(f, m->texts[i].key, "string", strlen(value));
        put(f, value, strlen(value));
    }
    put(f, "", 1);
}

/* ---- pixels ---- */

/* Buffers for a block of lines. */
struct block {
    uint8_t *lines, *sorted, *packed;
    size_t packed_most;
};

static void free_block(struct block *b)
{
    free(b->lines);
    free(b->sorted);
    free(b->packed);
}

static bool init_block(struct block *b, size_t size_bytes)
{
    b->packed_most = compressBound(size_bytes);
    b->lines = alloc_array(size_bytes, 1);
    b->sorted = alloc_array(size_bytes, 1);
    b->packed = alloc_array(b->packed_most, 1);
    return b->lines != NULL && b->sorted != NULL && b->packed != NULL;
}

/* Copies a line, one channel after the other. Returns the end. */
static uint8_t *copy_line(const struct exr_file *f, int y, uint8_t *to)
{
    for (int c = 0; c < f->channel_count; c++) {
        const float *from =
            f->channels[c].values + 3 * (size_t)y * (size_t)f->width;

        for (int x = 0; x < f->width; x++, from += 3, to += 4)
            store32(to, float_bits(*from));
    }
    return to;
}

/* Writes bytes at even places before those at odd ones, each as the difference
 * from the one before, which zlib makes shorter. */
static void sort_bytes(const uint8_t *from, size_t count, uint8_t *to)
{
    size_t half = (count + 1) / 2;
    uint8_t last;

    for (size_t i = 0; i < count; i++)
        to[i / 2 + (i % 2) * half] = from[i];
    last = to[0];
    for (size_t i = 1; i < count; i++) {
        uint8_t byte = to[i];

        to[i] = (uint8_t)(byte - last + 128);
        last = byte;
    }
}

/* Writes the block that begins with line y: packed if that makes it smaller. */
static void put_block(struct exr_file *f, int y, struct block *b)
{
    int end = y + BLOCK_LINES < f->height ? y + BLOCK_LINES : f->height;
    uint8_t *to = b->lines;
    size_t size_bytes;
    uLongf packed = b->packed_most;
    bool is_smaller;

    for (int line = y; line < end; line++)
        to = copy_line(f, line, to);
    size_bytes = (size_t)(to - b->lines);
    sort_bytes(b->lines, size_bytes, b->sorted);
    is_smaller = compress2(b->packed, &packed, b->sorted, size_bytes,
                           ZIP_LEVEL) == Z_OK &&
                 packed < size_bytes;
    put32(f, (uint32_t)y);
    put32(f, (uint32_t)(is_smaller ? packed : size_bytes));
    put(f, is_smaller ? b->packed : b->lines, is_smaller ? packed : size_bytes);
}

static void put_blocks(struct exr_file *f)
{
    size_t lines = (size_t)(f->height < BLOCK_LINES ? f->height : BLOCK_LINES);
    size_t table = f->size_bytes;
    struct block b;

    if (!init_block(&b,
                    4 * lines * (size_t)f->width * (size_t)f->channel_count))
        f->is_cut = true;
    for (int y = 0; y < f->height; y += BLOCK_LINES)
        put(f, (const uint64_t[1]){0}, sizeof(uint64_t));
    for (int y = 0; y < f->height && !f->is_cut; y += BLOCK_LINES) {
        size_t entry = table + sizeof(uint64_t) * (size_t)(y / BLOCK_LINES);

        store32(f->bytes + entry, (uint32_t)f->size_bytes);
        store32(f->bytes + entry + 4, (uint32_t)(f->size_bytes >> 32));
        put_block(f, y, &b);
    }
    free_block(&b);
}

/* ---- channels ---- */

static int compare_names(const void *a, const void *b)
{
    const struct channel *first = a, *second = b;

    return strcmp(first->name, second->name);
}

/* Lists the channels in the order of the file, that of their names. */
static void add_layers(struct exr_file *f, const struct exr_layer *layers,
                       int count)
{
    for (int i = 0; i < count; i++) {
        for (int c = 0; layers[i].letters[c] != '\0'; c++) {
            struct channel *added = &f->channels[f->channel_count++];

            assert(f->channel_count <= EXR_CHANNELS_MAX && c < 3);
            snprintf(added->name, sizeof added->name, "%s%c", layers[i].prefix,
                     layers[i].letters[c]);
            added->values = layers[i].values + c;
        }
    }
    qsort(f->channels, (size_t)f->channel_count, sizeof f->channels[0],
          compare_names);
}

uint8_t *image_exr_encode(const struct exr_layer *layers, int layer_count,
                          int width, int height,
                          const struct image_metadata *metadata,
                          size_t *size_bytes)
{
    struct exr_file f = {.width = width, .height = height};

    assert(width > 0 && height > 0);
    add_layers(&f, layers, layer_count);
    put_header(&f, metadata);
    put_blocks(&f);
    if (f.is_cut) {
        free(f.bytes);
        return NULL;
    }
    *size_bytes = f.size_bytes;
    return f.bytes;
}
