// SPDX-License-Identifier: MIT
#include "image/image_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/machine.h"
#include "base/memory.h"
#include "image/color.h"
#include "image/image_exr_read.h"
#include "image/image_hdr.h"
#include "image/image_header.h"
#include "image/image_psd.h"
#include "image/image_webp.h"
#include "image/stb.h"

#include "kernels/tone.h"

/* Replacement for infinite values: far above any sky, far below the largest
 * float. */
#define LIGHT_MAX 1e30f

/* Bytes per pixel of the result. Float images take 3 floats, and one for the
 * sums of a sky's table; 8-bit images take 4 bytes here and 4 as a texel. */
#define LINEAR_BYTES (3 * sizeof(float) + sizeof(float))
#define BYTE_BYTES   8

static size_t pixels_of(const struct image_file *f)
{
    return (size_t)f->width * (size_t)f->height;
}

static bool is_float(const struct image_file *f)
{
    return f->kind == IMAGE_HDR || f->kind == IMAGE_PFM || f->kind == IMAGE_EXR;
}

/* ---- opening ---- */

/* Fails if the image needs more than its share of the memory. The rest is left
 * for triangles, the picture and other programs. */
static bool expect_memory(struct image_file *f, uint64_t held_bytes,
                          struct error *err)
{
    struct memory_quota quota = cgroup_quota_memory("");
    uint64_t budget_bytes = quota.size_bytes / 4 * 3;
    uint64_t left_bytes =
        budget_bytes > held_bytes ? budget_bytes - held_bytes : 0;

    f->is_beyond = f->memory_bytes > left_bytes;
    return !f->is_beyond ||
           fail(err,
                "%s: found an image that takes %.0f MiB to read, expected %.0f "
                "MiB at most (all images: three quarters of the %.0f MiB %s)",
                f->path, ceil((double)f->memory_bytes / (1 << 20)),
                floor((double)left_bytes / (1 << 20)),
                (double)quota.size_bytes / (1 << 20), quota.place);
}

/* Returns the peak memory of reading the image. */
static uint64_t memory_of(const struct image_file *f)
{
    uint64_t pixels = pixels_of(f);
    bool has_floats = f->form == IMAGE_LINEAR || is_float(f);
    uint64_t made = pixels * (has_floats ? LINEAR_BYTES : 0) +
                    pixels * (f->form == IMAGE_8BIT ? BYTE_BYTES : 0);
    uint64_t decoded =
        f->form == IMAGE_LINEAR ? made + f->decoder_bytes : f->decoder_bytes;

    return f->size_bytes + (decoded > made ? decoded : made);
}

static bool open_data(struct image_file *f, uint64_t held_bytes,
                      struct error *err)
{
    if (!image_header(f, err))
        return false;
    f->memory_bytes = memory_of(f);
    return expect_memory(f, held_bytes, err);
}

bool image_open(struct image_file *f, const char *path, enum image_form form,
                uint64_t held_bytes, struct error *err)
{
    *f = (struct image_file){.path = path, .form = form};
    f->memory_bytes = (uint64_t)file_identify(path).size_bytes;
    if (!expect_memory(f, held_bytes, err) ||
        !file_read(path, &f->data, &f->size_bytes, err))
        return false;
    if (open_data(f, held_bytes, err))
        return true;
    image_close(f);
    return false;
}

bool image_open_bytes(struct image_file *f, const struct file_bytes *from,
                      enum image_form form, uint64_t held_bytes,
                      struct error *err)
{
    *f = (struct image_file){.path = from->path,
                             .form = form,
                             .size_bytes = from->size_bytes,
                             .memory_bytes = from->size_bytes};
    if (!expect_memory(f, held_bytes, err))
        return false;
    f->data = alloc_array(from->size_bytes + 1, 1);
    if (!f->data)
        return fail(err, "%s: out of memory for the image", from->path);
    memcpy(f->data, from->bytes, from->size_bytes);
    if (open_data(f, held_bytes, err))
        return true;
    image_close(f);
    return false;
}

void image_close(struct image_file *f)
{
    free(f->data);
    f->data = NULL;
}

/* ---- decoding ---- */

static bool fail_memory(const struct image_file *f, struct error *err)
{
    return fail(err, "%s: out of memory for %dx%d pixels", f->path, f->width,
                f->height);
}

static bool fail_decoding(const struct image_file *f, struct error *err)
{
    const char *reason = stb_failure();

    return reason ? fail(err, "%s: found an image that cannot be read (%s)",
                         f->path, reason)
                  : fail_memory(f, err);
}

/* Returns the inverse sRGB curve (IEC 61966-2-1) for all 16-bit values, for
 * free(), or NULL if memory is out. An 8-bit value v is looked up as 257 v,
 * which is the same number between 0 and 1. */
static float *linear_of_srgb16(void)
{
    float *table = malloc(65536 * sizeof *table);

    for (int i = 0; table && i < 65536; i++) {
        double v = i / 65535.0;
        table[i] = (float)color_decoded(v);
    }
    return table;
}

/* Returns the pixels that stb_image has decoded, or NULL and the reason. */
static void *expect_pixels(const struct image_file *f, void *pixels, int width,
                           int height, struct error *err)
{
    if (pixels && width == f->width && height == f->height)
        return pixels;
    if (pixels)
        fail(err, "%s: found %dx%d pixels, expected %dx%d", f->path, width,
             height, f->width, f->height);
    else
        fail_decoding(f, err);
    free(pixels);
    return NULL;
}

static float *decode_float(const struct image_file *f, struct error *err)
{
    switch (f->kind) {
    case IMAGE_EXR: return image_exr_decode(f, err);
    case IMAGE_PFM: return image_pfm_decode(f, err);
    default: return image_hdr_decode(f, err);
    }
}

/* True for the kinds of 8 bits a channel that stb_image does not decode. */
static bool is_own(const struct image_file *f)
{
    return f->kind == IMAGE_PSD || f->kind == IMAGE_WEBP;
}

static uint8_t *decode_own(const struct image_file *f, struct error *err)
{
    return f->kind == IMAGE_WEBP ? image_webp_decode(f, err)
                                 : image_psd_decode(f, err);
}

/* Returns linear floats of an image that stb_image does not decode. */
static float *decode_own_linear(const struct image_file *f, struct error *err)
{
    uint8_t *rgba = decode_own(f, err);
    float *rgb = rgba ? alloc_array(pixels_of(f), 3 * sizeof *rgb) : NULL;

    if (rgba && !rgb)
        fail_memory(f, err);
    for (size_t i = 0; rgb && i < pixels_of(f); i++)
        for (size_t k = 0; k < 3; k++)
            rgb[3 * i + k] = (float)color_decoded(rgba[4 * i + k] / 255.0);
    free(rgba);
    return rgb;
}

static float *decode_linear(struct image_file *f, struct error *err)
{
    int width, height, channels;

    if (is_float(f))
        return decode_float(f, err);
    if (is_own(f))
        return decode_own_linear(f, err);
    stb_limit(f->decoder_bytes);
    stbi_us *pixels = stbi_load_16_from_memory((const unsigned char *)f->data,
                                               (int)f->size_bytes, &width,
                                               &height, &channels, 3);
    pixels = expect_pixels(f, pixels, width, height, err);
    if (!pixels)
        return NULL;
    float *rgb = alloc_array(pixels_of(f), 3 * sizeof *rgb);
    float *table = linear_of_srgb16();
    if (rgb && table) {
        for (size_t i = 0; i < 3 * pixels_of(f); i++)
            rgb[i] = table[pixels[i]];
    } else {
        fail_memory(f, err);
        free(rgb);
        rgb = NULL;
    }
    free(table);
    free(pixels);
    return rgb;
}

/* Clamps and counts negative and infinite values. Returns false for NaN. */
static bool clamp_light(float *rgb, size_t count, uint64_t *clamped_count)
{
    for (size_t i = 0; i < count; i++) {
        if (rgb[i] >= 0 && rgb[i] <= LIGHT_MAX)
            continue;
        if (isnan(rgb[i]))
            return false;
        rgb[i] = rgb[i] < 0 ? 0 : LIGHT_MAX;
        ++*clamped_count;
    }
    return true;
}

/* Returns floats encoded as 8-bit sRGB, and frees the floats. */
static uint8_t *encode_floats(const struct image_file *f, float *rgb,
                              struct error *err)
{
    uint8_t *rgba = alloc_array(pixels_of(f), 4);

    if (!rgba)
        fail_memory(f, err);
    for (size_t i = 0; rgba && i < pixels_of(f); i++) {
        for (size_t c = 0; c < 3; c++)
            rgba[4 * i + c] = (uint8_t)srgb_byte(rgb[3 * i + c]);
        rgba[4 * i + 3] = 255;
    }
    free(rgb);
    return rgba;
}

static float *decode_clamped(struct image_file *f, uint64_t *clamped_count,
                             struct error *err)
{
    float *rgb = decode_linear(f, err);

    *clamped_count = 0;
    if (!rgb || clamp_light(rgb, 3 * pixels_of(f), clamped_count))
        return rgb;
    free(rgb);
    fail(err, "%s: found a pixel that is not a number", f->path);
    return NULL;
}

static uint8_t *decode_8bit(struct image_file *f, struct error *err)
{
    int width, height, channels;
    uint8_t *rgba;
    uint64_t clamped_count;

    if (is_float(f)) {
        float *rgb = decode_clamped(f, &clamped_count, err);
        return rgb ? encode_floats(f, rgb, err) : NULL;
    }
    if (is_own(f))
        return decode_own(f, err);
    stb_limit(f->decoder_bytes);
    rgba = stbi_load_from_memory((const unsigned char *)f->data,
                                 (int)f->size_bytes, &width, &height, &channels,
                                 4);
    return expect_pixels(f, rgba, width, height, err);
}

bool image_decode(struct image_file *f, struct image *image,
                  uint64_t *clamped_count, struct error *err)
{
    *image = (struct image){.width = f->width, .height = f->height};
    *clamped_count = 0;
    if (f->form == IMAGE_LINEAR)
        image->rgb = decode_clamped(f, clamped_count, err);
    else
        image->rgba = decode_8bit(f, err);
    image_close(f);
    if (image->rgb || image->rgba)
        return true;
    image_free(image);
    return false;
}

void image_free(struct image *image)
{
    free(image->rgba);
    free(image->rgb);
    *image = (struct image){0};
}
