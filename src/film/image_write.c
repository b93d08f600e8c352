// SPDX-License-Identifier: MIT
#include "film/image_write.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "image/stb.h"

#include "kernels/vec.h"

/* Limit for buffers of stb_image_write, which counts in int and doubles its
 * buffers. */
#define STB_BYTES_MAX ((size_t)1 << 30)

/* File in memory that grows while it is written. */
struct buffer {
    void *data;
    size_t size_bytes, capacity;
    bool is_cut; /* incomplete because memory was out */
};

static const struct ending {
    const char *text;
    enum image_write_format format;
} endings[] = {{".png", IMAGE_WRITE_PNG},
               {".hdr", IMAGE_WRITE_HDR},
               {".pfm", IMAGE_WRITE_PFM},
               {".exr", IMAGE_WRITE_EXR}};

static bool is_stdout(const char *path)
{
    return strcmp(path, "-") == 0;
}

enum image_write_format image_write_format_of(const char *path)
{
    size_t length = strlen(path);

    if (is_stdout(path))
        return IMAGE_WRITE_PNG;
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        size_t ending = strlen(endings[i].text);
        if (length >= ending &&
            strcasecmp(path + length - ending, endings[i].text) == 0)
            return endings[i].format;
    }
    return IMAGE_WRITE_UNKNOWN;
}

bool image_write_check(const char *path, struct error *err)
{
    struct stat st;

    if (is_stdout(path))
        return !isatty(STDOUT_FILENO) ||
               fail(err, "standard output: found a terminal, expected a file "
                         "or a pipe: give -o FILE");
    if (stat(path, &st) == 0 && S_ISDIR(st.st_mode))
        return fail(err, "%s: found a folder, expected a file", path);
    if (image_write_format_of(path) == IMAGE_WRITE_UNKNOWN)
        return fail(err,
                    "%s: found no known ending, expected " IMAGE_WRITE_ENDINGS,
                    path);
    return file_check(path, err);
}

static void append(void *context, void *data, int size_bytes)
{
    struct buffer *b = context;
    size_t more = size_bytes > 0 ? (size_t)size_bytes : 0;

    if (b->is_cut ||
        !grow_array(&b->data, &b->capacity, b->size_bytes + more, 1)) {
        b->is_cut = true;
        return;
    }
    memcpy((char *)b->data + b->size_bytes, data, more);
    b->size_bytes += more;
}

static bool out_of_memory(int width, int height, const char *path,
                          struct error *err)
{
    return fail(err, "%s: out of memory for %dx%d pixels", path, width, height);
}

static bool expect_size(int width, int height, size_t pixel_bytes,
                        const char *path, struct error *err)
{
    size_t most = STB_BYTES_MAX / pixel_bytes;
    size_t found = (size_t)width * (size_t)height;

    return found <= most ||
           fail(err,
                "%s: found %dx%d pixels, expected %zu in all at most "
                "(.pfm and .exr files have no limit)",
                path, width, height, most);
}

/* Inserts bytes into the file at the offset `at`. */
static void insert(struct buffer *b, size_t at, unsigned char *bytes,
                   size_t size_bytes)
{
    size_t end = b->size_bytes;
    char *data;

    append(b, bytes, (int)size_bytes);
    if (b->is_cut)
        return;
    data = b->data;
    memmove(data + at + size_bytes, data + at, end - at);
    memcpy(data + at, bytes, size_bytes);
}

/* Inserts the chunks behind the signature and IHDR. */
static void insert_chunks(struct buffer *b, const struct image_metadata *m)
{
    enum { SIGNATURE_BYTES = 8, IHDR_BYTES = 12 + 13 };
    unsigned char bytes[IMAGE_METADATA_BYTES];

    insert(b, SIGNATURE_BYTES + IHDR_BYTES, bytes,
           image_metadata_png(m, bytes));
}

/* Inserts the comments behind the first line, which names the format. */
static void insert_comments(struct buffer *b, const struct image_metadata *m)
{
    const char *line_end = memchr(b->data, '\n', b->size_bytes);
    unsigned char bytes[IMAGE_METADATA_BYTES];

    insert(b, (size_t)(line_end + 1 - (const char *)b->data), bytes,
           image_metadata_hdr(m, bytes));
}

static bool encode_frame(const struct frame *frame, const char *path,
                         struct buffer *b, struct error *err)
{
    struct stb_picture picture = {frame->width, frame->height, frame->rgb,
                                  NULL};
    bool ok = stb_encode(&picture, append, b);

    return (ok && !b->is_cut) ||
           out_of_memory(frame->width, frame->height, path, err);
}

static bool encode_png(struct film *film, struct develop how, const char *path,
                       struct buffer *b, struct error *err)
{
    struct frame frame;
    bool ok;

    if (!expect_size(film->width, film->height, 3, path, err) ||
        !frame_init(&frame, film->width, film->height, err))
        return false;
    film_resolve(film, how, &frame);
    ok = encode_frame(&frame, path, b, err);
    frame_free(&frame);
    return ok;
}

static float *linear_of(struct film *film, const char *path, struct error *err)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    float *rgb = alloc_array(pixels, 3 * sizeof *rgb);

    if (rgb)
        film_linear(film, rgb);
    else
        out_of_memory(film->width, film->height, path, err);
    return rgb;
}

/* Rounds to values that RGBE can hold. stb_image_write truncates mantissas,
 * which darkens a picture by a quarter of a per cent, but keeps rounded values.
 */
static void round_to_rgbe(float rgb[3])
{
    int exponent;
    float greatest = f_max(rgb[0], f_max(rgb[1], rgb[2]));
    float mantissa = frexpf(greatest, &exponent);

    if (!(greatest > 0))
        return;
    if (roundf(mantissa * 256) >= 256)
        exponent++; /* the mantissa rounds up to the next power of two */
    for (int c = 0; c < 3; c++)
        rgb[c] = ldexpf(roundf(ldexpf(rgb[c], 8 - exponent)), exponent - 8);
}

static bool encode_hdr(const float *rgb, int width, int height,
                       const char *path, struct buffer *b, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)height;
    float *rounded = alloc_array(pixels, 3 * sizeof *rounded);
    struct stb_picture picture = {width, height, NULL, rounded};
    bool ok = rounded != NULL;

    if (ok) {
        memcpy(rounded, rgb, 3 * sizeof *rounded * pixels);
        for (size_t i = 0; i < pixels; i++)
            round_to_rgbe(rounded + 3 * i);
        ok = stb_encode(&picture, append, b) && !b->is_cut;
    }
    free(rounded);
    return ok || out_of_memory(width, height, path, err);
}

static void append_floats(struct buffer *b, const float *values, int count)
{
    unsigned char bytes[4 * 256];

    for (int i = 0; i < count; i += 256) {
        int n = count - i < 256 ? count - i : 256;
        for (int k = 0; k < 4 * n; k++)
            bytes[k] =
                (unsigned char)(float_bits(values[i + k / 4]) >> 8 * (k % 4));
        append(b, bytes, 4 * n);
    }
}

/* Encodes rows from the bottom up. The negative scale means little endian. */
static bool encode_pfm(const float *rgb, int width, int height,
                       const char *path, struct buffer *b, struct error *err)
{
    char header[64];
    int length =
        snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n", width, height);

    append(b, header, length);
    for (int y = height - 1; y >= 0; y--)
        append_floats(b, rgb + 3 * (size_t)y * (size_t)width, 3 * width);
    return !b->is_cut || out_of_memory(width, height, path, err);
}

/* A picture of linear floats. */
struct floats {
    const float *rgb;
    int width, height;
    const struct image_metadata *metadata;
};

/* Encodes the picture with further layers. */
static bool encode_exr(const struct floats *f, const struct exr_layer *layers,
                       int layer_count, const char *path, struct buffer *b,
                       struct error *err)
{
    struct exr_layer all[EXR_CHANNELS_MAX] = {{"", "RGB", f->rgb}};

    assert(layer_count < EXR_CHANNELS_MAX);
    if (layer_count > 0)
        memcpy(all + 1, layers, sizeof *layers * (size_t)layer_count);
    b->data = image_exr_encode(all, layer_count + 1, f->width, f->height,
                               f->metadata, &b->size_bytes);
    return b->data != NULL || out_of_memory(f->width, f->height, path, err);
}

/* Encodes floats as HDR, PFM or EXR. Only EXR files have their metadata
 * already. */
static bool encode_floats(const struct floats *f, const char *path,
                          struct buffer *b, struct error *err)
{
    enum image_write_format format = image_write_format_of(path);

    if (format == IMAGE_WRITE_PFM)
        return encode_pfm(f->rgb, f->width, f->height, path, b, err);
    if (format == IMAGE_WRITE_EXR)
        return encode_exr(f, NULL, 0, path, b, err);
    return expect_size(f->width, f->height, 3 * sizeof *f->rgb, path, err) &&
           encode_hdr(f->rgb, f->width, f->height, path, b, err);
}

static bool encode_linear(struct film *film,
                          const struct image_metadata *metadata,
                          const char *path, struct buffer *b, struct error *err)
{
    float *rgb = linear_of(film, path, err);
    const struct floats f = {rgb, film->width, film->height, metadata};
    bool ok = rgb && encode_floats(&f, path, b, err);

    free(rgb);
    return ok;
}

static void embed(const struct image_metadata *m,
                  enum image_write_format format, struct buffer *b)
{
    if (format == IMAGE_WRITE_PNG)
        insert_chunks(b, m);
    else if (format == IMAGE_WRITE_HDR)
        insert_comments(b, m);
}

static bool encode_pixels(struct film *film, struct develop how,
                          const struct image_metadata *metadata,
                          const char *path, struct buffer *b, struct error *err)
{
    switch (image_write_format_of(path)) {
    case IMAGE_WRITE_PNG: return encode_png(film, how, path, b, err);
    case IMAGE_WRITE_HDR:
    case IMAGE_WRITE_PFM:
    case IMAGE_WRITE_EXR: return encode_linear(film, metadata, path, b, err);
    case IMAGE_WRITE_UNKNOWN: break;
    }
    return fail(err, "%s: found no known ending, expected " IMAGE_WRITE_ENDINGS,
                path);
}

static bool encode(struct film *film, struct develop how,
                   const struct image_metadata *metadata, const char *path,
                   struct buffer *b, struct error *err)
{
    if (!encode_pixels(film, how, metadata, path, b, err))
        return false;
    if (metadata != NULL)
        embed(metadata, image_write_format_of(path), b);
    return !b->is_cut || out_of_memory(film->width, film->height, path, err);
}

/* Writes the buffer to the file or to standard output. */
static bool publish(const struct buffer *b, const char *path, struct error *err)
{
    if (is_stdout(path))
        return file_write_stdout(b->data, b->size_bytes, err);
    return file_write(path, b->data, b->size_bytes, false, NULL, err);
}

bool image_write(struct film *film, struct develop how,
                 const struct image_metadata *metadata, const char *path,
                 struct error *err)
{
    struct buffer b = {.data = NULL};
    bool ok =
        encode(film, how, metadata, path, &b, err) && publish(&b, path, err);

    free(b.data);
    return ok;
}

bool image_write_layers(struct film *film,
                        const struct image_metadata *metadata,
                        const struct exr_layer *layers, int layer_count,
                        const char *path, struct error *err)
{
    struct buffer b = {.data = NULL};
    float *rgb = linear_of(film, path, err);
    const struct floats f = {rgb, film->width, film->height, metadata};
    bool ok = rgb && encode_exr(&f, layers, layer_count, path, &b, err) &&
              publish(&b, path, err);

    free(b.data);
    free(rgb);
    return ok;
}

bool image_write_frame(const struct frame *frame, const char *path,
                       struct error *err)
{
    struct buffer b = {.data = NULL};
    bool ok = expect_size(frame->width, frame->height, 3, path, err) &&
              encode_frame(frame, path, &b, err) && publish(&b, path, err);

    free(b.data);
    return ok;
}

bool image_write_floats(const float *rgb, int width, int height,
                        const char *path, struct error *err)
{
    struct buffer b = {.data = NULL};
    const struct floats f = {rgb, width, height, NULL};
    bool ok = encode_floats(&f, path, &b, err) && publish(&b, path, err);

    free(b.data);
    return ok;
}

char *image_write_numbered(struct film *film, struct develop how,
                           const struct image_metadata *metadata,
                           const char *stem, const char *ending,
                           struct error *err)
{
    struct buffer b = {.data = NULL};
    char *name = format_text("%s.%s", stem, ending);
    char *path = NULL;

    if (!name)
        fail(err, "%s: out of memory for its name", stem);
    if (name && encode(film, how, metadata, name, &b, err))
        path = file_write_numbered(stem, ending, b.data, b.size_bytes, err);
    free(b.data);
    free(name);
    return path;
}

char *image_write_frame_numbered(const struct frame *frame,
                                 const struct image_metadata *metadata,
                                 const char *stem, struct error *err)
{
    struct buffer b = {.data = NULL};
    char *path = NULL;
    bool ok = expect_size(frame->width, frame->height, 3, stem, err) &&
              encode_frame(frame, stem, &b, err);

    if (ok && metadata != NULL)
        insert_chunks(&b, metadata);
    if (ok)
        path = file_write_numbered(stem, "png", b.data, b.size_bytes, err);
    free(b.data);
    return path;
}
