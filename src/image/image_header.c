// SPDX-License-Identifier: MIT
#include "image/image_header.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "image/image_bytes.h"
#include "image/image_exr_read.h"
#include "image/image_hdr.h"
#include "image/image_psd.h"
#include "image/image_webp.h"
#include "image/stb.h"

/* Memory of a decoder for tables and rounding, without its pixels. */
#define DECODER_BYTES ((size_t)1 << 20)

/* Highest compression ratio of deflate, which codes at most 258 bytes in a
 * length and a distance of one bit each. */
#define DEFLATE_RATIO 1032

/* Peak memory of stb_image in bytes per pixel: 4 channels of one byte before
 * and after conversion, or 3 channels of one byte and of two. */
#define DECODED_BYTES 9

static uint64_t pixels_of(const struct image_file *f)
{
    return (uint64_t)f->width * (uint64_t)f->height;
}

static uint64_t ceil_div(uint64_t n, uint64_t by)
{
    return (n + by - 1) / by;
}

bool image_expect_limits(const struct image_file *f, struct error *err)
{
    if (f->width < 1 || f->height < 1 || f->width > IMAGE_SIDE_MAX ||
        f->height > IMAGE_SIDE_MAX)
        return fail(err, "%s: found %dx%d pixels, expected sides of 1 to %d",
                    f->path, f->width, f->height, IMAGE_SIDE_MAX);
    if (pixels_of(f) > IMAGE_PIXELS_MAX)
        return fail(err, "%s: found %dx%d pixels, expected %u in all at most",
                    f->path, f->width, f->height, IMAGE_PIXELS_MAX);
    return true;
}

bool image_take_side(const struct image_file *f, double number, int *side,
                     struct error *err)
{
    if (!(number >= 1 && number <= INT_MAX) || number != floor(number))
        return fail(err,
                    "%s: found a side of %g pixels, expected a whole number "
                    "from 1 to %d",
                    f->path, number, IMAGE_SIDE_MAX);
    *side = (int)number;
    return true;
}

static bool take_sides(struct image_file *f, uint32_t width, uint32_t height,
                       struct error *err)
{
    f->width = width > INT_MAX ? INT_MAX : (int)width;
    f->height = height > INT_MAX ? INT_MAX : (int)height;
    return image_expect_limits(f, err);
}

static bool expect_bytes(const struct image_file *f, uint64_t found,
                         uint64_t needed, struct error *err)
{
    return found >= needed ||
           fail(err, "%s: found %zu bytes, expected more for %dx%d pixels",
                f->path, f->size_bytes, f->width, f->height);
}

static bool fail_kind(const struct image_file *f, const char *reason,
                      struct error *err)
{
    return fail(err, "%s: found an image that cannot be read (%s)", f->path,
                reason);
}

/* ---- PNG ---- */

static bool is_png(const struct image_file *f)
{
    struct bytes b = bytes_of(f);

    return b.size >= 8 && memcmp(b.data, "\x89PNG\r\n\x1a\n", 8) == 0;
}

static bool png_header(struct image_file *f, struct error *err)
{
    static const uint32_t channels_of_color[] = {1, 1, 3, 1, 2, 1, 4};
    struct bytes b = bytes_of(f);
    size_t at = 8;

    /* Apple's tools put a chunk of their own before the header */
    if (big32(b, at + 4) == 0x43674249) /* CgBI */
        at += 12 + big32(b, at);
    if (big32(b, at + 4) != 0x49484452) /* IHDR */
        return fail_kind(f, "PNG without a header", err);
    uint32_t depth = byte_at(b, at + 16), color = byte_at(b, at + 17);
    bool is_interlaced = byte_at(b, at + 20) != 0;
    if (!take_sides(f, big32(b, at + 8), big32(b, at + 12), err))
        return false;
    if (depth > 16 || color > 6)
        return fail_kind(f, "Corrupt PNG", err);

    uint64_t bits = (uint64_t)channels_of_color[color] * depth;
    uint64_t row = ceil_div((uint64_t)f->width * bits, 8);
    uint64_t packed = is_interlaced ? pixels_of(f) * bits / 8
                                    : (uint64_t)f->height * (1 + row);
    if (!expect_bytes(f, f->size_bytes, packed / DEFLATE_RATIO, err))
        return false;
    /* stb_image counts the bytes of 4 channels in an int */
    uint64_t decoded = 4 * (depth == 16 ? 2 : 1) * pixels_of(f);
    if (decoded > INT_MAX || packed > INT_MAX)
        return fail(err,
                    "%s: found %dx%d pixels of %u bits a channel, expected "
                    "less than 2 GiB of them",
                    f->path, f->width, f->height, depth);
    /* memory for filtered and unfiltered bytes, and a third copy if rows come
     * in seven passes; the packed bytes lie in a buffer that doubles */
    decoded *= is_interlaced ? 3 : 2;
    if (decoded < DECODED_BYTES * pixels_of(f))
        decoded = DECODED_BYTES * pixels_of(f);
    f->decoder_bytes = DECODER_BYTES + 2 * f->size_bytes + (size_t)decoded;
    return true;
}

/* ---- JPEG ---- */

static bool is_jpeg(const struct image_file *f)
{
    struct bytes b = bytes_of(f);

    return b.size >= 3 && memcmp(b.data, "\xff\xd8\xff", 3) == 0;
}

/* Returns the offset of the frame header behind its marker, or 0 if there is
 * none that stb_image reads. The marker sets *is_progressive. */
static size_t jpeg_frame(struct bytes b, bool *is_progressive)
{
    for (size_t i = 2; i + 1 < b.size;) {
        if (b.data[i] != 0xff || b.data[i + 1] == 0xff) {
            i++;
            continue;
        }
        unsigned marker = b.data[i + 1];
        i += 2;
        *is_progressive = marker == 0xc2;
        if (marker >= 0xc0 && marker <= 0xc2)
            return i;
        i += big16(b, i);
    }
    return 0;
}

/* Reads the header of a JPEG file. Each block of 8x8 samples takes at least one
 * bit for the mean and, unless the file is progressive, one bit that ends the
 * block. */
static bool jpeg_header(struct image_file *f, struct error *err)
{
    struct bytes b = bytes_of(f);
    bool is_progressive = false;
    size_t at;

    if (!stb_is_safe(b.data, b.size))
        return fail(err,
                    "%s: found a Huffman table of more than 256 codes, "
                    "expected a JPEG image",
                    f->path);
    at = jpeg_frame(b, &is_progressive);
    uint32_t count = byte_at(b, at + 7), h_max = 1, v_max = 1;
    if (at == 0 || count > 4)
        return fail_kind(f, "JPEG without a frame that is known", err);
    if (!take_sides(f, big16(b, at + 5), big16(b, at + 3), err))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t sampling = byte_at(b, at + 9 + 3 * i);
        h_max = sampling >> 4 > h_max ? sampling >> 4 : h_max;
        v_max = (sampling & 15) > v_max ? sampling & 15 : v_max;
    }
    uint64_t width = (uint64_t)f->width, height = (uint64_t)f->height;
    uint64_t blocks = 0, samples = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t sampling = byte_at(b, at + 9 + 3 * i);
        uint64_t h = sampling >> 4, v = sampling & 15;
        blocks += ceil_div(ceil_div(width * h, h_max), 8) *
                  ceil_div(ceil_div(height * v, v_max), 8);
        samples += ceil_div(width, 8 * h_max) * h * 8 *
                   ceil_div(height, 8 * v_max) * v * 8;
    }
    if (!expect_bytes(f, f->size_bytes, blocks * (is_progressive ? 1 : 2) / 8,
                      err))
        return false;
    /* memory for the samples, with coefficients if progressive, and for the
     * pixels beside them */
    uint64_t decoded = samples * (is_progressive ? 3 : 1) + 4 * pixels_of(f);
    if (decoded < DECODED_BYTES * pixels_of(f))
        decoded = DECODED_BYTES * pixels_of(f);
    f->decoder_bytes = DECODER_BYTES + (size_t)decoded;
    return true;
}

/* ---- BMP ---- */

static bool is_bmp(const struct image_file *f)
{
    struct bytes b = bytes_of(f);

    return b.size >= 26 && memcmp(b.data, "BM", 2) == 0;
}

/* Reads the header of a BMP file. Rows are padded to multiples of 4 bytes; the
 * padding of the last one may be missing. */
static bool bmp_header(struct image_file *f, struct error *err)
{
    struct bytes b = bytes_of(f);
    bool is_old = little32(b, 14) == 12;
    uint32_t width = is_old ? little16(b, 18) : little32(b, 18);
    uint32_t height = is_old ? little16(b, 20) : little32(b, 22);
    uint64_t bits = is_old ? little16(b, 24) : little16(b, 28);
    uint64_t begin = little32(b, 10);

    if (height > INT_MAX) /* rows come from the top down */
        height = 0 - height;
    if (!take_sides(f, width, height, err))
        return false;
    uint64_t row = (uint64_t)f->width * bits;
    uint64_t needed = begin +
                      ceil_div(row, 32) * 4 * (uint64_t)(f->height - 1) +
                      ceil_div(row, 8);
    f->decoder_bytes = DECODER_BYTES + DECODED_BYTES * (size_t)pixels_of(f);
    return expect_bytes(f, f->size_bytes, needed, err);
}

/* ---- TGA ---- */

enum { TGA_INDEXED = 1, TGA_COLOR = 2, TGA_GREY = 3, TGA_RUNS = 8 };

/* Detects TGA by the allowed values of its fields, since the format has no
 * signature. */
static bool is_tga(const struct image_file *f)
{
    struct bytes b = bytes_of(f);
    uint32_t type = byte_at(b, 2) & ~(uint32_t)TGA_RUNS, bits = byte_at(b, 16);

    if (b.size < 18 || big16(b, 12) == 0 || big16(b, 14) == 0)
        return false;
    if (byte_at(b, 1) == 1)
        return type == TGA_INDEXED && (bits == 8 || bits == 16);
    return byte_at(b, 1) == 0 && (type == TGA_COLOR || type == TGA_GREY) &&
           (bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32);
}

/* Returns true if the runs cover all pixels: 128 + n stands for n + 1 copies of
 * the next pixel, n for the next n + 1 pixels. */
static bool tga_has_runs(struct bytes b, uint64_t at, uint64_t pixel_bytes,
                         uint64_t pixels)
{
    while (pixels > 0 && at < b.size) {
        uint64_t count = (uint64_t)(b.data[at] & 127) + 1;
        uint64_t stored = b.data[at] & 128 ? 1 : count;

        at += 1 + stored * pixel_bytes;
        pixels -= count < pixels ? count : pixels;
    }
    return pixels == 0 && at <= b.size;
}

static bool tga_header(struct image_file *f, struct error *err)
{
    struct bytes b = bytes_of(f);
    bool has_palette = byte_at(b, 1) == 1;
    uint64_t pixel_bytes = ceil_div(byte_at(b, 16), 8);
    uint64_t at =
        18 + byte_at(b, 0) +
        (has_palette ? little16(b, 5) * ceil_div(byte_at(b, 7), 8) : 0);

    if (!take_sides(f, little16(b, 12), little16(b, 14), err))
        return false;
    f->decoder_bytes = DECODER_BYTES + DECODED_BYTES * (size_t)pixels_of(f);
    if (byte_at(b, 2) & TGA_RUNS)
        return expect_bytes(f, tga_has_runs(b, at, pixel_bytes, pixels_of(f)),
                            1, err);
    return expect_bytes(f, b.size, at + pixel_bytes * pixels_of(f), err);
}

/* ---- GIF and PNM, as far as stb_image reads them ---- */

/* Peak memory in bytes per pixel: two pictures of 4 channels, and one byte that
 * tells which pixels were set, and 3 channels after conversion. */
#define GIF_BYTES 12

/* Most pixels of a byte: a code of 12 bits stands for up to 4096. */
#define GIF_RATIO (4096 * 8 / 12)

static bool is_gif(const struct image_file *f)
{
    return f->size_bytes >= 13 && (memcmp(f->data, "GIF87a", 6) == 0 ||
                                   memcmp(f->data, "GIF89a", 6) == 0);
}

/* Returns the bytes of a palette by the flags of the screen or of a picture. */
static size_t gif_palette(uint32_t flags)
{
    return flags & 0x80 ? 3u << ((flags & 7) + 1) : 0;
}

/* Moves *at behind blocks, each after its length, and the length 0. */
static void skip_blocks(struct bytes b, size_t *at)
{
    while (byte_at(b, *at) != 0)
        *at += 1 + (size_t)byte_at(b, *at);
    ++*at;
}

/* Returns the end of the first picture, or of the file's bytes if there is
 * none: beyond the file if that was cut. */
static size_t gif_end(struct bytes b)
{
    enum { EXTENSION = 0x21, PICTURE = 0x2c };
    size_t at = 13 + gif_palette(byte_at(b, 10));

    while (byte_at(b, at) == EXTENSION) {
        at += 2;
        skip_blocks(b, &at);
    }
    if (byte_at(b, at) != PICTURE)
        return at;
    at += 11 + gif_palette(byte_at(b, at + 9));
    skip_blocks(b, &at);
    return at;
}

/* Reads the sides of the screen, and makes what the first picture leaves free
 * transparent, as viewers do, by the number of the background colour. */
static bool gif_header(struct image_file *f, struct error *err)
{
    struct bytes b = bytes_of(f);

    if (!take_sides(f, little16(b, 6), little16(b, 8), err))
        return false;
    f->data[11] = 0;
    f->decoder_bytes = DECODER_BYTES + GIF_BYTES * (size_t)pixels_of(f);
    return expect_bytes(f, b.size, pixels_of(f) / GIF_RATIO, err) &&
           expect_bytes(f, b.size, gif_end(b), err);
}

/* True for the blanks of stb_image. */
static bool is_blank(uint32_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool is_pnm(const struct image_file *f)
{
    struct bytes b = bytes_of(f);

    return byte_at(b, 0) == 'P' && byte_at(b, 1) >= '1' &&
           byte_at(b, 1) <= '6' &&
           (is_blank(byte_at(b, 2)) || byte_at(b, 2) == '#');
}

/* Reads a number of up to 9 digits after blanks and comments. Returns 0 if
 * there is none. */
static uint32_t pnm_number(struct bytes b, size_t *at)
{
    uint32_t n = 0;

    while (is_blank(byte_at(b, *at)) || byte_at(b, *at) == '#')
        if (byte_at(b, (*at)++) == '#')
            while (*at < b.size && b.data[*at] != '\n' && b.data[*at] != '\r')
                ++*at;
    for (int i = 0; i < 9 && byte_at(b, *at) - '0' <= 9; i++)
        n = 10 * n + byte_at(b, (*at)++) - '0';
    return n;
}

/* Reads the header of grey (P5) or coloured bytes (P6). stb_image would
 * take values of another range for bytes. */
static bool pnm_header(struct image_file *f, struct error *err)
{
    struct bytes b = bytes_of(f);
    size_t at = 2;
    uint32_t width = pnm_number(b, &at), height = pnm_number(b, &at);
    uint32_t value_max = pnm_number(b, &at);
    unsigned char kind = b.data[1];

    if ((kind != '5' && kind != '6') || value_max != 255 ||
        !is_blank(byte_at(b, at)))
        return fail(err,
                    "%s: found P%c with values up to %" PRIu32
                    ", expected P5 or P6 with values up to 255",
                    f->path, kind, value_max);
    if (!take_sides(f, width, height, err))
        return false;
    f->decoder_bytes = DECODER_BYTES + DECODED_BYTES * (size_t)pixels_of(f);
    return expect_bytes(f, b.size,
                        at + 1 + pixels_of(f) * (kind == '6' ? 3 : 1), err);
}

/* ---- all kinds ---- */

/* Readers, in the order in which they are tried: TGA, which has no signature,
 * is the last one. An empty name is that of a kind that this build lacks. */
static const struct reader {
    const char *name;
    bool (*is)(const struct image_file *f);
    bool (*header)(struct image_file *f, struct error *err);
    enum image_kind kind;
    bool is_8bit;
} readers[] = {
    {"PNG", is_png, png_header, IMAGE_PNG, true},
    {"JPEG", is_jpeg, jpeg_header, IMAGE_JPEG, true},
    {"BMP", is_bmp, bmp_header, IMAGE_BMP, true},
    {image_webp_name, image_webp_is, image_webp_header, IMAGE_WEBP, true},
    {"PNM", is_pnm, pnm_header, IMAGE_PNM, true},
    {"GIF", is_gif, gif_header, IMAGE_GIF, true},
    {"PSD", image_psd_is, image_psd_header, IMAGE_PSD, true},
    {"Radiance HDR", image_hdr_is, image_hdr_header, IMAGE_HDR, false},
    {"PFM", image_pfm_is, image_pfm_header, IMAGE_PFM, false},
    {image_exr_name, image_exr_is, image_exr_header, IMAGE_EXR, false},
    {"TGA", is_tga, tga_header, IMAGE_TGA, true},
};

enum { READER_COUNT = sizeof readers / sizeof readers[0] };

/* Returns true for a KTX2 image, of a texture of glTF, which the program ktx of
 * Khronos converts. */
static bool is_ktx2(const struct image_file *f)
{
    struct bytes b = bytes_of(f);

    return b.size >= 12 && memcmp(b.data, "\xabKTX 20\xbb\r\n\x1a\n", 12) == 0;
}

/* Fails with the kinds that are read. */
static bool fail_unknown(const struct image_file *f, struct error *err)
{
    char known[256] = "";
    size_t length = 0;

    for (int i = 0; i < READER_COUNT; i++)
        if (*readers[i].name != '\0')
            length +=
                (size_t)snprintf(known + length, sizeof known - length, "%s%s",
                                 length == 0            ? ""
                                 : i < READER_COUNT - 1 ? ", "
                                                        : " or ",
                                 readers[i].name);
    if (is_ktx2(f))
        return fail(err,
                    "%s: found a KTX2 image, expected %s: 'ktx extract "
                    "--transcode rgba8 IN OUT.png' converts it",
                    f->path, known);
    return fail(err, "%s: found no image that can be read, expected %s",
                f->path, known);
}

/* Returns the reader of the file, or NULL. */
static const struct reader *reader_of(const struct image_file *f)
{
    for (int i = 0; i < READER_COUNT; i++)
        if (readers[i].is(f))
            return &readers[i];
    return NULL;
}

enum image_kind image_header_kind(const struct image_file *f)
{
    const struct reader *r = reader_of(f);
    const char *dot = strrchr(f->path, '.');

    if (r == NULL ||
        (r->kind == IMAGE_TGA && (dot == NULL || strcasecmp(dot, ".tga") != 0)))
        return IMAGE_UNKNOWN;
    return r->kind;
}

bool image_header(struct image_file *f, struct error *err)
{
    const struct reader *r = reader_of(f);

    if (r == NULL)
        return fail_unknown(f, err);
    if (r->is_8bit && f->size_bytes > INT_MAX)
        return fail(err, "%s: found %.1f GiB, expected 2 GiB at most", f->path,
                    (double)f->size_bytes / (1 << 30));
    f->kind = r->kind;
    if (!r->header(f, err))
        return false;
    /* PSD and WebP take the result's memory only */
    if (r->is_8bit && f->decoder_bytes == 0)
        f->decoder_bytes = 4 * (size_t)pixels_of(f);
    return true;
}
