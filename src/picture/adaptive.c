// SPDX-License-Identifier: MIT
#include "picture/adaptive.h"

#include <math.h>
#include <stdlib.h>

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
    float *squares;    /* of relative errors, of one colour */
    float *deviations; /* roots of their means, of the other colour */
    float *line;       /* a row or a column */
};

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Replaces `count` numbers, `step` floats apart, by the sums of those within
 * REACH. */
static void sum_line(float *x, int count, size_t step, float *line)
{
    for (int i = 0; i < count; i++)
        line[i] = x[(size_t)i * step];
    for (int i = 0; i < count; i++) {
        int last = smaller(i + REACH, count - 1);
        float sum = 0.0f;

        for (int j = larger(i - REACH, 0); j <= last; j++)
            sum += line[j];
        x[(size_t)i * step] = sum;
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

/* Finds the deviations of pixels of the other colour. Returns false if a pixel
 * lacks samples. */
static bool find_deviations(struct plan *p, struct film *film, float exposure,
                            struct pool *pool, int colour)
{
    size_t width = (size_t)p->width;

    if (!film_error_squares(film, exposure, colour, pool, p->squares))
        return false;
    for (int y = 0; y < p->height; y++)
        sum_line(p->squares + (size_t)y * width, p->width, 1, p->line);
    for (size_t x = 0; x < width; x++)
        sum_line(p->squares + x, p->height, width, p->line);
    for (int y = 0; y < p->height; y++)
        for (int x = (y + colour + 1) & 1; x < p->width; x += 2) {
            size_t at = (size_t)y * width + (size_t)x;

            p->deviations[at] = sqrtf(p->squares[at] / count_around(p, x, y));
        }
    return true;
}

/* Sets the shares of pixels of a colour to these multiples of the deviations,
 * but at least to `least`. Returns their mean over SHARE_ONE. */
static double set_shares(struct adaptive *a, const struct plan *p, int colour,
                         double factor, double least)
{
    double sum = 0, count = 0;

    for (int y = 0; y < a->height; y++)
        for (int x = (y + colour) & 1; x < a->width; x += 2, count++) {
            size_t at = (size_t)y * (size_t)a->width + (size_t)x;
            double share = fmax((double)p->deviations[at] * factor, least);

            share = fmin(share * SHARE_ONE, SHARE_MOST);
            a->shares[at] = (uint16_t)lrint(share);
            sum += a->shares[at];
        }
    return sum / (count * SHARE_ONE);
}

/* Chooses the shares of a colour, whose mean is SHARE_ONE. */
static void choose_shares(struct adaptive *a, const struct plan *p, int colour)
{
    const double most = (double)SHARE_MOST / SHARE_ONE;
    double low = 0x1p-100, high = 0x1p100; /* of the factor */
    double mean = set_shares(a, p, colour, high, LEAST);

    if (mean < 1) { /* few pixels have an error: the others share the rest */
        double few = (mean - LEAST) / (most - LEAST);

        set_shares(a, p, colour, high, (1 - most * few) / (1 - few));
        return;
    }
    for (int i = 0; i < 40; i++) {
        double middle = sqrt(low * high);

        if (set_shares(a, p, colour, middle, LEAST) <= 1)
            low = middle;
        else
            high = middle;
    }
    set_shares(a, p, colour, low, LEAST);
}

static bool plan_init(struct plan *p, const struct adaptive *a)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;

    *p = (struct plan){
        .width = a->width,
        .height = a->height,
        .squares = alloc_array(pixels, sizeof *p->squares),
        .deviations = alloc_array(pixels, sizeof *p->deviations),
        .line =
            alloc_array((size_t)larger(a->width, a->height), sizeof *p->line),
    };
    return p->squares != NULL && p->deviations != NULL && p->line != NULL;
}

static void plan_free(struct plan *p)
{
    free(p->squares);
    free(p->deviations);
    free(p->line);
}

/* Returns false if a pixel lacks samples. */
static bool decide(struct adaptive *a, struct plan *p, struct film *film,
                   float exposure, struct pool *pool)
{
    for (int colour = 0; colour < 2; colour++) {
        if (!find_deviations(p, film, exposure, pool, 1 - colour))
            return false;
        choose_shares(a, p, colour);
    }
    return true;
}

bool adaptive_decide(struct adaptive *a, struct film *film, float exposure,
                     struct pool *pool, struct error *err)
{
    struct plan p;
    bool has_memory;

    if (a->is_decided)
        return true;
    has_memory = plan_init(&p, a);
    a->is_decided = has_memory && decide(a, &p, film, exposure, pool);
    plan_free(&p);
    return has_memory ||
           fail(err, "out of memory for adaptive sampling of %dx%d pixels",
                a->width, a->height);
}
