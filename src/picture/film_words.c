// SPDX-License-Identifier: MIT
#include "picture/film_words.h"

#include <string.h>

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
