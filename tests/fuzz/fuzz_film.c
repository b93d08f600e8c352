// SPDX-License-Identifier: MIT
/*
 * Films: what is read is written and read again, with the same sums, and joined
 * with itself, which fails, since both have the same samples. A film of any
 * sums makes a finite picture.
 */
#include <math.h>

#include "base/hash.h"
#include "film/film_error.h"
#include "film/film_file.h"
#include "fuzz.h"

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

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    try_file(data, size);
    try_sums(data, size);
    return 0;
}
