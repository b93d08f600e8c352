// SPDX-License-Identifier: MIT
#include "cluster/band.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

bool band_init(struct band *b, int width, int y, int rows, bool has_surfaces,
               const struct pass *pass, struct error *err)
{
    size_t pixels = (size_t)width * (size_t)rows;

    *b = (struct band){.y = y, .pass = *pass};
    if (!film_init(&b->film, width, rows, err) ||
        (has_surfaces && !film_init_surfaces(&b->film, err)))
        return false;
    b->before = alloc_array(pixels, sizeof *b->before);
    if (pass->shares != NULL)
        b->shares = alloc_array(pixels, sizeof *b->shares);
    b->pass.shares = b->shares;
    return (b->before != NULL &&
            (pass->shares != NULL) == (b->shares != NULL)) ||
           fail(err, "out of memory for %d rows of the picture", rows);
}

void band_take(struct band *b, const struct film *film, const struct pass *pass)
{
    size_t at = (size_t)b->y * (size_t)film->width;
    size_t pixels = (size_t)film->width * (size_t)b->film.height;

    memcpy(b->before, film->counts + at, pixels * sizeof *b->before);
    if (b->shares != NULL)
        memcpy(b->shares, pass->shares + at, pixels * sizeof *b->shares);
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
    if (!backend->begin(backend, host, world, f, x0, y0 + b->y, err))
        return PASS_FAILED;
    result = backend->pass(backend, &b->pass, cancel, err);
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
    *b = (struct band){.y = 0};
}
