// SPDX-License-Identifier: MIT
#include "film/adaptive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#include "kernels/sample_share.h"

/* Least share over SHARE_ONE. */
#define LEAST 0.125

static bool error_squares(struct film_squares *s, struct pool *pool,
                          const struct cancel *cancel, struct error *err)
{
    (void)err;
    film_error_squares(s, pool, cancel);
    return true;
}

const struct adaptive_measure adaptive_film = {error_squares, 6, 2.5};

bool adaptive_init(struct adaptive *a, int width, int height, struct error *err)
{
    *a = (struct adaptive){.measure = &adaptive_film,
                           .width = width,
                           .height = height};
    a->shares = alloc_array((size_t)width * (size_t)height, sizeof *a->shares);
    return a->shares != NULL ||
           fail(err, "out of memory for adaptive sampling of %dx%d pixels",
                width, height);
}

void adaptive_free(struct adaptive *a)
{
    free(a->shares);
    *a = (struct adaptive){0};
}

void adaptive_reset(struct adaptive *a)
{
    a->is_decided = false;
}

/* Numbers of the decision, for each pixel. */
struct plan {
    const struct adaptive_measure *measure;
    struct film *film;
    float exposure;
    int width, height;
    int colour;     /* of the demands; deviations have the other one */
    float *demands; /* numbers to which the shares are in proportion; before,
                       squares of relative errors and their roots */
    float *sums;    /* of deviations in the row, weighted */
};

/* Part of the window around a place that is within a line of pixels: the
 * distances from `first` to `last`. */
struct window {
    int first, last;
};

static struct window window_at(int place, int length, int reach)
{
    int after = length - 1 - place;

    return (struct window){place < reach ? -place : -reach,
                           after < reach ? after : reach};
}

/* Returns the weight of a deviation at a distance in rows or in columns.
 * Weights that fall blur edges less than equal ones. */
static float weight_at(int distance, int reach)
{
    return (float)(reach + 1 - abs(distance));
}

/* Replaces the squares of a row by their roots, and sums these. Roots are
 * disturbed less by a rare bright sample than the root of a sum of squares. */
static void sum_row(void *context, uint32_t y, int worker)
{
    const struct plan *p = context;
    float *deviations = p->demands + (size_t)y * (size_t)p->width;
    float *sums = p->sums + (size_t)y * (size_t)p->width;
    int reach = p->measure->reach;

    (void)worker;
    for (int x = 0; x < p->width; x++)
        deviations[x] = sqrtf(deviations[x]);
    for (int x = 0; x < p->width; x++) {
        struct window w = window_at(x, p->width, reach);

        sums[x] = 0.0f;
        for (int i = w.first; i <= w.last; i++)
            sums[x] += weight_at(i, reach) * deviations[x + i];
    }
}

/* Sums the weights of a window; those of odd distances times `sign`. */
static float sum_weights(struct window w, int reach, float sign)
{
    float sum = 0.0f;

    for (int i = w.first; i <= w.last; i++)
        sum += (i & 1) != 0 ? sign * weight_at(i, reach) : weight_at(i, reach);
    return sum;
}

/* Sums the weights of the pixels of the other colour: half the difference
 * between the sum of all and that with a minus for the other colour. */
static float sum_other_weights(struct window rows, struct window columns,
                               int reach)
{
    float all =
        sum_weights(rows, reach, 1.0f) * sum_weights(columns, reach, 1.0f);
    float signed_sum =
        sum_weights(rows, reach, -1.0f) * sum_weights(columns, reach, -1.0f);

    return 0.5f * (all - signed_sum);
}

/* Returns the deviation to the power of 5/8. The power of 1 is best for exact
 * deviations of independent samples. But samples are stratified, so that more
 * of them bring less; and deviations are noisy, so that the highest are too
 * high. Powers from 1/2 to 1 were measured. */
static float demand_of(float deviation)
{
    return sqrtf(deviation * sqrtf(sqrtf(deviation)));
}

/* Finds the demands of a row, from the sums of the rows around. */
static void find_row(void *context, uint32_t row, int worker)
{
    const struct plan *p = context;
    int y = (int)row;
    size_t width = (size_t)p->width;
    int reach = p->measure->reach;
    struct window rows = window_at(y, p->height, reach);

    (void)worker;
    for (int x = (y + p->colour) & 1; x < p->width; x += 2) {
        struct window columns = window_at(x, p->width, reach);
        float sum = 0.0f;

        for (int i = rows.first; i <= rows.last; i++)
            sum += weight_at(i, reach) *
                   p->sums[(size_t)(y + i) * width + (size_t)x];
        p->demands[(size_t)y * width + (size_t)x] =
            demand_of(sum / sum_other_weights(rows, columns, reach));
    }
}

/* Finds the demands of the pixels of the plan's colour. *is_known is false
 * after a cancel, and if a pixel lacks samples. */
static bool find_demands(struct plan *p, struct pool *pool,
                         const struct cancel *cancel, bool *is_known,
                         struct error *err)
{
    struct film_squares s = {p->film, p->exposure, 1 - p->colour, p->demands,
                             false};

    if (!p->measure->squares(&s, pool, cancel, err))
        return false;
    *is_known = s.is_known;
    if (!*is_known)
        return true;
    pool_each(pool, (uint32_t)p->height, sum_row, p);
    pool_each(pool, (uint32_t)p->height, find_row, p);
    return true;
}

/* Demands of the pixels of a colour, sorted into bins of nearly equal ones.
 * A bin is the upper bits of a float: 32 for each power of two. */
#define BIN_BITS 18
#define BINS     (0x80000000u >> BIN_BITS)

struct histogram {
    double counts[BINS], sums[BINS];
    double count;
};

static void count_demands(struct histogram *h, const struct plan *p)
{
    memset(h, 0, sizeof *h);
    for (int y = 0; y < p->height; y++)
        for (int x = (y + p->colour) & 1; x < p->width; x += 2) {
            float d = p->demands[(size_t)y * (size_t)p->width + (size_t)x];
            uint32_t bin = float_bits(d) >> BIN_BITS;

            h->counts[bin]++;
            h->sums[bin] += (double)d;
            h->count++;
        }
}

/* Returns the share of a pixel over SHARE_ONE. */
static double share_of(double demand, double factor, double least, double most)
{
    return fmin(fmax(demand * factor, least), most);
}

static double mean_share(const struct histogram *h, double factor, double least,
                         double most)
{
    double sum = 0;

    for (uint32_t i = 0; i < BINS; i++)
        if (h->counts[i] > 0)
            sum += h->counts[i] *
                   share_of(h->sums[i] / h->counts[i], factor, least, most);
    return sum / h->count;
}

/* Finds the factor of demands and the least share with which the mean of the
 * shares is SHARE_ONE. */
static void find_factor(const struct histogram *h, double most, double *factor,
                        double *least)
{
    double low = 0x1p-100, high = 0x1p100;
    double mean = mean_share(h, high, LEAST, most);

    *factor = high;
    *least = LEAST;
    if (mean < 1) { /* few pixels have an error: the others share the rest */
        double few = (mean - LEAST) / (most - LEAST);

        *least = (1 - most * few) / (1 - few);
        return;
    }
    for (int i = 0; i < 50; i++) {
        *factor = sqrt(low * high);
        if (mean_share(h, *factor, LEAST, most) <= 1)
            low = *factor;
        else
            high = *factor;
    }
}

/* Sets the shares of the pixels of the plan's colour; h is for its use. */
static void set_shares(struct adaptive *a, const struct plan *p,
                       struct histogram *h)
{
    double factor, least, most = p->measure->most;

    count_demands(h, p);
    find_factor(h, most, &factor, &least);
    for (int y = 0; y < a->height; y++)
        for (int x = (y + p->colour) & 1; x < a->width; x += 2) {
            size_t at = (size_t)y * (size_t)a->width + (size_t)x;
            double share =
                share_of((double)p->demands[at], factor, least, most);

            a->shares[at] = (uint16_t)lrint(share * SHARE_ONE);
        }
}

static bool plan_init(struct plan *p, const struct adaptive *a,
                      struct film *film, float exposure)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;

    *p = (struct plan){
        .measure = a->measure,
        .film = film,
        .exposure = exposure,
        .width = a->width,
        .height = a->height,
        .demands = alloc_array(pixels, sizeof *p->demands),
        .sums = alloc_array(pixels, sizeof *p->sums),
    };
    return p->demands != NULL && p->sums != NULL;
}

static void plan_free(struct plan *p)
{
    free(p->demands);
    free(p->sums);
}

bool adaptive_decide(struct adaptive *a, struct film *film, float exposure,
                     struct pool *pool, const struct cancel *cancel,
                     struct error *err)
{
    struct histogram *h = NULL;
    struct plan p = {0};
    bool ok;

    if (a->is_decided)
        return true;
    h = alloc_array(1, sizeof *h);
    ok = plan_init(&p, a, film, exposure) && h != NULL;
    if (!ok)
        fail(err, "out of memory for adaptive sampling of %dx%d pixels",
             a->width, a->height);
    a->is_decided = ok;
    for (p.colour = 0; p.colour < 2 && a->is_decided; p.colour++) {
        ok = find_demands(&p, pool, cancel, &a->is_decided, err);
        a->is_decided = a->is_decided && ok;
        if (a->is_decided)
            set_shares(a, &p, h);
    }
    plan_free(&p);
    free(h);
    return ok;
}
