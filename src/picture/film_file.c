// SPDX-License-Identifier: MIT
#include "picture/film_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define ZLIB_CONST
#include <zlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "picture/film_merge.h"
#include "picture/film_pack.h"

#include "kernels/sample_share.h"

/* Pixels of a band, at least, if the film has so many. */
#define BAND_PIXELS 8192

/* Size and checksum before the bytes of a band. */
#define BAND_HEAD 8

/* A band of rows in memory. */
struct band {
    size_t pixel_count; /* of all bands but the last */
    size_t words;       /* of a pixel */
    uint64_t *pixels;   /* pixel_count * words */
    uint8_t *planes;    /* the same bytes by planes */
};

static bool band_init(struct band *b, size_t pixels, size_t words)
{
    b->pixel_count = pixels;
    b->words = words;
    b->pixels = alloc_array(pixels * words, sizeof *b->pixels);
    b->planes = alloc_array(pixels * words, sizeof *b->pixels);
    return b->pixels != NULL && b->planes != NULL;
}

static void band_free(struct band *b)
{
    free(b->pixels);
    free(b->planes);
}

static void to_planes(const struct band *b, size_t pixels)
{
    uint8_t *to = b->planes;

    for (size_t w = 0; w < b->words; w++)
        for (int shift = 0; shift < 64; shift += 8)
            for (size_t i = 0; i < pixels; i++)
                *to++ = (uint8_t)(b->pixels[i * b->words + w] >> shift);
}

static void from_planes(const struct band *b, size_t pixels)
{
    const uint8_t *from = b->planes;

    memset(b->pixels, 0, pixels * b->words * sizeof *b->pixels);
    for (size_t w = 0; w < b->words; w++)
        for (int shift = 0; shift < 64; shift += 8)
            for (size_t i = 0; i < pixels; i++)
                b->pixels[i * b->words + w] |= (uint64_t)*from++ << shift;
}

static int band_rows(const struct film *film)
{
    int rows = BAND_PIXELS / film->width + 1;

    return rows < film->height ? rows : film->height;
}

/* ---- write ---- */

/* A file that grows in memory. */
struct output {
    void *bytes;
    size_t size, capacity;
    z_stream z;
};

static void put_u32(uint8_t *to, uint32_t n)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(n >> 8 * i);
}

static uint32_t take_u32(const uint8_t *from)
{
    uint32_t n = 0;

    for (int i = 0; i < 4; i++)
        n |= (uint32_t)from[i] << 8 * i;
    return n;
}

/* Packs the planes of a band and appends it. */
static bool put_band(struct output *o, const struct band *b, size_t pixels)
{
    size_t raw = pixels * b->words * sizeof *b->pixels;
    size_t most = deflateBound(&o->z, raw), packed;
    uint8_t *head;

    to_planes(b, pixels);
    if (!grow_array(&o->bytes, &o->capacity, o->size + BAND_HEAD + most, 1))
        return false;
    head = (uint8_t *)o->bytes + o->size;
    o->z.next_in = b->planes;
    o->z.avail_in = (uInt)raw;
    o->z.next_out = head + BAND_HEAD;
    o->z.avail_out = (uInt)most;
    if (deflate(&o->z, Z_FINISH) != Z_STREAM_END)
        return false;
    packed = most - o->z.avail_out;
    put_u32(head, (uint32_t)packed);
    put_u32(head + 4, (uint32_t)crc32(0, head + BAND_HEAD, (uInt)packed));
    o->size += BAND_HEAD + packed;
    return deflateReset(&o->z) == Z_OK;
}

static bool put_rows(struct output *o, struct film *film)
{
    size_t words = film_words_count(film->surfaces != NULL);
    size_t width = (size_t)film->width;
    int step = band_rows(film);
    struct band band = {0};
    bool ok = band_init(&band, width * (size_t)step, words);

    for (int y = 0; ok && y < film->height; y += step) {
        int end = y + step < film->height ? y + step : film->height;

        for (int i = y; i < end; i++)
            film_words_put(film, i,
                           band.pixels + (size_t)(i - y) * width * words);
        ok = put_band(o, &band, (size_t)(end - y) * width);
    }
    band_free(&band);
    return ok;
}

/* Appends the shares as one band, four of them in a word. */
static bool put_shares(struct output *o, const uint16_t *shares, size_t pixels)
{
    struct band band = {0};
    size_t count = (pixels + 3) / 4;
    bool ok = band_init(&band, count, 1);

    for (size_t i = 0; ok && i < pixels; i++)
        band.pixels[i / 4] |= (uint64_t)shares[i] << i % 4 * 16;
    ok = ok && put_band(o, &band, count);
    band_free(&band);
    return ok;
}

static bool put_all(struct output *o, const struct film_header *header,
                    struct film *film, film_file_shares *shares, void *context)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    const uint16_t *decided;

    /* runs of zeros and Huffman codes alone: three times as fast as with the
     * search for strings, which finds none, and as small */
    if (deflateInit2(&o->z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS, 8,
                     Z_RLE) != Z_OK)
        return false;
    o->bytes = film_header_text(header, &o->size);
    o->capacity = o->size;
    if (o->bytes == NULL || !put_rows(o, film))
        return false;
    decided = shares != NULL ? shares(context) : NULL;
    return decided == NULL || put_shares(o, decided, pixels);
}

char *film_file_bytes(const struct film_header *header, struct film *film,
                      film_file_shares *shares, void *context,
                      size_t *size_bytes, struct error *err)
{
    struct output o = {0};
    bool ok = put_all(&o, header, film, shares, context);

    deflateEnd(&o.z);
    *size_bytes = o.size;
    if (ok)
        return o.bytes;
    free(o.bytes);
    fail(err, "out of memory for the file of a film of %dx%d pixels",
         film->width, film->height);
    return NULL;
}

bool film_file_write(const char *path, const struct film_header *header,
                     struct film *film, film_file_shares *shares, void *context,
                     struct error *err)
{
    size_t size;
    char *bytes = film_file_bytes(header, film, shares, context, &size, err);
    bool ok = bytes != NULL && file_write(path, bytes, size, false, NULL, err);

    free(bytes);
    return ok;
}

/* ---- read ---- */

struct input {
    const char *path;
    const uint8_t *p, *end;
};

static bool fail_band(const struct input *in, const struct film *film, int y,
                      const char *what, struct error *err)
{
    if (y < film->height)
        return fail(err, "%s: found %s at row %d of %d, expected a whole film",
                    in->path, what, y, film->height);
    return fail(err, "%s: found %s behind the last row, expected a whole film",
                in->path, what);
}

/* Unpacks the next band. y is its first row. */
static bool take_band(struct input *in, const struct film *film, int y,
                      struct band *b, size_t pixels, struct error *err)
{
    uLongf raw = (uLongf)(pixels * b->words * sizeof *b->pixels);
    uLongf unpacked = raw;
    uint32_t packed, checksum;

    if (in->end - in->p < BAND_HEAD)
        return fail_band(in, film, y, "the end of the file", err);
    packed = take_u32(in->p);
    checksum = take_u32(in->p + 4);
    in->p += BAND_HEAD;
    if ((size_t)(in->end - in->p) < packed)
        return fail_band(in, film, y, "the end of the file", err);
    if (crc32(0, in->p, packed) != checksum ||
        uncompress(b->planes, &unpacked, in->p, packed) != Z_OK ||
        unpacked != raw)
        return fail_band(in, film, y, "damaged bytes", err);
    in->p += packed;
    from_planes(b, pixels);
    return true;
}

static bool take_rows(struct input *in, struct film *film, struct error *err)
{
    size_t words = film_words_count(film->surfaces != NULL);
    size_t width = (size_t)film->width;
    int step = band_rows(film);
    struct band band = {0};
    bool ok = band_init(&band, width * (size_t)step, words) ||
              fail(err, "%s: out of memory", in->path);

    for (int y = 0; ok && y < film->height; y += step) {
        int end = y + step < film->height ? y + step : film->height;

        ok = take_band(in, film, y, &band, (size_t)(end - y) * width, err);
        for (int i = y; ok && i < end; i++)
            film_words_take(film, i,
                            band.pixels + (size_t)(i - y) * width * words);
    }
    band_free(&band);
    return ok;
}

static bool take_shares(struct input *in, struct film_file *f,
                        struct error *err)
{
    size_t pixels = (size_t)f->film.width * (size_t)f->film.height;
    size_t count = (pixels + 3) / 4;
    struct band band = {0};
    bool ok = band_init(&band, count, 1);

    f->shares = alloc_array(pixels, sizeof *f->shares);
    if (!ok || f->shares == NULL)
        ok = fail(err, "%s: out of memory", in->path);
    ok = ok && take_band(in, &f->film, f->film.height, &band, count, err);
    for (size_t i = 0; ok && i < pixels; i++)
        f->shares[i] = (uint16_t)(band.pixels[i / 4] >> i % 4 * 16);
    band_free(&band);
    return ok;
}

/* Returns the samples that a pixel has at the end of the last range. */
static uint64_t target_of(const struct film_file *f, size_t pixel)
{
    uint64_t spp = film_header_spp(&f->header);

    return f->shares != NULL ? share_samples(f->shares[pixel], spp) : spp;
}

/* Counts the samples, finds whether some are beyond the ranges, and checks that
 * none are missing. */
static bool check_counts(struct film_file *f, const char *path,
                         struct error *err)
{
    const struct film *film = &f->film;
    size_t width = (size_t)film->width;
    size_t pixels = width * (size_t)film->height;

    f->header.samples = 0;
    for (size_t i = 0; i < pixels; i++) {
        uint64_t least = target_of(f, i);

        if (film->counts[i] < least || film->counts[i] > FILM_SPP_MAX)
            return fail(err,
                        "%s: found %" PRIu64 " samples in pixel %zu,%zu, "
                        "expected at least %" PRIu64,
                        path, film->counts[i], i % width, i / width, least);
        f->is_within_pass = f->is_within_pass || film->counts[i] > least;
        f->header.samples += film->counts[i];
    }
    return true;
}

static void set_counters(struct film *film, const struct film_header *h)
{
    atomic_store(&film->samples, h->samples);
    atomic_store(&film->rays, h->rays);
    atomic_store(&film->non_finite, h->non_finite);
    atomic_store(&film->saturated, h->saturated);
    atomic_store(&film->cut_paths, h->cut_paths);
}

static bool take_film(struct input *in, struct film_file *f, struct error *err)
{
    const struct film_identity *id = &f->header.identity;

    if (!film_init(&f->film, id->width, id->height, err) ||
        (id->has_surfaces && !film_init_surfaces(&f->film, err)) ||
        !take_rows(in, &f->film, err))
        return false;
    f->film.first_sample = f->header.ranges[0].first;
    if (id->is_adaptive && in->p < in->end && !take_shares(in, f, err))
        return false;
    if (in->p < in->end)
        return fail_band(in, &f->film, f->film.height, "more bytes", err);
    if (!check_counts(f, in->path, err))
        return false;
    set_counters(&f->film, &f->header);
    return true;
}

bool film_file_parse(struct film_file *f, const char *path, const char *bytes,
                     size_t size_bytes, struct error *err)
{
    struct input in = {.path = path};
    size_t used = 0;

    *f = (struct film_file){0};
    if (!film_header_parse(&f->header, path, bytes, size_bytes, &used, err))
        return false;
    in.p = (const uint8_t *)bytes + used;
    in.end = (const uint8_t *)bytes + size_bytes;
    return take_film(&in, f, err);
}

bool film_file_read(struct film_file *f, const char *path, struct error *err)
{
    size_t size;
    char *bytes;
    bool ok;

    *f = (struct film_file){0};
    if (!file_read(path, &bytes, &size, err))
        return false;
    ok = film_file_parse(f, path, bytes, size, err);
    free(bytes);
    return ok;
}

/* ---- join ---- */

/* Fails for films whose samples are not those of their ranges alone. */
static bool check_whole(const struct film_file *f, const char *path,
                        struct error *err)
{
    if (f->header.identity.is_adaptive)
        return fail(err,
                    "%s: found adaptive samples, expected films without "
                    "--adaptive and -e",
                    path);
    if (f->is_within_pass)
        return fail(err,
                    "%s: found a film that was saved within a pass, expected "
                    "a finished one: --resume it first",
                    path);
    return true;
}

bool film_file_join(struct film_file *f, const char *path,
                    const struct film_file *more, const char *more_path,
                    struct error *err)
{
    if (!film_identity_check(&more->header.identity, more_path,
                             &f->header.identity, path, err) ||
        !check_whole(f, path, err) || !check_whole(more, more_path, err) ||
        !film_header_join(&f->header, path, &more->header, more_path, err))
        return false;
    film_merge(&f->film, 0, &more->film);
    f->film.first_sample = f->header.ranges[0].first;
    return true;
}

bool film_file_join_read(struct film_file *f, const char *path,
                         const char *more_path, struct error *err)
{
    struct film_file more;
    bool ok = film_file_read(&more, more_path, err) &&
              film_file_join(f, path, &more, more_path, err);

    film_file_free(&more);
    return ok;
}

void film_file_free(struct film_file *f)
{
    film_header_free(&f->header);
    film_free(&f->film);
    free(f->shares);
    *f = (struct film_file){0};
}
