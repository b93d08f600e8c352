// SPDX-License-Identifier: MIT
#include "render/cluster/band.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

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
