// SPDX-License-Identifier: MIT
#include "render/cluster/band_answer.h"

#include <stdio.h>

#include "base/memory.h"
#include "film/film_merge.h"
#include "film/film_pack.h"

struct band_answer *band_answer_make(struct band *b, uint32_t epoch,
                                     const char *error, size_t *size)
{
    struct film *f = &b->film;
    uint64_t samples = atomic_load(&f->samples);
    struct band_answer *a;

    *size = sizeof *a;
    a = samples > 0 ? (struct band_answer *)film_pack(f, sizeof *a, size)
                    : alloc_array(1, sizeof *a);
    if (a == NULL)
        return NULL;
    *a = (struct band_answer){.epoch = epoch,
                              .has_failed = error[0] != '\0',
                              .y = b->range.y,
                              .rows = b->range.rows,
                              .first = b->range.first,
                              .samples = samples,
                              .rays = atomic_load(&f->rays),
                              .non_finite = atomic_load(&f->non_finite),
                              .saturated = atomic_load(&f->saturated),
                              .cut_paths = atomic_load(&f->cut_paths)};
    snprintf(a->error, sizeof a->error, "%.255s", error);
    return a;
}

static void set_counters(struct film *f, const struct band_answer *a)
{
    atomic_store(&f->samples, a->samples);
    atomic_store(&f->rays, a->rays);
    atomic_store(&f->non_finite, a->non_finite);
    atomic_store(&f->saturated, a->saturated);
    atomic_store(&f->cut_paths, a->cut_paths);
}

bool band_answer_add(const struct band_answer *a, size_t size,
                     struct film *film, struct error *err)
{
    const uint8_t *from = (const uint8_t *)(a + 1);
    const uint8_t *end = (const uint8_t *)a + size;
    struct film row = {0};
    bool ok = film_init(&row, film->width, 1, err) &&
              (film->surfaces == NULL || film_init_surfaces(&row, err));

    if (ok) /* with the first row */
        set_counters(&row, a);
    for (int y = a->y; ok && y < a->y + a->rows; y++) {
        ok = film_unpack_row(&row, &from, end, err);
        if (ok)
            film_merge(film, y, &row);
        set_counters(&row, &(struct band_answer){0});
    }
    film_free(&row);
    return ok;
}
