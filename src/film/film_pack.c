// SPDX-License-Identifier: MIT
#include "film/film_pack.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* ---- words ---- */

#define SUM_WORDS     (1 + 2 * 6)
#define SURFACE_WORDS (2 * 14 + 10 / 2)

size_t film_words_count(bool has_surfaces)
{
    return SUM_WORDS + (has_surfaces ? SURFACE_WORDS : 0);
}

static uint64_t *put_sums(uint64_t *to, const struct sum *sums, int count)
{
    for (int i = 0; i < count; i++) {
        *to++ = sums[i].lo;
        *to++ = sums[i].hi;
    }
    return to;
}

static const uint64_t *take_sums(const uint64_t *from, struct sum *sums,
                                 int count)
{
    for (int i = 0; i < count; i++) {
        sums[i].lo = *from++;
        sums[i].hi = *from++;
    }
    return from;
}

/* The numbers of 32 bits of surface sums. */
struct surface_numbers {
    uint32_t n[10];
};

static struct surface_numbers numbers_of(const struct surface_sums *s)
{
    return (struct surface_numbers){{s->albedo[0], s->albedo[1], s->albedo[2],
                                     s->normal[0], s->normal[1], s->normal[2],
                                     s->albedo_square, s->count, s->hit_count,
                                     s->seen_count}};
}

static void set_numbers(struct surface_sums *s, const uint32_t n[10])
{
    for (int c = 0; c < 3; c++) {
        s->albedo[c] = n[c];
        s->normal[c] = n[3 + c];
    }
    s->albedo_square = n[6];
    s->count = n[7];
    s->hit_count = n[8];
    s->seen_count = n[9];
}

static void put_surfaces(uint64_t *to, const struct surface_sums *s)
{
    struct surface_numbers numbers = numbers_of(s);

    to = put_sums(to, s->direct, 3);
    to = put_sums(to, s->odd_direct, 3);
    to = put_sums(to, s->seen, 3);
    to = put_sums(to, s->odd_seen, 3);
    to = put_sums(to, &s->depth, 1);
    to = put_sums(to, &s->depth_square, 1);
    for (int i = 0; i < 10; i += 2)
        *to++ = numbers.n[i] | (uint64_t)numbers.n[i + 1] << 32;
}

static void take_surfaces(const uint64_t *from, struct surface_sums *s)
{
    uint32_t n[10];

    from = take_sums(from, s->direct, 3);
    from = take_sums(from, s->odd_direct, 3);
    from = take_sums(from, s->seen, 3);
    from = take_sums(from, s->odd_seen, 3);
    from = take_sums(from, &s->depth, 1);
    from = take_sums(from, &s->depth_square, 1);
    for (int i = 0; i < 10; i += 2, from++) {
        n[i] = (uint32_t)*from;
        n[i + 1] = (uint32_t)(*from >> 32);
    }
    set_numbers(s, n);
}

void film_words_put(struct film *f, int y, uint64_t *to)
{
    size_t words = film_words_count(f->surfaces != NULL);
    size_t at = (size_t)y * (size_t)f->width;

    memset(to, 0, (size_t)f->width * words * sizeof *to);
    film_lock_row(f, y);
    for (int x = 0; x < f->width; x++, at++, to += words) {
        uint64_t *sums = to;

        *sums++ = f->counts[at];
        if (f->counts[at] == 0)
            continue;
        sums = put_sums(sums, f->sums + 3 * at, 3);
        sums = put_sums(sums, f->odd_sums + 3 * at, 3);
        if (f->surfaces != NULL)
            put_surfaces(sums, &f->surfaces[at]);
    }
    film_unlock_row(f, y);
}

void film_words_take(struct film *f, int y, const uint64_t *from)
{
    size_t words = film_words_count(f->surfaces != NULL);
    size_t at = (size_t)y * (size_t)f->width;

    f->has_row[y] = true;
    for (int x = 0; x < f->width; x++, at++, from += words) {
        const uint64_t *sums = from;

        f->counts[at] = *sums++;
        sums = take_sums(sums, f->sums + 3 * at, 3);
        sums = take_sums(sums, f->odd_sums + 3 * at, 3);
        if (f->surfaces != NULL)
            take_surfaces(sums, &f->surfaces[at]);
    }
}

/* ---- messages ---- */

/* Bytes before those of a word: the number of low bytes that are left out, and
 * that of the bytes that are there. */
#define WORD_HEAD 2

/* Bytes behind the last row. Words are stored and read with all their bytes,
 * of which those that are left out belong to the next word. */
#define SLACK 8

/* Packs a word of `count` pixels, which have `stride` words. Returns the end.
 */
static uint8_t *pack_word(uint8_t *to, const uint64_t *words, size_t stride,
                          size_t count)
{
    uint64_t bits = 0;
    int low = 0, high = 0;

    for (size_t i = 0; i < count; i++)
        bits |= words[i * stride];
    if (bits != 0) {
        low = __builtin_ctzll(bits) / 8;
        high = 8 - __builtin_clzll(bits) / 8;
    }
    *to++ = (uint8_t)low;
    *to++ = (uint8_t)(high - low);
    for (size_t i = 0; i < count && bits != 0; i++, to += high - low) {
        uint64_t word = words[i * stride] >> 8 * low;

        memcpy(to, &word, sizeof word);
    }
    return to;
}

uint8_t *film_pack(struct film *film, size_t head, size_t *size)
{
    size_t words = film_words_count(film->surfaces != NULL);
    size_t width = (size_t)film->width;
    size_t row_most = words * (WORD_HEAD + width * sizeof(uint64_t));
    uint64_t *row = alloc_aligned(width * words, sizeof *row);
    uint8_t *bytes =
        alloc_array(head + (size_t)film->height * row_most + SLACK, 1);
    uint8_t *to;

    if (row == NULL || bytes == NULL) {
        free(row);
        free(bytes);
        return NULL;
    }
    to = bytes + head;
    for (int y = 0; y < film->height; y++) {
        film_words_put(film, y, row);
        for (size_t w = 0; w < words; w++)
            to = pack_word(to, row + w, words, width);
    }
    free(row);
    *size = (size_t)(to - bytes) + SLACK;
    return bytes;
}

/* Reads a word of 1 to 8 bytes, the lowest first. */
static uint64_t read_word(const uint8_t *p, size_t width)
{
    uint64_t word;

    memcpy(&word, p, sizeof word);
    return word & UINT64_MAX >> (64 - 8 * width);
}

/* Unpacks a word of `count` pixels. Returns its end, or NULL. */
static const uint8_t *unpack_word(uint64_t *words, size_t stride, size_t count,
                                  const uint8_t *p, const uint8_t *end)
{
    size_t low, width;

    if (end - p < WORD_HEAD + SLACK)
        return NULL;
    low = p[0];
    width = p[1];
    p += WORD_HEAD;
    if (low + width > sizeof *words ||
        (size_t)(end - SLACK - p) / count < width)
        return NULL;
    for (size_t i = 0; i < count; i++, p += width)
        words[i * stride] = width > 0 ? read_word(p, width) << 8 * low : 0;
    return p;
}

bool film_unpack_row(struct film *row, const uint8_t **p, const uint8_t *end,
                     struct error *err)
{
    size_t words = film_words_count(row->surfaces != NULL);
    size_t width = (size_t)row->width;
    uint64_t *pixels = alloc_aligned(width * words, sizeof *pixels);
    const uint8_t *from = *p;

    if (pixels == NULL)
        return fail(err, "out of memory for a row of the film");
    for (size_t w = 0; w < words && from != NULL; w++)
        from = unpack_word(pixels + w, words, width, from, end);
    if (from != NULL)
        film_words_take(row, 0, pixels);
    free(pixels);
    *p = from;
    return from != NULL || fail(err, "found damaged rows of a film");
}
