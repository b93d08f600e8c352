// SPDX-License-Identifier: MIT
#include "film/film_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text_stream.h"
#include "film/film.h"
#include "kernels/vec.h"

/* ---- head ---- */

/* First line: the format and its version. */
static const char magic[] = "glim film 1\n";

/* Start of the last line, before a checksum. */
#define DATA "data "

/* Lines are shorter than this. */
#define LINE_MAX_BYTES 2304

/* Largest side of a picture. */
#define SIDE_MAX 65536

enum field_kind { FIELD_TEXT, FIELD_NUMBER, FIELD_INT, FIELD_WORD, FIELD_HASH };

struct field {
    const char *name;
    enum field_kind kind;
    size_t member;
    uint64_t max; /* of numbers; size of texts */
    /* of identities: the option, or the words for what was hashed */
    const char *says;
};

#define HEAD(member) offsetof(struct film_header, member)

static const struct field fields[] = {
    {"version", FIELD_TEXT, HEAD(version), 32, NULL},
    {"scene", FIELD_TEXT, HEAD(scene), 256, NULL},
    {"view", FIELD_TEXT, HEAD(view), FILM_VIEW_BYTES, NULL},
    {"picture-width", FIELD_INT, HEAD(identity.picture_width), SIDE_MAX, "-w"},
    {"picture-height", FIELD_INT, HEAD(identity.picture_height), SIDE_MAX,
     "-h"},
    {"x", FIELD_INT, HEAD(identity.x), SIDE_MAX, "--crop"},
    {"y", FIELD_INT, HEAD(identity.y), SIDE_MAX, "--crop"},
    {"width", FIELD_INT, HEAD(identity.width), SIDE_MAX, "--crop"},
    {"height", FIELD_INT, HEAD(identity.height), SIDE_MAX, "--crop"},
    {"seed", FIELD_WORD, HEAD(identity.seed), UINT32_MAX, "--seed"},
    {"surfaces", FIELD_INT, HEAD(identity.has_surfaces), 1, "--denoise"},
    {"adaptive", FIELD_INT, HEAD(identity.is_adaptive), 1,
     "--adaptive or --no-adaptive"},
    {"exposure-bits", FIELD_WORD, HEAD(identity.exposure_bits), UINT32_MAX,
     "exposure of the view file"},
    {"tone", FIELD_WORD, HEAD(tone), TONE_ACES, NULL},
    {"kernels", FIELD_HASH, HEAD(identity.hashes[FILM_KERNELS]), UINT64_MAX,
     "version of glim"},
    {"geometry", FIELD_HASH, HEAD(identity.hashes[FILM_GEOMETRY]), UINT64_MAX,
     "geometry"},
    {"materials", FIELD_HASH, HEAD(identity.hashes[FILM_MATERIALS]), UINT64_MAX,
     "set of materials"},
    {"textures", FIELD_HASH, HEAD(identity.hashes[FILM_TEXTURES]), UINT64_MAX,
     "set of textures"},
    {"light", FIELD_HASH, HEAD(identity.hashes[FILM_LIGHT]), UINT64_MAX,
     "light"},
    {"camera", FIELD_HASH, HEAD(identity.hashes[FILM_CAMERA]), UINT64_MAX,
     "camera"},
    {"limits", FIELD_HASH, HEAD(identity.hashes[FILM_LIMITS]), UINT64_MAX,
     "limit of bounces (-d) or --gi"},
    {"guide", FIELD_HASH, HEAD(identity.hashes[FILM_GUIDE]), UINT64_MAX,
     "path guide"},
    {"total", FIELD_NUMBER, HEAD(total), FILM_SPP_MAX, NULL},
    {"render-ns", FIELD_NUMBER, HEAD(render_ns), UINT64_MAX, NULL},
    {"samples", FIELD_NUMBER, HEAD(samples), UINT64_MAX, NULL},
    {"rays", FIELD_NUMBER, HEAD(rays), UINT64_MAX, NULL},
    {"non-finite", FIELD_NUMBER, HEAD(non_finite), UINT64_MAX, NULL},
    {"saturated", FIELD_NUMBER, HEAD(saturated), UINT64_MAX, NULL},
    {"cut-paths", FIELD_NUMBER, HEAD(cut_paths), UINT64_MAX, NULL},
    {"ranges", FIELD_NUMBER, HEAD(range_count), SIDE_MAX, NULL},
};

#define FIELD_COUNT (sizeof fields / sizeof fields[0])

/* ---- text ---- */

static void *member_of(const struct film_header *h, const struct field *f)
{
    return (char *)(uintptr_t)h + f->member;
}

static uint64_t number_of(const struct film_header *h, const struct field *f)
{
    const void *m = member_of(h, f);

    switch (f->kind) {
    case FIELD_INT: return (uint64_t) * (const int *)m;
    case FIELD_WORD: return *(const uint32_t *)m;
    default: return *(const uint64_t *)m;
    }
}

/* A line has no control characters. */
static void put_text(FILE *to, const char *text)
{
    for (; *text != '\0'; text++)
        putc((unsigned char)*text < ' ' || *text == 0x7f ? '?' : *text, to);
}

static void put_field(FILE *to, const struct film_header *h,
                      const struct field *f)
{
    fprintf(to, "%s ", f->name);
    if (f->kind == FIELD_TEXT)
        put_text(to, member_of(h, f));
    else if (f->kind == FIELD_HASH)
        fprintf(to, "%016" PRIx64, number_of(h, f));
    else
        fprintf(to, "%" PRIu64, number_of(h, f));
    putc('\n', to);
}

static uint64_t checksum_of(const char *text, size_t size_bytes)
{
    return hash_bytes(HASH_BEGIN, text, size_bytes) & 0xffffffffu;
}

char *film_header_text(const struct film_header *h, size_t *size_bytes)
{
    struct text_stream s;

    if (text_stream_open(&s)) {
        fputs(magic, s.to);
        for (size_t i = 0; i < FIELD_COUNT; i++)
            put_field(s.to, h, &fields[i]);
        for (size_t i = 0; i < h->range_count; i++)
            fprintf(s.to, "range %" PRIu64 " %" PRIu64 "\n", h->ranges[i].first,
                    h->ranges[i].end);
        if (fflush(s.to) == 0)
            fprintf(s.to, DATA "%08" PRIx64 "\n",
                    checksum_of(s.text, s.size_bytes));
    }
    return text_stream_close(&s, size_bytes);
}

/* ---- parser ---- */

struct reader {
    const char *path, *p, *end;
    int line;
    char text[LINE_MAX_BYTES]; /* the current line */
};

static bool next_line(struct reader *r)
{
    const char *nl = memchr(r->p, '\n', (size_t)(r->end - r->p));

    r->line++;
    if (nl == NULL || nl - r->p >= LINE_MAX_BYTES ||
        memchr(r->p, '\0', (size_t)(nl - r->p)) != NULL)
        return false;
    memcpy(r->text, r->p, (size_t)(nl - r->p));
    r->text[nl - r->p] = '\0';
    r->p = nl + 1;
    return true;
}

static bool fail_line(const struct reader *r, const char *name,
                      struct error *err)
{
    return fail(err, "%s:%d: found '%.60s', expected %s of a film", r->path,
                r->line, r->text, name);
}

static void set_number(struct film_header *h, const struct field *f,
                       uint64_t number)
{
    void *m = member_of(h, f);

    switch (f->kind) {
    case FIELD_INT: *(int *)m = (int)number; break;
    case FIELD_WORD: *(uint32_t *)m = (uint32_t)number; break;
    default: *(uint64_t *)m = number; break;
    }
}

static bool read_field(struct reader *r, struct film_header *h,
                       const struct field *f, struct error *err)
{
    size_t length = strlen(f->name);
    uint64_t number = 0;
    const char *p;

    r->text[0] = '\0';
    if (!next_line(r) || strncmp(r->text, f->name, length) != 0 ||
        r->text[length] != ' ')
        return fail_line(r, f->name, err);
    p = r->text + length + 1;
    if (f->kind == FIELD_TEXT) {
        if (strlen(p) >= f->max)
            return fail_line(r, f->name, err);
        memcpy(member_of(h, f), p, strlen(p) + 1);
        return true;
    }
    if (!digits_parse(&p, f->kind == FIELD_HASH ? 16 : 10, f->max, &number) ||
        *p != '\0')
        return fail_line(r, f->name, err);
    set_number(h, f, number);
    return true;
}

static bool read_range(struct reader *r, struct film_range *range,
                       uint64_t after, struct error *err)
{
    static const char name[] = "range ";
    const char *p = r->text + sizeof name - 1;

    r->text[0] = '\0';
    if (!next_line(r) || strncmp(r->text, name, sizeof name - 1) != 0 ||
        !digits_parse(&p, 10, FILM_SPP_MAX, &range->first) || *p++ != ' ' ||
        !digits_parse(&p, 10, FILM_SPP_MAX, &range->end) || *p != '\0' ||
        range->first < after || range->first % 2 != 0 ||
        range->end < range->first)
        return fail_line(r, "the next range", err);
    return true;
}

static bool read_ranges(struct reader *r, struct film_header *h,
                        struct error *err)
{
    size_t count = h->range_count;

    h->range_count = 0;
    h->ranges = alloc_array(count + 1, sizeof *h->ranges);
    if (h->ranges == NULL)
        return fail(err, "%s: out of memory", r->path);
    for (; h->range_count < count; h->range_count++) {
        uint64_t after =
            h->range_count == 0 ? 0 : h->ranges[h->range_count - 1].end + 1;

        if (!read_range(r, &h->ranges[h->range_count], after, err))
            return false;
    }
    if (count == 0)
        return fail_line(r, "a range", err);
    return true;
}

/* Checks numbers that belong together. */
static bool check_size(const struct reader *r, const struct film_identity *id,
                       struct error *err)
{
    if (id->width < 1 || id->height < 1 ||
        id->x + id->width > id->picture_width ||
        id->y + id->height > id->picture_height)
        return fail(err,
                    "%s: found %dx%d pixels at %d,%d, expected a part of a "
                    "picture of %dx%d",
                    r->path, id->width, id->height, id->x, id->y,
                    id->picture_width, id->picture_height);
    return true;
}

/* Reads the last line, with the checksum of those before it. */
static bool check_text(struct reader *r, const char *bytes, size_t *used,
                       struct error *err)
{
    uint64_t expected = checksum_of(bytes, *used), found = 0;
    const char *p = r->text + sizeof DATA - 1;

    r->text[0] = '\0';
    if (!next_line(r) || strncmp(r->text, DATA, sizeof DATA - 1) != 0 ||
        strpbrk(p, "ABCDEF") != NULL || /* as none is written */
        !digits_parse(&p, 16, UINT32_MAX, &found) || *p != '\0')
        return fail_line(r, "the checksum", err);
    *used = (size_t)(r->p - bytes);
    return found == expected ||
           fail(err,
                "%s:%d: found checksum %08" PRIx64 ", expected %08" PRIx64
                ": the lines above are damaged",
                r->path, r->line, found, expected);
}

static bool check_exposure(const struct reader *r, const struct film_header *h,
                           struct error *err)
{
    float stops = bits_float(h->identity.exposure_bits);

    return fabsf(stops) <= EXPOSURE_MAX ||
           fail(err, "%s: found an exposure of %g, expected -%d to %d", r->path,
                (double)stops, EXPOSURE_MAX, EXPOSURE_MAX);
}

bool film_header_parse(struct film_header *h, const char *path,
                       const char *bytes, size_t size_bytes, size_t *used,
                       struct error *err)
{
    struct reader r = {.path = path, .p = bytes, .end = bytes + size_bytes};

    *h = (struct film_header){0};
    if (!next_line(&r) || strncmp(r.text, magic, sizeof magic - 2) != 0 ||
        r.text[sizeof magic - 2] != '\0') {
        if (strncmp(r.text, magic, 10) == 0)
            return fail(err, "%s: found '%.20s', expected '%.*s'", path, r.text,
                        (int)sizeof magic - 2, magic);
        return fail(err, "%s: found another kind of file, expected a film",
                    path);
    }
    for (size_t i = 0; i < FIELD_COUNT; i++)
        if (!read_field(&r, h, &fields[i], err)) {
            h->range_count = 0;
            return false;
        }
    if (!check_size(&r, &h->identity, err) || !read_ranges(&r, h, err))
        return false;
    *used = (size_t)(r.p - bytes);
    return check_text(&r, bytes, used, err) && check_exposure(&r, h, err);
}

/* ---- identity ---- */

const char *film_part_name(enum film_part part)
{
    const struct field *f = fields;

    while (f->member != HEAD(identity.hashes[part]))
        f++;
    return f->name;
}

/* Returns true for the fields that decide the bits of samples. */
static bool is_of_identity(const struct field *f,
                           const struct film_identity *id)
{
    if (f->member == HEAD(identity.exposure_bits) && !id->is_adaptive)
        return false;
    return f->member < sizeof *id && f->kind != FIELD_TEXT;
}

bool film_identity_check(const struct film_identity *found, const char *path,
                         const struct film_identity *expected,
                         const char *other, struct error *err)
{
    const struct film_header a = {.identity = *found};
    const struct film_header b = {.identity = *expected};

    for (size_t i = 0; i < FIELD_COUNT; i++) {
        const struct field *f = &fields[i];
        uint64_t x, y;

        if (!is_of_identity(f, expected))
            continue;
        x = number_of(&a, f);
        y = number_of(&b, f);
        if (x == y)
            continue;
        if (f->kind == FIELD_HASH)
            return fail(err,
                        "%s: found samples of another %s, expected that of %s",
                        path, f->says, other);
        return fail(err,
                    "%s: found %s %" PRIu64 ", expected %" PRIu64
                    " as of %s (%s)",
                    path, f->name, x, y, other, f->says);
    }
    return true;
}

/* ---- ranges ---- */

uint64_t film_header_spp(const struct film_header *h)
{
    uint64_t spp = 0;

    for (size_t i = 0; i < h->range_count; i++)
        spp += h->ranges[i].end - h->ranges[i].first;
    return spp;
}

static int compare_ranges(const void *a, const void *b)
{
    const struct film_range *x = a, *y = b;

    return x->first < y->first ? -1 : x->first > y->first;
}

/* Sorts the ranges and joins those that touch. Returns the index of the first
 * range that begins within the one before, or 0. */
static size_t tidy(struct film_header *h)
{
    size_t count = 1;

    qsort(h->ranges, h->range_count, sizeof *h->ranges, compare_ranges);
    for (size_t i = 1; i < h->range_count; i++)
        if (h->ranges[i].first < h->ranges[i - 1].end)
            return i;
    for (size_t i = 1; i < h->range_count; i++) {
        if (h->ranges[i].first == h->ranges[count - 1].end)
            h->ranges[count - 1].end = h->ranges[i].end;
        else
            h->ranges[count++] = h->ranges[i];
    }
    h->range_count = count;
    return 0;
}

bool film_header_join(struct film_header *h, const char *path,
                      const struct film_header *more, const char *more_path,
                      struct error *err)
{
    size_t count = h->range_count + more->range_count;
    struct film_range *all = alloc_array(count + 1, sizeof *all);
    size_t at;

    if (all == NULL)
        return fail(err, "%s: out of memory", more_path);
    memcpy(all, h->ranges, h->range_count * sizeof *all);
    memcpy(all + h->range_count, more->ranges, more->range_count * sizeof *all);
    free(h->ranges);
    h->ranges = all;
    h->range_count = count;
    at = tidy(h);
    if (at != 0)
        return fail(err,
                    "%s: found samples from %" PRIu64 " on, expected those "
                    "that %s does not have",
                    more_path, all[at].first, path);
    if (h->total < more->total)
        h->total = more->total;
    h->render_ns += more->render_ns;
    h->samples += more->samples;
    h->rays += more->rays;
    h->non_finite += more->non_finite;
    h->saturated += more->saturated;
    h->cut_paths += more->cut_paths;
    return true;
}

bool film_header_gap(const struct film_header *h, uint64_t *at,
                     struct film_range *gap)
{
    for (size_t i = 0; i <= h->range_count; i++) {
        uint64_t next = i < h->range_count ? h->ranges[i].first : h->total;

        if (next > *at) {
            *gap = (struct film_range){*at, next};
            *at = i < h->range_count ? h->ranges[i].end : next;
            return true;
        }
        if (i < h->range_count && h->ranges[i].end > *at)
            *at = h->ranges[i].end;
    }
    return false;
}

void film_header_free(struct film_header *h)
{
    free(h->ranges);
    *h = (struct film_header){0};
}

/* ---- bands ---- */

#define ZLIB_CONST
#include <zlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "film/film_pack.h"

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
