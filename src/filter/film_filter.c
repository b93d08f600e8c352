// SPDX-License-Identifier: MIT
#include "filter/film_filter.h"

#include <stdlib.h>

#include "base/memory.h"
#include "filter/film_features.h"
#include "filter/filter.h"

struct source {
    struct film *film;
    float far; /* greatest depth, which rays that leave the scene have */
};

static size_t row_index(const struct film *f, int y)
{
    return (size_t)y * (size_t)f->width;
}

bool film_filter_applies(struct film *f)
{
    bool applies = f->surfaces != NULL;

    for (int y = 0; applies && y < f->height; y++) {
        film_lock_row(f, y);
        for (int x = 0; x < f->width && applies; x++) {
            size_t at = row_index(f, y) + (size_t)x;

            applies = f->counts[at] >= 2 && f->surfaces[at].count > 0;
        }
        film_unlock_row(f, y);
    }
    return applies;
}

static void give_features(void *context, int y, const struct filter_row *to)
{
    const struct source *s = context;
    struct film *f = s->film;

    film_features(f, s->far, y, to);
    film_lock_row(f, y);
    for (int x = 0; x < f->width; x++) {
        size_t at = row_index(f, y) + (size_t)x;

        to->count[0][x] = (float)film_even_count(f->counts[at]);
        to->count[1][x] = (float)film_odd_count(f->counts[at]);
    }
    film_unlock_row(f, y);
}

/* Writes the mean of each half of a pixel: of direct light that is not seen for
 * component 0, of indirect light for component 1. */
static void put_light(const struct film *f, size_t at, int component, int x,
                      float *to[2][3])
{
    const struct surface_sums *surface = &f->surfaces[at];
    float even_count = (float)film_even_count(f->counts[at]);
    float odd_count = (float)film_odd_count(f->counts[at]);

    for (int c = 0; c < 3; c++) {
        struct sum all = surface->direct[c], odd = surface->odd_direct[c];

        if (component == 0) {
            all = sum_without(all, surface->seen[c]);
            odd = sum_without(odd, surface->odd_seen[c]);
        } else {
            all = sum_without(f->sums[3 * at + (size_t)c], all);
            odd = sum_without(f->odd_sums[3 * at + (size_t)c], odd);
        }
        to[0][c][x] = sum_float(sum_without(all, odd)) / even_count;
        to[1][c][x] = sum_float(odd) / odd_count;
    }
}

static void give_light(void *context, int component, int y, float *to[2][3])
{
    const struct source *s = context;
    struct film *f = s->film;

    film_lock_row(f, y);
    for (int x = 0; x < f->width; x++)
        put_light(f, row_index(f, y) + (size_t)x, component, x, to);
    film_unlock_row(f, y);
}

/* Adds seen light to a row of the filtered rest. It keeps its noise at edges: a
 * lamp of a pixel would spread to its neighbours. */
static void add_seen(struct film *f, int y, float *rgb)
{
    film_lock_row(f, y);
    for (int x = 0; x < f->width; x++) {
        size_t at = row_index(f, y) + (size_t)x;

        for (int c = 0; c < 3; c++)
            rgb[3 * x + c] +=
                sum_float(f->surfaces[at].seen[c]) / (float)f->counts[at];
    }
    film_unlock_row(f, y);
}

static void store_row(struct film *to, int y, const float *rgb)
{
    static const int one = 1;

    for (int x = 0; x < to->width; x++, rgb += 3) {
        struct path_sample sample = {{rgb[0], rgb[1], rgb[2]}, 0, 0};

        film_add_row(to, x, y, 1, 1, &sample, NULL, &one);
    }
}

bool film_filter(struct film *f, struct pool *pool, struct film *filtered,
                 struct error *err)
{
    struct source context = {f, film_features_far(f, 1)};
    const struct filter_source source = {&context, 2, give_features,
                                         give_light};
    float *rgb =
        alloc_array((size_t)f->width * (size_t)f->height, 3 * sizeof *rgb);
    struct filter filter;
    bool ok = rgb != NULL
                  ? filter_init(&filter, f->width, f->height, err)
                  : fail(err, "out of memory for filtering %dx%d pixels",
                         f->width, f->height);

    if (ok) {
        filter_run(&filter, &source, FILTER_LEVELS, pool, rgb);
        filter_free(&filter);
        for (int y = 0; y < f->height; y++) {
            add_seen(f, y, rgb + 3 * row_index(f, y));
            store_row(filtered, y, rgb + 3 * row_index(f, y));
        }
    }
    free(rgb);
    return ok;
}

bool film_filter_copy(struct film *f, int thread_count, struct film *filtered,
                      struct error *err)
{
    struct pool *pool;
    bool ok;

    *filtered = (struct film){.width = 0};
    pool = pool_create(thread_count, err);
    ok = pool != NULL && film_init(filtered, f->width, f->height, err) &&
         film_filter(f, pool, filtered, err);
    pool_destroy(pool);
    if (!ok)
        film_free(filtered);
    return ok;
}
