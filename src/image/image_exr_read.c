// SPDX-License-Identifier: MIT
#include "image/image_exr_read.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr.h>

#include "base/memory.h"
#include "image/image_bytes.h"
#include "image/image_header.h"

/* Number that says that a file is OpenEXR. */
#define MAGIC 20000630u

/* The least bytes of a chunk: its offset in the table, its place and size. */
#define CHUNK_BYTES 16

/* Buffers of a chunk: packed, unpacked and two between them. */
#define BUFFERS 4

/* An open file. */
struct input {
    exr_context_t context;
    exr_storage_t storage;
    exr_attr_box2i_t window;
    int channels[3];      /* of R, G and B in the file, or Y three times */
    int chunk[2];         /* width and height of a chunk */
    uint64_t pixel_bytes; /* of all channels */
    int64_t chunk_count;
    exr_decode_pipeline_t pipeline;
    float *rgb; /* the decoded picture */
};

const char image_exr_name[] = "OpenEXR";

bool image_exr_is(const struct image_file *f)
{
    return little32(bytes_of(f), 0) == MAGIC;
}

/* ---- the library's view of the file ---- */

static int64_t file_size(exr_const_context_t context, void *user_data)
{
    (void)context;
    return (int64_t)((const struct image_file *)user_data)->size_bytes;
}

static int64_t read_bytes(exr_const_context_t context, void *user_data,
                          void *to, uint64_t size_bytes, uint64_t offset,
                          exr_stream_error_func_ptr_t report)
{
    const struct image_file *f = user_data;
    uint64_t left = offset < f->size_bytes ? f->size_bytes - offset : 0;
    uint64_t count = size_bytes < left ? size_bytes : left;

    (void)context;
    (void)report;
    memcpy(to, f->data + offset, count);
    return (int64_t)count;
}

/* The library's messages are not printed: is_done() has the reason. */
static void ignore(exr_const_context_t context, exr_result_t code,
                   const char *text)
{
    (void)context;
    (void)code;
    (void)text;
}

static bool fail_exr(const struct image_file *f, const char *what,
                     struct error *err)
{
    return fail(err, "%s: found an OpenEXR file that cannot be read (%s)",
                f->path, what);
}

/* Returns true if the call of the library succeeded. */
static bool is_done(const struct image_file *f, exr_result_t result,
                    struct error *err)
{
    if (result == EXR_ERR_FEATURE_NOT_IMPLEMENTED) /* DWAA, DWAB before 3.2 */
        return fail_exr(f, "the library here lacks its compression", err);
    return result == EXR_ERR_SUCCESS ||
           fail_exr(f, exr_get_default_error_message(result), err);
}

/* ---- header ---- */

/* Finds the channels R, G and B, or Y. */
static bool find_channels(const struct image_file *f, struct input *in,
                          struct error *err)
{
    static const char names[] = "RGBY";
    const exr_attr_chlist_t *list;
    int found[4] = {-1, -1, -1, -1};

    if (!is_done(f, exr_get_channels(in->context, 0, &list), err))
        return false;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *c = &list->entries[i];
        const char *name =
            c->name.length == 1 ? strchr(names, *c->name.str) : NULL;

        in->pixel_bytes += c->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
        if (name == NULL || *name == '\0')
            continue;
        if (c->x_sampling != 1 || c->y_sampling != 1)
            return fail_exr(f, "colours in fewer places than pixels", err);
        found[name - names] = i;
    }
    for (int c = 0; c < 3; c++)
        in->channels[c] = found[c];
    if (found[0] < 0 || found[1] < 0 || found[2] < 0)
        for (int c = 0; c < 3; c++)
            in->channels[c] = found[3];
    return in->channels[0] >= 0 ||
           fail_exr(f, "no channels R, G and B, or Y", err);
}

/* Finds the size of the file's chunks, which are lines or tiles. */
static bool find_chunks(const struct image_file *f, struct input *in,
                        struct error *err)
{
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t round;
    uint32_t width, height;
    int32_t lines, count;

    if (!is_done(f, exr_get_chunk_count(in->context, 0, &count), err))
        return false;
    in->chunk_count = count;
    if (in->storage == EXR_STORAGE_SCANLINE) {
        in->chunk[0] = f->width;
        if (!is_done(f, exr_get_scanlines_per_chunk(in->context, 0, &lines),
                     err))
            return false;
        in->chunk[1] = lines;
        return true;
    }
    if (!is_done(f,
                 exr_get_tile_descriptor(in->context, 0, &width, &height,
                                         &levels, &round),
                 err))
        return false;
    in->chunk[0] = width < INT_MAX ? (int)width : INT_MAX;
    in->chunk[1] = height < INT_MAX ? (int)height : INT_MAX;
    return (in->chunk[0] >= 1 && in->chunk[1] >= 1 &&
            in->chunk[0] <= IMAGE_SIDE_MAX && in->chunk[1] <= IMAGE_SIDE_MAX) ||
           fail_exr(f, "impossible tiles", err);
}

static bool read_header(struct image_file *f, struct input *in,
                        struct error *err)
{
    int64_t width, height;

    if (!is_done(f, exr_get_storage(in->context, 0, &in->storage), err) ||
        !is_done(f, exr_get_data_window(in->context, 0, &in->window), err))
        return false;
    if (in->storage != EXR_STORAGE_SCANLINE && in->storage != EXR_STORAGE_TILED)
        return fail_exr(f, "deep pixels", err);
    width = (int64_t)in->window.max.x - in->window.min.x + 1;
    height = (int64_t)in->window.max.y - in->window.min.y + 1;
    if (width < 1 || height < 1 || width > INT_MAX || height > INT_MAX)
        return fail_exr(f, "an impossible window", err);
    f->width = (int)width;
    f->height = (int)height;
    return image_expect_limits(f, err) && find_channels(f, in, err) &&
           find_chunks(f, in, err);
}

/* Opens the file and reads its header. The caller calls exr_finish() in any
 * case. */
static bool open_file(struct image_file *f, struct input *in, struct error *err)
{
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;

    *in = (struct input){.context = NULL};
    start.error_handler_fn = ignore;
    start.user_data = f;
    start.read_fn = read_bytes;
    start.size_fn = file_size;
    start.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return is_done(f, exr_start_read(&in->context, f->path, &start), err) &&
           read_header(f, in, err);
}

bool image_exr_header(struct image_file *f, struct error *err)
{
    struct input in;
    bool ok = open_file(f, &in, err);

    exr_finish(&in.context);
    if (!ok)
        return false;
    f->decoder_bytes = BUFFERS * (size_t)in.pixel_bytes * (size_t)in.chunk[0] *
                       (size_t)in.chunk[1];
    return (uint64_t)in.chunk_count * CHUNK_BYTES <= f->size_bytes ||
           fail(err, "%s: found %zu bytes, expected more for %dx%d pixels",
                f->path, f->size_bytes, f->width, f->height);
}

/* ---- pixels ---- */

static bool is_grey(const struct input *in)
{
    return in->channels[1] == in->channels[0];
}

/* Decodes a chunk whose first pixel is at (x, y) of the picture. */
static bool decode_chunk(const struct image_file *f, struct input *in,
                         const exr_chunk_info_t *chunk, int x, int y,
                         struct error *err)
{
    exr_decode_pipeline_t *pipeline = &in->pipeline;
    float *first = in->rgb + 3 * ((size_t)y * (size_t)f->width + (size_t)x);
    bool is_first = pipeline->channels == NULL;
    exr_result_t result =
        is_first ? exr_decoding_initialize(in->context, 0, chunk, pipeline)
                 : exr_decoding_update(in->context, 0, chunk, pipeline);

    if (!is_done(f, result, err))
        return false;
    if (chunk->width > f->width - x || chunk->height > f->height - y)
        return fail_exr(f, "a chunk outside", err);
    for (int c = 0; c < 3; c++) {
        exr_coding_channel_info_t *to = &pipeline->channels[in->channels[c]];

        to->decode_to_ptr = (uint8_t *)(first + (is_grey(in) ? 0 : c));
        to->user_data_type = EXR_PIXEL_FLOAT;
        to->user_bytes_per_element = sizeof *first;
        to->user_pixel_stride = 3 * sizeof *first;
        to->user_line_stride = 3 * (int)sizeof *first * f->width;
    }
    if (is_first)
        result = exr_decoding_choose_default_routines(in->context, 0, pipeline);
    return is_done(f, result, err) &&
           is_done(f, exr_decoding_run(in->context, 0, pipeline), err);
}

static bool decode(const struct image_file *f, struct input *in,
                   struct error *err)
{
    const int *size = in->chunk;

    for (int y = 0; y < f->height; y += size[1])
        for (int x = 0; x < f->width; x += size[0]) {
            exr_chunk_info_t chunk;
            exr_result_t result =
                in->storage == EXR_STORAGE_TILED
                    ? exr_read_tile_chunk_info(in->context, 0, x / size[0],
                                               y / size[1], 0, 0, &chunk)
                    : exr_read_scanline_chunk_info(in->context, 0,
                                                   in->window.min.y + y,
                                                   &chunk);

            if (!is_done(f, result, err) ||
                !decode_chunk(f, in, &chunk, x, y, err))
                return false;
        }
    return true;
}

/* Copies the grey of Y to all three values. */
static void spread_grey(const struct image_file *f, float *rgb)
{
    size_t count = (size_t)f->width * (size_t)f->height;

    for (size_t i = 0; i < count; i++)
        rgb[3 * i + 1] = rgb[3 * i + 2] = rgb[3 * i];
}

float *image_exr_decode(const struct image_file *f, struct error *err)
{
    struct image_file file = *f;
    struct input in;
    bool ok = open_file(&file, &in, err);

    if (ok) {
        in.rgb = alloc_array((size_t)f->width * (size_t)f->height,
                             3 * sizeof *in.rgb);
        ok = in.rgb != NULL ? decode(f, &in, err)
                            : fail(err, "%s: out of memory for %dx%d pixels",
                                   f->path, f->width, f->height);
        exr_decoding_destroy(in.context, &in.pipeline);
    }
    exr_finish(&in.context);
    if (ok && is_grey(&in))
        spread_grey(f, in.rgb);
    if (ok)
        return in.rgb;
    free(in.rgb);
    return NULL;
}
