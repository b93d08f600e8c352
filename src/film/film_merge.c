// SPDX-License-Identifier: MIT
#include "film/film_merge.h"

#include <string.h>

/* Returns false if a sum is too large for both. */
static bool join_sums(struct sum *to, const struct sum *from, int count)
{
    bool has_room = true;

    for (int i = 0; i < count; i++)
        has_room &= sum_join(&to[i], from[i]);
    return has_room;
}

static void join_numbers(uint32_t *to, const uint32_t *from, int count)
{
    for (int i = 0; i < count; i++)
        to[i] += from[i];
}

static void join_surfaces(struct surface_sums *to,
                          const struct surface_sums *from)
{
    join_sums(to->direct, from->direct, 3);
    join_sums(to->odd_direct, from->odd_direct, 3);
    join_sums(to->seen, from->seen, 3);
    join_sums(to->odd_seen, from->odd_seen, 3);
    join_sums(&to->depth, &from->depth, 1);
    join_sums(&to->depth_square, &from->depth_square, 1);
    join_numbers(to->albedo, from->albedo, 3);
    join_numbers(to->normal, from->normal, 3);
    join_numbers(&to->albedo_square, &from->albedo_square, 1);
    join_numbers(&to->count, &from->count, 1);
    join_numbers(&to->hit_count, &from->hit_count, 1);
    join_numbers(&to->seen_count, &from->seen_count, 1);
}

static void clear_pixel(struct film *f, size_t at)
{
    memset(f->sums + 3 * at, 0, 3 * sizeof *f->sums);
    memset(f->odd_sums + 3 * at, 0, 3 * sizeof *f->odd_sums);
    if (f->surfaces != NULL)
        surface_clear(&f->surfaces[at]);
}

/* Returns the number of pixels whose sums are too large together. */
static uint64_t merge_row(struct film *f, size_t to, const struct film *part,
                          size_t from)
{
    uint64_t full = 0;

    for (int x = 0; x < f->width; x++, to++, from++) {
        if (part->counts[from] == 0)
            continue;
        if (f->counts[to] == 0)
            clear_pixel(f, to);
        full += !join_sums(f->sums + 3 * to, part->sums + 3 * from, 3);
        join_sums(f->odd_sums + 3 * to, part->odd_sums + 3 * from, 3);
        if (f->surfaces != NULL)
            join_surfaces(&f->surfaces[to], &part->surfaces[from]);
        f->counts[to] += part->counts[from];
    }
    return full;
}

void film_merge(struct film *f, int y, const struct film *part)
{
    size_t width = (size_t)f->width;
    uint64_t full = atomic_load(&part->saturated);

    for (int i = 0; i < part->height; i++) {
        film_lock_row(f, y + i);
        f->has_row[y + i] = true;
        full += merge_row(f, (size_t)(y + i) * width, part, (size_t)i * width);
        film_unlock_row(f, y + i);
    }
    atomic_fetch_add(&f->samples, atomic_load(&part->samples));
    atomic_fetch_add(&f->rays, atomic_load(&part->rays));
    atomic_fetch_add(&f->non_finite, atomic_load(&part->non_finite));
    atomic_fetch_add(&f->saturated, full);
    atomic_fetch_add(&f->cut_paths, atomic_load(&part->cut_paths));
}
