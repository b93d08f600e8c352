// SPDX-License-Identifier: MIT
#include "picture/film_header.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/hash.h"
#include "base/memory.h"
#include "picture/film.h"

#include "kernels/vec.h"

/* First line: the format and its version. */
static const char magic[] = "glim film 1\n";

/* Start of the last line, before a checksum. */
#define DATA "data "

/* Lines are shorter than this. */
#define LINE_MAX_BYTES 512

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
     "limit of bounces (-d)"},
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
    char *text = NULL;
    FILE *to = open_memstream(&text, size_bytes);

    if (to == NULL)
        return NULL;
    fputs(magic, to);
    for (size_t i = 0; i < FIELD_COUNT; i++)
        put_field(to, h, &fields[i]);
    for (size_t i = 0; i < h->range_count; i++)
        fprintf(to, "range %" PRIu64 " %" PRIu64 "\n", h->ranges[i].first,
                h->ranges[i].end);
    /* a stream in memory fails without memory, and only then */
    if (fflush(to) == 0)
        fprintf(to, DATA "%08" PRIx64 "\n", checksum_of(text, *size_bytes));
    if (ferror(to) == 0 && fclose(to) == 0)
        return text;
    free(text);
    return NULL;
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
