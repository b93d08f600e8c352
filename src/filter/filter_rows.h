// SPDX-License-Identifier: MIT
/*
 * filter_rows.h - loops over the pixels of a row that light and features have
 * in common: pairs of pixels, their weights, and averages with them
 *
 * src/filter/filter_loops.c includes it, once for each instruction set.
 *
 * Units:     as kernels/filter.h
 * Threads:   any, on tiles that differ
 */
#ifndef GLIM_FILTER_ROWS_H
#define GLIM_FILTER_ROWS_H

#include <stdbool.h>
#include <string.h>

#include "filter/filter_planes.h"

enum {
    WIDTH = FILTER_TILE_WIDTH,
    HEIGHT = FILTER_TILE_HEIGHT,
    PAIRS = FILTER_PAIRS,
    TAPS = 2 * PAIRS
};

/* Values of a tile's pixels, and of the rows above and below. */
typedef float tile_rows[HEIGHT + 2][WIDTH];

/* The other pixel of pair k, as seen from the first one. */
static const struct {
    int x, y;
    float tap;
} pairs[PAIRS] = {{1, 0, 0.125f},
                  {-1, 1, 0.0625f},
                  {0, 1, 0.125f},
                  {1, 1, 0.0625f}};

static ptrdiff_t index_of(const struct filter_planes *p, int x, int y)
{
    return y * p->pitch + x;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Pixels of a tile whose other pixels in a pair are in the picture, and the
 * distance of these in the planes. */
struct pair_tile {
    struct filter_tile at;
    ptrdiff_t away;
};

/* Returns those of pair k, with the pixels opposite to the others as well if
 * is_opposite. There may be none. */
static struct pair_tile pair_inside(const struct filter_planes *p,
                                    struct filter_tile at, int k, int step,
                                    bool is_opposite)
{
    int dx = pairs[k].x * step, dy = pairs[k].y * step;
    int before = is_opposite ? larger(dx, -dx) : larger(-dx, 0);
    int after = is_opposite ? before : larger(dx, 0);
    int left = larger(at.x, before), top = larger(at.y, is_opposite ? dy : 0);
    int right = smaller(at.x + at.width, p->width - after);
    int bottom = smaller(at.y + at.height, p->height - dy);

    return (struct pair_tile){{left, top, right - left, bottom - top},
                              index_of(p, dx, dy)};
}

static bool is_filled(struct filter_tile t)
{
    return t.width > 0 && t.height > 0;
}

/* Sets weights of a tile to 0 if not all of its pixels are inside. */
static void clear_outside(const struct filter_planes *p, struct filter_tile t,
                          struct filter_tile inside, float *weights)
{
    if (inside.width == t.width && inside.height == t.height)
        return;
    for (int y = t.y; y < t.y + t.height; y++)
        memset(weights + index_of(p, t.x, y), 0,
               (size_t)t.width * sizeof *weights);
}

VECTORISED static void add_three(const float *restrict from, int width,
                                 float *restrict to)
{
    for (int x = 0; x < width; x++)
        to[x] = from[x] + from[x + 1] + from[x + 2];
}

VECTORISED static void weight_row(const float *restrict above,
                                  const float *restrict row,
                                  const float *restrict below,
                                  const float *restrict features, float tap,
                                  int width, float *restrict weights)
{
    for (int x = 0; x < width; x++)
        weights[x] =
            filter_weight(tap,
                          filter_light_distance(above[x] + row[x] + below[x]),
                          features[x]);
}

/* ---- averages ---- */

/* The eight pixels around each pixel of a row. */
struct taps {
    ptrdiff_t away[TAPS];
    const float *weights[TAPS];
};

VECTORISED static void inverse_sums(const struct taps *t, int width,
                                    float *restrict inverse)
{
    const struct taps taps = *t;

    for (int x = 0; x < width; x++) {
        float sum = FILTER_CENTRE;

        for (int k = 0; k < TAPS; k++)
            sum += taps.weights[k][x];
        inverse[x] = 1.0f / sum;
    }
}

VECTORISED static void average_light(const struct taps *t,
                                     const float *restrict light,
                                     const float *restrict inverse, int width,
                                     float *restrict to)
{
    const struct taps taps = *t;

    for (int x = 0; x < width; x++) {
        float sum = FILTER_CENTRE * light[x];

        for (int k = 0; k < TAPS; k++)
            sum += taps.weights[k][x] * light[x + taps.away[k]];
        to[x] = sum * inverse[x];
    }
}

VECTORISED static void average_variance(const struct taps *t,
                                        const float *restrict variance,
                                        const float *restrict inverse,
                                        int width, float *restrict to)
{
    const struct taps taps = *t;

    for (int x = 0; x < width; x++) {
        float sum = FILTER_CENTRE * FILTER_CENTRE * variance[x];

        for (int k = 0; k < TAPS; k++)
            sum += taps.weights[k][x] * taps.weights[k][x] *
                   variance[x + taps.away[k]];
        to[x] = sum * (inverse[x] * inverse[x]);
    }
}

/* Returns the pixels around those of row `at` with the weights of half h: each
 * pair, and the pairs whose second pixel they are. */
static struct taps taps_of(const struct filter_planes *p, int h, ptrdiff_t at,
                           int step)
{
    struct taps t;

    for (int k = 0; k < PAIRS; k++) {
        ptrdiff_t away = index_of(p, pairs[k].x * step, pairs[k].y * step);

        t.away[k] = away;
        t.weights[k] = p->weights[h][k] + at;
        t.away[PAIRS + k] = -away;
        t.weights[PAIRS + k] = p->weights[h][k] + at - away;
    }
    return t;
}

#endif
