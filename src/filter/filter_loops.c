// SPDX-License-Identifier: MIT
/* Compiled once for each instruction set; LOOPS is the name of the result. Each
 * loop runs over pixels of a row, for compilers to vectorise. */
#include "filter/filter_loops.h"

#include <string.h>

#ifndef LOOPS
#define LOOPS filter_loops_plain
#endif

enum { WIDTH = FILTER_TILE_WIDTH, HEIGHT = FILTER_TILE_HEIGHT, TAPS = 8 };

/* Values of a tile's pixels, and of the rows above and below. */
typedef float tile_rows[HEIGHT + 2][WIDTH];

/* Weights of the eight pixels around each pixel of a row. */
typedef float row_weights[TAPS][WIDTH];

struct tile {
    const struct filter_planes *planes;
    struct filter_tile at;
    int step;
    const struct filter_halves *from;
    row_weights weights[2][HEIGHT]; /* from the light of each half */
};

/* Returns the k-th of the eight pixels around the middle: -1, 0 or 1. */
static inline int tap_x(int k)
{
    return (k < 4 ? k : k + 1) % 3 - 1;
}

static inline int tap_y(int k)
{
    return (k < 4 ? k : k + 1) / 3 - 1;
}

static ptrdiff_t index_of(const struct filter_planes *p, int x, int y)
{
    return y * p->pitch + x;
}

/* Adds the channel distances of the pixels at x - 1 to x + width and those
 * `away` from them. */
VECTORISED static void add_channel(const float *restrict light,
                                   const float *restrict variance,
                                   ptrdiff_t away, int width,
                                   float *restrict sum)
{
    for (int x = -1; x <= width; x++)
        sum[x + 1] += filter_channel_distance(light[x], light[x + away],
                                              variance[x], variance[x + away]);
}

/* Computes channel distances of half h, summed over channels and three pixels
 * of a row, for all rows of the tile and their neighbours. */
static void row_distances(const struct tile *t, int h, ptrdiff_t away,
                          tile_rows rows)
{
    for (int y = -1; y <= t->at.height; y++) {
        ptrdiff_t at = index_of(t->planes, t->at.x, t->at.y + y);
        float *row = rows[y + 1];
        float sum[WIDTH + 2] = {0};

        for (int c = 0; c < 3; c++)
            add_channel(t->from->light[h][c] + at, t->from->variance[h][c] + at,
                        away, t->at.width, sum);
        for (int x = 0; x < t->at.width; x++)
            row[x] = sum[x] + sum[x + 1] + sum[x + 2];
    }
}

/* Adds the squared differences of a feature of the pixels and those `away` from
 * them. */
VECTORISED static void add_feature(const float *restrict feature,
                                   ptrdiff_t away, int width,
                                   float *restrict sum)
{
    for (int x = 0; x < width; x++) {
        float difference = feature[x] - feature[x + away];

        sum[x] += difference * difference;
    }
}

VECTORISED static void subtract_noise(const float *restrict noise,
                                      ptrdiff_t away, int width,
                                      float *restrict distance)
{
    for (int x = 0; x < width; x++)
        distance[x] =
            filter_feature_distance(distance[x], noise[x], noise[x + away]);
}

/* Computes the distances of features of a row and the row `away`. */
static void feature_row(const struct filter_planes *p, ptrdiff_t at,
                        ptrdiff_t away, int width, float *distance)
{
    memset(distance, 0, (size_t)width * sizeof *distance);
    for (int i = 0; i < FILTER_FEATURES; i++)
        add_feature(p->features[i] + at, away, width, distance);
    subtract_noise(p->feature_noise + at, away, width, distance);
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

/* Computes the weights of tap k by the light of each half. */
static void weigh_tap(struct tile *t, int k)
{
    float tap = 1.0f / (float)(4 << (tap_x(k) != 0) << (tap_y(k) != 0));
    ptrdiff_t away = index_of(t->planes, tap_x(k), tap_y(k)) * t->step;
    tile_rows distances[2];

    for (int h = 0; h < 2; h++)
        row_distances(t, h, away, distances[h]);
    for (int y = 0; y < t->at.height; y++) {
        float features[WIDTH];

        feature_row(t->planes, index_of(t->planes, t->at.x, t->at.y + y), away,
                    t->at.width, features);
        for (int h = 0; h < 2; h++) {
            float(*rows)[WIDTH] = distances[h] + y;

            weight_row(rows[0], rows[1], rows[2], features, tap, t->at.width,
                       t->weights[h][y][k]);
        }
    }
}

static void weight_sums(const row_weights weights, int width,
                        float *restrict inverse)
{
    for (int x = 0; x < width; x++)
        inverse[x] = FILTER_CENTRE;
    for (int k = 0; k < TAPS; k++)
        for (int x = 0; x < width; x++)
            inverse[x] += weights[k][x];
    for (int x = 0; x < width; x++)
        inverse[x] = 1.0f / inverse[x];
}

/* Adds the weighted light and variance of one pixel in eight. */
VECTORISED static void add_tap(const float *restrict light,
                               const float *restrict variance,
                               const float *restrict weights, int width,
                               float *restrict u, float *restrict v)
{
    for (int x = 0; x < width; x++) {
        u[x] += weights[x] * light[x];
        v[x] += weights[x] * weights[x] * variance[x];
    }
}

/* Averages a row of one channel's light and variance. */
VECTORISED static void
average_row(const float *restrict light, const float *restrict variance,
            const ptrdiff_t away[TAPS], const row_weights weights,
            const float *restrict inverse, int width, float *restrict light_to,
            float *restrict variance_to)
{
    float u[WIDTH], v[WIDTH];

    for (int x = 0; x < width; x++) {
        u[x] = FILTER_CENTRE * light[x];
        v[x] = FILTER_CENTRE * FILTER_CENTRE * variance[x];
    }
    for (int k = 0; k < TAPS; k++)
        add_tap(light + away[k], variance + away[k], weights[k], width, u, v);
    for (int x = 0; x < width; x++) {
        light_to[x] = u[x] * inverse[x];
        variance_to[x] = v[x] * (inverse[x] * inverse[x]);
    }
}

/* Averages half h with the weights of the other half. */
static void average_half(const struct tile *t, int h,
                         const struct filter_halves *to)
{
    ptrdiff_t away[TAPS];

    for (int k = 0; k < TAPS; k++)
        away[k] = index_of(t->planes, tap_x(k), tap_y(k)) * t->step;
    for (int y = 0; y < t->at.height; y++) {
        ptrdiff_t at = index_of(t->planes, t->at.x, t->at.y + y);
        const float(*weights)[WIDTH] =
            (const float(*)[WIDTH])t->weights[1 - h][y];
        float inverse[WIDTH];

        weight_sums(weights, t->at.width, inverse);
        for (int c = 0; c < 3; c++)
            average_row(t->from->light[h][c] + at, t->from->variance[h][c] + at,
                        away, weights, inverse, t->at.width,
                        to->light[h][c] + at, to->variance[h][c] + at);
    }
    for (int c = 0; c < 3; c++) {
        filter_extend(t->planes, to->light[h][c], t->at);
        filter_extend(t->planes, to->variance[h][c], t->at);
    }
}

static void level(const struct filter_planes *p, struct filter_tile at,
                  int from, int step)
{
    struct tile t = {.planes = p,
                     .at = at,
                     .step = step,
                     .from = &p->halves[from]};

    for (int k = 0; k < TAPS; k++)
        weigh_tap(&t, k);
    for (int h = 0; h < 2; h++)
        average_half(&t, h, &p->halves[1 - from]);
}

/* Computes (a - b)^2, summed over five pixels of a row. */
VECTORISED static void spread_row(const float *restrict a,
                                  const float *restrict b, int width,
                                  float *restrict sum)
{
    float square[WIDTH + 4];

    for (int x = 0; x < width + 4; x++)
        square[x] = (a[x - 2] - b[x - 2]) * (a[x - 2] - b[x - 2]);
    for (int x = 0; x < width; x++)
        sum[x] = square[x] + square[x + 1] + square[x + 2] + square[x + 3] +
                 square[x + 4];
}

static void variance(const struct filter_planes *p, struct filter_tile t)
{
    const struct filter_halves *s = &p->halves[0];
    float rows[HEIGHT + 4][WIDTH];

    for (int c = 0; c < 3; c++) {
        for (int y = 0; y < t.height + 4; y++) {
            ptrdiff_t at = index_of(p, t.x, t.y + y - 2);

            spread_row(s->light[0][c] + at, s->light[1][c] + at, t.width,
                       rows[y]);
        }
        for (int y = 0; y < t.height; y++) {
            ptrdiff_t at = index_of(p, t.x, t.y + y);
            float *restrict a = s->variance[0][c] + at;
            float *restrict b = s->variance[1][c] + at;

            for (int x = 0; x < t.width; x++)
                a[x] = b[x] = filter_variance(rows[y][x] + rows[y + 1][x] +
                                              rows[y + 2][x] + rows[y + 3][x] +
                                              rows[y + 4][x]);
        }
        filter_extend(p, s->variance[0][c], t);
        filter_extend(p, s->variance[1][c], t);
    }
}

extern const struct filter_loops LOOPS;
const struct filter_loops LOOPS = {variance, level};
