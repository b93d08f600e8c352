// SPDX-License-Identifier: MIT
#include "glim/image.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glim/color.h"
#include "glim/file.h"
#include "glim/number.h"
#include "glim/stb.h"

#include "kernels/tone.h"

/* What infinite values become: far above any sky, far below float's end. */
#define LIGHT_MAX 1e30f

/* A file in memory and what its header says. */
struct source {
    const char *path;
    char *data;
    size_t size_bytes;
    int width, height;
};

static size_t pixels_of(const struct source *s)
{
    return (size_t)s->width * (size_t)s->height;
}

static const unsigned char *bytes_of(const struct source *s)
{
    return (const unsigned char *)s->data;
}

static bool expect_limits(const struct source *s, struct error *err)
{
    if (s->width < 1 || s->height < 1 || s->width > IMAGE_SIDE_MAX ||
        s->height > IMAGE_SIDE_MAX)
        return fail(err, "%s: found %dx%d pixels, expected sides of 1 to %d",
                    s->path, s->width, s->height, IMAGE_SIDE_MAX);
    if (pixels_of(s) > IMAGE_PIXELS_MAX)
        return fail(err, "%s: found %dx%d pixels, expected %u in all at most",
                    s->path, s->width, s->height, IMAGE_PIXELS_MAX);
    return true;
}

static bool fail_memory(const struct source *s, struct error *err)
{
    return fail(err, "%s: out of memory for %dx%d pixels", s->path, s->width,
                s->height);
}

static bool fail_decoding(const struct source *s, struct error *err)
{
    const char *reason = stbi_failure_reason();

    return fail(err,
                "%s: found no image that can be read (%s), expected PNG, "
                "JPEG, BMP, TGA, Radiance HDR or PFM",
                s->path, reason ? reason : "out of memory");
}

/* A side as a file's header has it. */
static bool take_side(const struct source *s, double number, int *side,
                      struct error *err)
{
    if (!(number >= 1 && number <= INT_MAX) || number != floor(number))
        return fail(err,
                    "%s: found a side of %g pixels, expected a whole number "
                    "from 1 to %d",
                    s->path, number, IMAGE_SIDE_MAX);
    *side = (int)number;
    return true;
}

/* PFM: "PF" or "Pf", width, height, scale, one white space; rows from the
 * bottom up, little endian if the scale is negative. */
struct pfm {
    const char *values;
    int channels;
    bool is_big_endian;
};

static bool is_pfm(const struct source *s)
{
    return s->size_bytes > 2 && s->data[0] == 'P' &&
           (s->data[1] == 'F' || s->data[1] == 'f') &&
           (s->data[2] == '\n' || s->data[2] == '\r' || s->data[2] == ' ');
}

/* Fills the source's size as well. */
static bool pfm_header(struct source *s, struct pfm *pfm, struct error *err)
{
    const char *p = s->data + 2;
    const char *end = s->data + s->size_bytes;
    double numbers[3] = {0};

    for (int i = 0; i < 3; i++) {
        while (p < end && memchr(" \t\r\n", *p, 4))
            p++;
        if (!number_parse(&p, end, &numbers[i]) || p == end)
            return fail(err, "%s: expected width, height and scale after 'P%c'",
                        s->path, s->data[1]);
    }
    if (!take_side(s, numbers[0], &s->width, err) ||
        !take_side(s, numbers[1], &s->height, err))
        return false;
    pfm->values = p + 1;
    pfm->channels = s->data[1] == 'F' ? 3 : 1;
    pfm->is_big_endian = numbers[2] > 0;
    return expect_limits(s, err);
}

static float pfm_value(const struct pfm *pfm, size_t index)
{
    const unsigned char *b = (const unsigned char *)pfm->values + 4 * index;
    uint32_t bits;
    float value;

    if (pfm->is_big_endian)
        bits = (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 |
               (uint32_t)b[2] << 8 | b[3];
    else
        bits = (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 |
               (uint32_t)b[1] << 8 | b[0];
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float *read_pfm(struct source *s, struct error *err)
{
    struct pfm pfm = {0};

    if (!pfm_header(s, &pfm, err))
        return NULL;
    size_t found = s->size_bytes - (size_t)(pfm.values - s->data);
    size_t row = (size_t)s->width * (size_t)pfm.channels;
    if (found / 4 / row < (size_t)s->height) {
        fail(err, "%s: found %zu bytes of pixels, expected %zu", s->path, found,
             4 * row * (size_t)s->height);
        return NULL;
    }
    float *rgb = alloc_array(pixels_of(s), 3 * sizeof *rgb);
    if (!rgb) {
        fail_memory(s, err);
        return NULL;
    }
    size_t to = 0;
    for (int y = s->height - 1; y >= 0; y--) {
        for (int x = 0; x < s->width; x++) {
            size_t from = (size_t)y * row + (size_t)(x * pfm.channels);
            for (int c = 0; c < 3; c++)
                rgb[to++] = pfm_value(&pfm, from + (size_t)(c % pfm.channels));
        }
    }
    return rgb;
}

static bool is_hdr(const struct source *s)
{
    static const char *const marks[] = {"#?RADIANCE", "#?RGBE"};

    for (int i = 0; i < 2; i++) {
        size_t length = strlen(marks[i]);
        if (s->size_bytes > length && memcmp(s->data, marks[i], length) == 0)
            return true;
    }
    return false;
}

static bool skip_text(const char **p, const char *end, const char *text)
{
    size_t length = strlen(text);

    if ((size_t)(end - *p) < length || memcmp(*p, text, length) != 0)
        return false;
    *p += length;
    return true;
}

/* Lines of text up to an empty one, then "-Y height +X width". *pixels is what
 * follows. */
static bool hdr_header(struct source *s, const char **pixels, struct error *err)
{
    static const char blank[] = "\n\n", format[] = "FORMAT=32-bit_rle_rgbe";
    const char *end = s->data + s->size_bytes;
    const char *p = memmem(s->data, s->size_bytes, blank, 2);
    double height, width;

    if (!p || !memmem(s->data, (size_t)(p - s->data), format, strlen(format)))
        return fail(err, "%s: expected a header with %s", s->path, format);
    p += strlen(blank);
    if (!skip_text(&p, end, "-Y ") || !number_parse(&p, end, &height) ||
        !skip_text(&p, end, " +X ") || !number_parse(&p, end, &width) ||
        !skip_text(&p, end, "\n"))
        return fail(err, "%s: expected '-Y height +X width' after the header",
                    s->path);
    *pixels = p;
    return take_side(s, width, &s->width, err) &&
           take_side(s, height, &s->height, err) && expect_limits(s, err);
}

/* One row with its four channels apart, each in runs (128 + n: n times the
 * next byte) and copies (n: the next n bytes). False: the file ends, or the
 * row does not end where it should. */
static bool hdr_packed_row(const unsigned char **p, const unsigned char *end,
                           int width, unsigned char *rgbe)
{
    for (int c = 0; c < 4; c++) {
        for (int x = 0; x < width;) {
            if (end - *p < 2)
                return false;
            int count = *(*p)++;
            bool is_run = count > 128;
            count -= is_run ? 128 : 0;
            if (count == 0 || count > width - x ||
                end - *p < (is_run ? 1 : count))
                return false;
            for (int i = 0; i < count; i++)
                rgbe[4 * x++ + c] = is_run ? **p : (*p)[i];
            *p += is_run ? 1 : count;
        }
    }
    return true;
}

/* One row of whole pixels; 1 1 1 n means the last one n times more, and in a
 * second such pixel n counts 256 times as much. */
static bool hdr_flat_row(const unsigned char **p, const unsigned char *end,
                         int width, unsigned char *rgbe)
{
    int shift = 0;

    for (int x = 0; x < width;) {
        if (end - *p < 4)
            return false;
        const unsigned char *pixel = *p;
        *p += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(rgbe + 4 * x++, pixel, 4);
            shift = 0;
            continue;
        }
        if (x == 0 || shift > 8 || pixel[3] << shift > width - x)
            return false;
        for (int n = pixel[3] << shift; n > 0; n--, x++)
            memcpy(rgbe + 4 * x, rgbe + 4 * (x - 1), 4);
        shift += 8;
    }
    return true;
}

static bool hdr_row(const unsigned char **p, const unsigned char *end,
                    int width, unsigned char *rgbe)
{
    const unsigned char *q = *p;

    if (end - q < 4)
        return false;
    if (q[0] != 2 || q[1] != 2 || (q[2] << 8 | q[3]) != width)
        return hdr_flat_row(p, end, width, rgbe);
    *p += 4;
    return hdr_packed_row(p, end, width, rgbe);
}

/* Radiance HDR; a value is mantissa * 2^(exponent - 136), exponent 0 is
 * black. */
static float *read_hdr(struct source *s, struct error *err)
{
    const unsigned char *end = bytes_of(s) + s->size_bytes;
    const char *pixels = NULL;

    if (!hdr_header(s, &pixels, err))
        return NULL;
    const unsigned char *p = (const unsigned char *)pixels;
    unsigned char *rgbe = xmalloc(4 * (size_t)s->width);
    float *rgb = alloc_array(pixels_of(s), 3 * sizeof *rgb);
    bool ok = rgb || fail_memory(s, err);
    for (int y = 0; ok && y < s->height; y++) {
        float *row = rgb + 3 * (size_t)y * (size_t)s->width;
        if (!hdr_row(&p, end, s->width, rgbe))
            ok = fail(err, "%s: found no end of row %d of %d", s->path, y + 1,
                      s->height);
        for (int i = 0; ok && i < 3 * s->width; i++) {
            const unsigned char *pixel = rgbe + 4 * (i / 3);
            row[i] = pixel[3] ? ldexpf(pixel[i % 3], pixel[3] - 136) : 0;
        }
    }
    free(rgbe);
    if (ok)
        return rgb;
    free(rgb);
    return NULL;
}

/* The sRGB curve, IEC 61966-2-1, for all 16-bit values; for free(). An 8-bit
 * value v comes as 257 v, which is the same number between 0 and 1. */
static float *linear_of_srgb16(void)
{
    float *table = xmalloc(65536 * sizeof *table);

    for (int i = 0; i < 65536; i++) {
        double v = i / 65535.0;
        table[i] = (float)color_decoded(v);
    }
    return table;
}

static float *read_ldr(struct source *s, struct error *err)
{
    int channels;
    stbi_us *pixels =
        stbi_load_16_from_memory(bytes_of(s), (int)s->size_bytes, &s->width,
                                 &s->height, &channels, 3);

    if (!pixels) {
        fail_decoding(s, err);
        return NULL;
    }
    float *rgb = alloc_array(pixels_of(s), 3 * sizeof *rgb);
    if (rgb) {
        float *table = linear_of_srgb16();
        for (size_t i = 0; i < 3 * pixels_of(s); i++)
            rgb[i] = table[pixels[i]];
        free(table);
    } else {
        fail_memory(s, err);
    }
    free(pixels);
    return rgb;
}

/* The sides in a PNG's header. For one that is too large stb's only words are
 * that it knows no such kind of file. */
static bool expect_png_limits(struct source *s, struct error *err)
{
    uint32_t sides[2] = {0};

    if (s->size_bytes < 24 || memcmp(s->data, "\x89PNG\r\n\x1a\n", 8) != 0)
        return true;
    for (int i = 0; i < 8; i++)
        sides[i / 4] = sides[i / 4] << 8 | bytes_of(s)[16 + i];
    s->width = sides[0] > INT_MAX ? INT_MAX : (int)sides[0];
    s->height = sides[1] > INT_MAX ? INT_MAX : (int)sides[1];
    return expect_limits(s, err);
}

/* Also keeps the decoder from asking for much more memory than the pixels
 * need: four 16-bit channels, filtered and not, in a buffer that doubles. */
static bool read_header(struct source *s, struct error *err)
{
    int channels;

    if (s->size_bytes > INT_MAX)
        return fail(err, "%s: found %.1f GiB, expected 2 GiB at most", s->path,
                    (double)s->size_bytes / (1 << 30));
    if (!expect_png_limits(s, err))
        return false;
    if (!stb_is_safe(bytes_of(s), s->size_bytes))
        return fail(err,
                    "%s: found a Huffman table of more than 256 codes, "
                    "expected a JPEG image",
                    s->path);
    stb_limit((size_t)1 << 24);
    if (!stbi_info_from_memory(bytes_of(s), (int)s->size_bytes, &s->width,
                               &s->height, &channels))
        return fail_decoding(s, err);
    if (!expect_limits(s, err))
        return false;
    stb_limit(((size_t)1 << 24) + 2 * s->size_bytes + 32 * pixels_of(s));
    return true;
}

/* The pixels of any kind of file, 3 floats each. NULL is an error. */
static float *decode_linear(struct source *s, struct error *err)
{
    if (is_pfm(s))
        return read_pfm(s, err);
    if (is_hdr(s))
        return read_hdr(s, err);
    return read_header(s, err) ? read_ldr(s, err) : NULL;
}

/* False for NaN. */
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

static bool read_linear(struct image *image, struct source *s,
                        uint64_t *clamped_count, struct error *err)
{
    float *rgb = decode_linear(s, err);

    *clamped_count = 0;
    if (!rgb)
        return false;
    if (!clamp_light(rgb, 3 * pixels_of(s), clamped_count)) {
        free(rgb);
        return fail(err, "%s: found a pixel that is not a number", s->path);
    }
    *image = (struct image){.width = s->width, .height = s->height, .rgb = rgb};
    return true;
}

/* An image of floats as 8-bit sRGB. */
static bool encode_floats(struct image *image, const char *path,
                          struct error *err)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;

    image->rgba = alloc_array(pixels, 4);
    if (!image->rgba)
        return fail(err, "%s: out of memory for %dx%d pixels", path,
                    image->width, image->height);
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            image->rgba[4 * i + c] = (uint8_t)srgb_byte(image->rgb[3 * i + c]);
        image->rgba[4 * i + 3] = 255;
    }
    free(image->rgb);
    image->rgb = NULL;
    return true;
}

static bool read_8bit(struct image *image, struct source *s, struct error *err)
{
    uint64_t clamped_count;
    int channels;

    if (is_pfm(s) || is_hdr(s))
        return read_linear(image, s, &clamped_count, err) &&
               encode_floats(image, s->path, err);
    if (!read_header(s, err))
        return false;
    image->rgba =
        stbi_load_from_memory(bytes_of(s), (int)s->size_bytes, &image->width,
                              &image->height, &channels, 4);
    return image->rgba || fail_decoding(s, err);
}

bool image_read_8bit(struct image *image, const char *path, struct error *err)
{
    struct source s = {.path = path};

    *image = (struct image){0};
    if (!file_read(path, &s.data, &s.size_bytes, err))
        return false;
    bool ok = read_8bit(image, &s, err);
    free(s.data);
    if (!ok)
        image_free(image);
    return ok;
}

bool image_read_linear(struct image *image, const char *path,
                       uint64_t *clamped_count, struct error *err)
{
    struct source s = {.path = path};

    *image = (struct image){0};
    *clamped_count = 0;
    if (!file_read(path, &s.data, &s.size_bytes, err))
        return false;
    bool ok = read_linear(image, &s, clamped_count, err);
    free(s.data);
    return ok;
}

void image_free(struct image *image)
{
    free(image->rgba);
    free(image->rgb);
    *image = (struct image){0};
}
