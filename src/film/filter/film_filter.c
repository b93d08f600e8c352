// SPDX-License-Identifier: MIT
#include "film/filter/film_filter.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "film/filter/filter.h"

/* ---- features ---- */

/* Depth of a film without surfaces. */
#define DEPTH_ANY 1.0f

/* Prefetch distance in pixels. Features are in no cache. */
#define AHEAD 16

float film_features_far(struct film *f, int stride)
{
    float far = 0.0f;

    for (int y = 0; y < f->height; y += stride) {
        film_lock_row(f, y);
        for (int x = 0; x < f->width; x += stride) {
            const struct surface_sums *s =
                &f->surfaces[(size_t)y * (size_t)f->width + (size_t)x];

            if (s->hit_count > 0)
                far = f_max(sum_float(s->depth) / (float)s->hit_count, far);
        }
        film_unlock_row(f, y);
    }
    return far > 0.0f ? far : DEPTH_ANY;
}

/* Returns the variance of the mean of 1 / inverse samples from the sum of their
 * squares and the square of their mean. */
static float mean_variance(float squares, float mean_square, float inverse)
{
    return f_max(squares * inverse - mean_square, 0.0f) * inverse;
}

/* Writes the features of a pixel. Rays that leave the scene have an albedo of
 * 1, no normal, and the greatest depth. */
static void put_features(const struct surface_sums *s, float far, int x,
                         const struct filter_row *to)
{
    float inverse = 1.0f / (float)s->count, hits = (float)s->hit_count;
    float misses = (float)(s->count - s->hit_count);
    float albedo_square = 0.0f, normal_square = 0.0f, depth;

    for (int c = 0; c < 3; c++) {
        float albedo =
            ((float)s->albedo[c] * (1.0f / SURFACE_ONE) + misses) * inverse;
        float normal =
            ((float)s->normal[c] * (2.0f / SURFACE_ONE) - hits) * inverse;

        to->albedo[c][x] = albedo;
        to->normal[c][x] = normal;
        albedo_square += albedo * albedo;
        normal_square += normal * normal;
    }
    depth = (sum_float(s->depth) + misses * far) * inverse;
    to->depth[x] = depth;
    to->albedo_noise[x] =
        mean_variance((float)s->albedo_square * (3.0f / SURFACE_ONE) +
                          3.0f * misses,
                      albedo_square, inverse);
    to->normal_noise[x] = mean_variance(hits, normal_square, inverse);
    to->depth_noise[x] =
        mean_variance(sum_float(s->depth_square) + misses * far * far,
                      depth * depth, inverse);
}

void film_features(struct film *f, float far, int y,
                   struct film_columns columns, const struct filter_row *to)
{
    const struct surface_sums *s =
        f->surfaces + (size_t)y * (size_t)f->width + columns.first;

    film_lock_row(f, y);
    for (int x = 0; x < columns.count; x++, s += columns.step) {
        if (x + AHEAD < columns.count) {
            __builtin_prefetch(&s[AHEAD * columns.step].depth);
            __builtin_prefetch(&s[AHEAD * columns.step].count);
        }
        put_features(s, far, x, to);
    }
    film_unlock_row(f, y);
}

/* ---- filter ---- */

struct source {
    struct film *film;
    float far;  /* greatest depth, which rays that leave the scene have */
    int colour; /* of a chess board, whose other pixels are left out; or ALL */
};

/* Instead of a colour of a chess board: the pixels of both. */
#define ALL (-1)

/* Returns the pixels of a row of the film that are a row of the source. Those
 * of one colour move together; a last one that not each row has is left out. */
static struct film_columns columns_of(const struct source *s, int y)
{
    if (s->colour == ALL)
        return (struct film_columns){0, 1, s->film->width};
    return (struct film_columns){(y + s->colour) & 1, 2, s->film->width / 2};
}

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
    struct film_columns columns = columns_of(s, y);
    struct film *f = s->film;
    size_t at = row_index(f, y) + (size_t)columns.first;

    film_features(f, s->far, y, columns, to);
    film_lock_row(f, y);
    for (int x = 0; x < columns.count; x++, at += (size_t)columns.step) {
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
    struct film_columns columns = columns_of(s, y);
    struct film *f = s->film;
    size_t at = row_index(f, y) + (size_t)columns.first;

    film_lock_row(f, y);
    for (int x = 0; x < columns.count; x++, at += (size_t)columns.step)
        put_light(f, at, component, x, to);
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

/* Pixels that are stored at once. */
#define STORED 64

/* A filtered picture on its way to a film. */
struct result {
    struct film *film, *to;
    float *rgb;
};

static void store_row(void *context, uint32_t item, int worker)
{
    const struct result *r = context;
    int y = (int)item, width = r->film->width;
    float *rgb = r->rgb + 3 * row_index(r->film, y);
    struct path_sample samples[STORED];
    int ones[STORED];

    (void)worker;
    add_seen(r->film, y, rgb);
    for (int x = 0; x < width; x += STORED) {
        int count = width - x < STORED ? width - x : STORED;

        for (int i = 0; i < count; i++, rgb += 3) {
            samples[i] = (struct path_sample){{rgb[0], rgb[1], rgb[2]}, 0, 0};
            ones[i] = 1;
        }
        film_add_row(r->to, (struct film_pixels){x, y, 1, count}, samples, NULL,
                     ones);
    }
}

bool film_filter(struct film *f, struct pool *pool, struct film *filtered,
                 struct error *err)
{
    struct source context = {f, film_features_far(f, 1), ALL};
    const struct filter_source source = {&context, 2, give_features, give_light,
                                         NULL};
    float *rgb =
        alloc_array((size_t)f->width * (size_t)f->height, 3 * sizeof *rgb);
    struct filter filter;
    bool ok = rgb != NULL
                  ? filter_init(&filter, f->width, f->height, err)
                  : fail(err, "out of memory for filtering %dx%d pixels",
                         f->width, f->height);

    if (ok) {
        filter_run(&filter, &source, FILTER_FULL, pool,
                   &(struct filter_result){.rgb = rgb});
        filter_free(&filter);
        pool_each(pool, (uint32_t)f->height, store_row,
                  &(struct result){f, filtered, rgb});
    }
    free(rgb);
    return ok;
}

/* Pixels of one colour of a film, filtered. */
struct estimate {
    struct source source;
    float *rgb, *variance;
    float *squares; /* of all pixels of the film */
    float factor;   /* of the exposure */
};

/* Limit of squares that are added. */
#define LARGEST 1e34f

/* Returns a square of light, relative to white. */
static float white_square(const struct estimate *e, float square)
{
    return f_min(square * e->factor * e->factor, LARGEST);
}

/* Returns the squared relative error of pixel `at` of the film, from its
 * filtered light and its variance. Seen light, which is not filtered, has that
 * of its halves. */
static float relative_square(const struct estimate *e, size_t at,
                             const float *rgb, const float *variance)
{
    const struct film *f = e->source.film;
    const struct surface_sums *s = &f->surfaces[at];
    float even_count = (float)film_even_count(f->counts[at]);
    float odd_count = (float)film_odd_count(f->counts[at]);
    float sum = 0.0f;

    for (int c = 0; c < 3; c++) {
        float seen = sum_float(s->seen[c]), odd = sum_float(s->odd_seen[c]);
        float light = rgb[c] + seen / (even_count + odd_count);
        float difference = 0.5f * ((seen - odd) / even_count - odd / odd_count);

        sum += white_square(e, variance[c] + difference * difference) /
               (white_square(e, light * light) + FILM_ERROR_BLACK);
    }
    return sum * (1.0f / 3.0f);
}

static void estimate_row(void *context, uint32_t item, int worker)
{
    struct estimate *e = context;
    struct film *f = e->source.film;
    int y = (int)item;
    struct film_columns columns = columns_of(&e->source, y);
    size_t from = 3 * (size_t)y * (size_t)columns.count;
    size_t at = row_index(f, y) + (size_t)columns.first;

    (void)worker;
    memset(e->squares + row_index(f, y), 0,
           (size_t)f->width * sizeof *e->squares);
    film_lock_row(f, y);
    for (int x = 0; x < columns.count; x++, at += 2, from += 3)
        e->squares[at] =
            relative_square(e, at, e->rgb + from, e->variance + from);
    if (columns.first + 2 * columns.count < f->width)
        e->squares[at] = e->squares[at - 2];
    film_unlock_row(f, y);
}

bool film_filter_squares(struct film_squares *s, struct pool *pool,
                         const struct cancel *cancel, struct error *err)
{
    struct film *f = s->film;
    size_t floats = 3 * (size_t)(f->width / 2) * (size_t)f->height;
    struct estimate e = {.source = {f, film_features_far(f, 1), s->colour},
                         .rgb = alloc_array(floats, sizeof *e.rgb),
                         .variance = alloc_array(floats, sizeof *e.variance),
                         .squares = s->squares,
                         .factor = develop_factor(develop_linear(s->exposure))};
    const struct filter_source source = {&e.source, 2, give_features,
                                         give_light, cancel};
    struct filter filter;
    bool ok = e.rgb != NULL && e.variance != NULL
                  ? filter_init(&filter, f->width / 2, f->height, err)
                  : fail(err, "out of memory for the error of %dx%d pixels",
                         f->width, f->height);

    if (ok) {
        filter_run(&filter, &source, FILTER_FULL, pool,
                   &(struct filter_result){e.rgb, e.variance, NULL});
        filter_free(&filter);
        pool_each(pool, (uint32_t)f->height, estimate_row, &e);
        s->is_known = cancel == NULL || !cancel_requested(cancel);
    }
    free(e.rgb);
    free(e.variance);
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
