// SPDX-License-Identifier: MIT
/*
 * Films: what is read is written and read again, with the same sums, and joined
 * with itself, which fails, since both have the same samples. A film of any
 * sums makes a finite picture.
 */
#include <math.h>

#include <zlib.h>

#include "base/hash.h"
#include "film/film_error.h"
#include "film/film_file.h"
#include "film/film_pack.h"
#include "fuzz.h"
#include "mutate.h"

static void check_picture(struct film *film)
{
    size_t count = 3 * (size_t)film->width * (size_t)film->height;
    float *rgb = calloc(count, sizeof *rgb);

    require(rgb != NULL, "memory");
    film_linear(film, rgb);
    for (size_t i = 0; i < count; i++)
        require(isfinite(rgb[i]) && rgb[i] >= 0, "a mean");
    free(rgb);
}

static const uint16_t *lend(void *shares)
{
    return shares;
}

/* A pixel without samples has undefined sums in a film, and 0 in a file. */
static void check_same(const struct film *a, const struct film *b)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;

    require(a->width == b->width && a->height == b->height, "the size");
    for (size_t i = 0; i < pixels; i++) {
        require(a->counts[i] == b->counts[i], "a count");
        if (a->counts[i] == 0)
            continue;
        require(memcmp(a->sums + 3 * i, b->sums + 3 * i, 3 * sizeof *a->sums) ==
                    0,
                "sums");
    }
}

static void check_film(struct film_file *f)
{
    struct film_file back;
    struct film_error e;
    struct error err = {""};
    size_t written;
    char *bytes;

    check_picture(&f->film);
    for (int exposure = -100; exposure <= 100; exposure += 100) {
        require(film_error(&f->film, (float)exposure, NULL, NULL, &e, &err),
                err.text);
        require(!e.is_known || (e.low >= 0 && e.low <= e.error &&
                                e.error <= e.high && isfinite(e.high)),
                "the error");
    }
    bytes =
        film_file_bytes(&f->header, &f->film, lend, f->shares, &written, &err);
    require(bytes != NULL, err.text);
    require(film_file_parse(&back, "b.film", bytes, written, &err), err.text);
    check_same(&f->film, &back.film);
    if (film_header_spp(&f->header) > 0)
        require(!film_file_join(f, "a.film", &back, "b.film", &err),
                "the same samples");
    film_file_free(&back);
    free(bytes);
}

/* Writes the right checksum behind the first lines, so that changed lines are
 * parsed to their end. */
static void mend_checksum(char *bytes, size_t size)
{
    static const char data[] = "\ndata ";
    char *at = memmem(bytes, size, data, sizeof data - 1);
    char digits[17];

    if (at == NULL || bytes + size - at < (ptrdiff_t)sizeof data + 7)
        return;
    snprintf(digits, sizeof digits, "%08x",
             (unsigned)hash_bytes(HASH_BEGIN, bytes, (size_t)(at + 1 - bytes)));
    memcpy(at + sizeof data - 1, digits, 8);
}

/* Parses the input as a file. */
static void try_file(const uint8_t *data, size_t size)
{
    char *bytes = malloc(size + 1);
    struct film_file f;
    struct error err = {""};

    require(bytes != NULL, "memory");
    memcpy(bytes, data, size);
    mend_checksum(bytes, size);
    if (film_file_parse(&f, "a.film", bytes, size, &err))
        check_film(&f);
    else
        fuzz_check_message(err.text);
    film_file_free(&f);
    free(bytes);
}

/* Takes the input as the sums of a small film. */
static void try_sums(const uint8_t *data, size_t size)
{
    struct film_range range = {0, size > 0 ? data[0] : 0};
    struct film_header h = {.identity = {.picture_width = 3,
                                         .picture_height = 2,
                                         .width = 3,
                                         .height = 2,
                                         .has_surfaces = 1},
                            .ranges = &range,
                            .range_count = 1};
    struct film_file f;
    struct film film;
    struct error err = {""};
    size_t written, part = size / 4;
    char *bytes;

    require(film_init(&film, 3, 2, &err), err.text);
    require(film_init_surfaces(&film, &err), err.text);
#define TAKE(array, i, count)                      \
    memcpy(array, data + (i)*part,                 \
           part < (count) * sizeof *(array) ? part \
                                            : (count) * sizeof *(array))
    TAKE(film.counts, 0, 6);
    TAKE(film.sums, 1, 18);
    TAKE(film.odd_sums, 2, 18);
    TAKE(film.surfaces, 3, 6);
    bytes = film_file_bytes(&h, &film, NULL, NULL, &written, &err);
    require(bytes != NULL, err.text);
    if (film_file_parse(&f, "a.film", bytes, written, &err))
        check_film(&f);
    else
        fuzz_check_message(err.text);
    film_file_free(&f);
    film_free(&film);
    free(bytes);
}

/* Takes the input as packed rows, as processes of a cluster send them. */
static void try_rows(const uint8_t *data, size_t size)
{
    const uint8_t *p = data;
    struct film row;
    struct error err = {""};

    require(film_init(&row, 3, 1, &err), err.text);
    require(size % 2 == 0 || film_init_surfaces(&row, &err), err.text);
    for (int i = 0; i < 4; i++) {
        if (!film_unpack_row(&row, &p, data + size, &err)) {
            fuzz_check_message(err.text);
            break;
        }
        check_picture(&row);
    }
    film_free(&row);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    try_file(data, size);
    try_sums(data, size);
    try_rows(data, size);
    return 0;
}

/* Bytes before a packed band: its size and its checksum. */
#define BAND_HEAD 8

/* Changes a band of pixels behind zlib, and sets its size and checksum. */
static void mutate_band(struct mutation *m, size_t at)
{
    static uint8_t planes[1 << 16], packed[1 << 17];
    size_t length = (size_t)mutation_get(m, at, 4);
    uLongf count = sizeof planes, bytes = sizeof packed;

    if (at + BAND_HEAD > m->size || length > m->size - at - BAND_HEAD ||
        uncompress(planes, &count, m->data + at + BAND_HEAD, length) != Z_OK)
        return;
    mutation_fixed(m, planes, count);
    require(compress(packed, &bytes, planes, count) == Z_OK, "packed");
    if (!mutation_replace(m, at + BAND_HEAD, length, packed, bytes))
        return;
    mutation_put(m, at, 4, bytes);
    mutation_put(m, at + 4, 4, crc32(0, packed, (uInt)bytes));
}

/* Changes the lines, whose checksum mend_checksum() sets, or a band. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed)
{
    static const char last[] = "\ndata ";
    struct mutation m = mutation_begin(data, size, max, seed);
    uint8_t *end = memmem(data, size, last, sizeof last - 1);
    size_t at = end != NULL ? (size_t)(end - data) + 15 : size;
    size_t kind = mutation_pick(&m, 4), next;

    if (at >= size || kind == 0)
        return LLVMFuzzerMutate(data, size, max);
    if (kind == 1) {
        mutation_text(&m, 0, at - 15);
        return m.size;
    }
    next = at + BAND_HEAD + (size_t)mutation_get(&m, at, 4);
    mutate_band(&m, kind == 2 || next >= size ? at : next);
    return m.size;
}
