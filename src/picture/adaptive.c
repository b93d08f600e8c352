// SPDX-License-Identifier: MIT
#include "picture/adaptive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "picture/film_error.h"

#include "kernels/sample_share.h"

/* Pixels around a pixel, in each direction, whose errors it takes. Fewer are
 * too noisy for scenes with rare bright light, more blur edges. */
#define REACH 6

/* Least share over SHARE_ONE. */
#define LEAST 0.125

bool adaptive_init(struct adaptive *a, int width, int height, struct error *err)
{
    *a = (struct adaptive){.width = width, .height = height};
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
    int width, height;
    int colour;        /* of the deviations; the squares have the other one */
    float *squares;    /* of relative errors; their sums along rows */
    float *deviations; /* roots of their means */
};

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Replaces the squares of a row by the sums of those within REACH. */
static void sum_row(void *context, uint32_t y, int worker)
{
    const struct plan *p = context;
    float *row = p->squares + (size_t)y * (size_t)p->width;
    float before[REACH] = {0}; /* old values of the pixels before */

    (void)worker;
    for (int i = 0; i < p->width; i++) {
        int last = smaller(i + REACH, p->width - 1);
        float sum = 0.0f;

        for (int j = 0; j < REACH; j++)
            sum += before[j];
        for (int j = i; j <= last; j++)
            sum += row[j];
        before[i % REACH] = row[i];
        row[i] = sum;
    }
}

/* Returns the number of pixels of the other colour within REACH of a pixel. */
static float count_around(const struct plan *p, int x, int y)
{
    int x0 = larger(x - REACH, 0), x1 = smaller(x + REACH, p->width - 1);
    int y0 = larger(y - REACH, 0), y1 = smaller(y + REACH, p->height - 1);
    int all = (x1 - x0 + 1) * (y1 - y0 + 1);
    bool is_corner_other = ((x0 ^ y0 ^ x ^ y) & 1) != 0;

    return (float)(is_corner_other ? (all + 1) / 2 : all / 2);
}

/* Finds the deviations of a row, from the sums of the rows around. */
static void find_row(void *context, uint32_t row, int worker)
{
    const struct plan *p = context;
    int y = (int)row;
    int y0 = larger(y - REACH, 0), y1 = smaller(y + REACH, p->height - 1);
    size_t width = (size_t)p->width;

    (void)worker;
    for (int x = (y + p->colour) & 1; x < p->width; x += 2) {
        float sum = 0.0f;

        for (int j = y0; j <= y1; j++)
            sum += p->squares[(size_t)j * width + (size_t)x];
        p->deviations[(size_t)y * width + (size_t)x] =
            sqrtf(sum / count_around(p, x, y));
    }
}

/* Finds the deviations of the pixels of the plan's colour. Returns false after
 * a cancel, or if a pixel lacks samples. */
static bool find_deviations(struct plan *p, struct film *film, float exposure,
                            struct pool *pool, const struct cancel *cancel)
{
    if (!film_error_squares(film, exposure, 1 - p->colour, pool, cancel,
                            p->squares))
        return false;
    pool_each(pool, (uint32_t)p->height, sum_row, p);
    pool_each(pool, (uint32_t)p->height, find_row, p);
    return true;
}

/* Deviations of the pixels of a colour, sorted into bins of nearly equal ones.
 * A bin is the upper bits of a float: 32 for each power of two. */
#define BIN_BITS 18
#define BINS     (0x80000000u >> BIN_BITS)

struct histogram {
    double counts[BINS], sums[BINS];
    double count;
};

static void count_deviations(struct histogram *h, const struct plan *p)
{
    memset(h, 0, sizeof *h);
    for (int y = 0; y < p->height; y++)
        for (int x = (y + p->colour) & 1; x < p->width; x += 2) {
            float d = p->deviations[(size_t)y * (size_t)p->width + (size_t)x];
            uint32_t bin = float_bits(d) >> BIN_BITS;

            h->counts[bin]++;
            h->sums[bin] += (double)d;
            h->count++;
        }
}

/* Returns the share of a pixel over SHARE_ONE. */
static double share_of(double deviation, double factor, double least)
{
    return fmin(fmax(deviation * factor, least), SHARE_MOST / SHARE_ONE);
}

static double mean_share(const struct histogram *h, double factor, double least)
{
    double sum = 0;

    for (uint32_t i = 0; i < BINS; i++)
        if (h->counts[i] > 0)
            sum += h->counts[i] *
                   share_of(h->sums[i] / h->counts[i], factor, least);
    return sum / h->count;
}

/* Finds the factor of deviations and the least share with which the mean of the
 * shares is SHARE_ONE. */
static void find_factor(const struct histogram *h, double *factor,
                        double *least)
{
    const double most = SHARE_MOST / SHARE_ONE;
    double low = 0x1p-100, high = 0x1p100;
    double mean = mean_share(h, high, LEAST);

    *factor = high;
    *least = LEAST;
    if (mean < 1) { /* few pixels have an error: the others share the rest */
        double few = (mean - LEAST) / (most - LEAST);

        *least = (1 - most * few) / (1 - few);
        return;
    }
    for (int i = 0; i < 50; i++) {
        *factor = sqrt(low * high);
        if (mean_share(h, *factor, LEAST) <= 1)
            low = *factor;
        else
            high = *factor;
    }
}

/* Sets the shares of the pixels of the plan's colour; h is for its use. */
static void set_shares(struct adaptive *a, const struct plan *p,
                       struct histogram *h)
{
    double factor, least;

    count_deviations(h, p);
    find_factor(h, &factor, &least);
    for (int y = 0; y < a->height; y++)
        for (int x = (y + p->colour) & 1; x < a->width; x += 2) {
            size_t at = (size_t)y * (size_t)a->width + (size_t)x;
            double share = share_of((double)p->deviations[at], factor, least);

            a->shares[at] = (uint16_t)lrint(share * SHARE_ONE);
        }
}

static bool plan_init(struct plan *p, const struct adaptive *a)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;

    *p = (struct plan){
        .width = a->width,
        .height = a->height,
        .squares = alloc_array(pixels, sizeof *p->squares),
        .deviations = alloc_array(pixels, sizeof *p->deviations),
    };
    return p->squares != NULL && p->deviations != NULL;
}

static void plan_free(struct plan *p)
{
    free(p->squares);
    free(p->deviations);
}

bool adaptive_decide(struct adaptive *a, struct film *film, float exposure,
                     struct pool *pool, const struct cancel *cancel,
                     struct error *err)
{
    struct histogram *h = NULL;
    struct plan p = {0};
    bool has_memory;

    if (a->is_decided)
        return true;
    h = alloc_array(1, sizeof *h);
    has_memory = plan_init(&p, a) && h != NULL;
    a->is_decided = has_memory;
    for (p.colour = 0; p.colour < 2 && a->is_decided; p.colour++) {
        a->is_decided = find_deviations(&p, film, exposure, pool, cancel);
        if (a->is_decided)
            set_shares(a, &p, h);
    }
    plan_free(&p);
    free(h);
    return has_memory ||
           fail(err, "out of memory for adaptive sampling of %dx%d pixels",
                a->width, a->height);
}
