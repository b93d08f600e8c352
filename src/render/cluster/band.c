// SPDX-License-Identifier: MIT
#include "render/cluster/band.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "film/film.h"
#include "film/film_pack.h"

/* ---- bands ---- */

bool band_init(struct band *b, int width, const struct band_range *range,
               bool has_surfaces, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)range->rows;
    bool has_shares = range->pass.shares != NULL;

    *b = (struct band){.range = *range};
    if (!film_init(&b->film, width, range->rows, err) ||
        (has_surfaces && !film_init_surfaces(&b->film, err)))
        return false;
    b->before = alloc_array(pixels, sizeof *b->before);
    if (has_shares)
        b->shares = alloc_array(pixels, sizeof *b->shares);
    b->range.pass.shares = b->shares;
    return (b->before != NULL && has_shares == (b->shares != NULL)) ||
           fail(err, "out of memory for %d rows of the picture", range->rows);
}

void band_take(struct band *b, const struct film *film,
               const struct band_range *range)
{
    size_t at = (size_t)range->y * (size_t)film->width;
    size_t pixels = (size_t)film->width * (size_t)range->rows;

    for (size_t i = 0; i < pixels; i++)
        b->before[i] = band_plan_before(film, range, at + i);
    if (b->shares != NULL)
        memcpy(b->shares, range->pass.shares + at, pixels * sizeof *b->shares);
}

/* Renders the pass of a band in shorter ones if it is too long for a backend.
 */
static enum pass_result render_passes(const struct band *b,
                                      struct backend *backend,
                                      const struct cancel *cancel,
                                      struct error *err)
{
    const struct pass *whole = &b->range.pass;
    uint64_t left = pass_mean(whole);
    enum pass_result result;

    do {
        uint64_t mean = left < PASS_MEAN_MAX ? left : PASS_MEAN_MAX;
        struct pass pass = pass_with(*whole, whole->target - left + mean, mean);

        result = backend->pass(backend, &pass, cancel, err);
        left -= mean;
    } while (left > 0 && result == PASS_DONE);
    return result;
}

enum pass_result band_render(struct band *b, struct backend *backend,
                             const struct host_world *host,
                             const struct world *world, int x0, int y0,
                             uint64_t first_sample, const struct cancel *cancel,
                             struct error *err)
{
    struct film *f = &b->film;
    size_t pixels = (size_t)f->width * (size_t)f->height;
    enum pass_result result;

    /* the backend goes on from these numbers of samples with sums of 0; their
     * total makes the film one that has samples */
    f->first_sample = first_sample;
    for (size_t i = 0; i < pixels; i++) {
        f->counts[i] = b->before[i];
        atomic_fetch_add(&f->samples, b->before[i]);
    }
    if (!backend->begin(backend, host, world, f, x0, y0 + b->range.y, err))
        return PASS_FAILED;
    result = render_passes(b, backend, cancel, err);
    for (size_t i = 0; i < pixels; i++) {
        f->counts[i] -= b->before[i];
        atomic_fetch_sub(&f->samples, b->before[i]);
    }
    return result;
}

void band_free(struct band *b)
{
    film_free(&b->film);
    free(b->before);
    free(b->shares);
    *b = (struct band){0};
}

/* ---- answers ---- */

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
