// SPDX-License-Identifier: MIT
/* Compiled once for each instruction set; LOOPS is the name of the result. Each
 * loop runs over pixels of a row, for compilers to vectorise. */
#include "film/filter/filter_loops.h"

#include <stdbool.h>
#include <string.h>

#include "base/min_max.h"
#include "film/filter/filter_planes.h"

#ifndef LOOPS
#define LOOPS filter_loops_plain
#endif

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
    int before = is_opposite ? int_max(dx, -dx) : int_max(-dx, 0);
    int after = is_opposite ? before : int_max(dx, 0);
    int left = int_max(at.x, before), top = int_max(at.y, is_opposite ? dy : 0);
    int right = int_min(at.x + at.width, p->width - after);
    int bottom = int_min(at.y + at.height, p->height - dy);

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

/* Computes the weights of a row from the distances of three rows. */
VECTORISED static void weight_row(float (*rows)[WIDTH],
                                  const float *restrict features, float tap,
                                  int width, float *restrict weights)
{
    const float *restrict above = rows[0];
    const float *restrict row = rows[1];
    const float *restrict below = rows[2];

    for (int x = 0; x < width; x++)
        weights[x] =
            filter_weight(tap,
                          filter_light_distance(above[x] + row[x] + below[x]),
                          features[x]);
}

/* ---- taps ---- */

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

/* ---- features of pixels that differ by noise only ---- */

/* Features of a row, and their noise. */
struct feature_row {
    const float *features[FILTER_FEATURES];
    const float *noise;
};

static struct feature_row features_at(const struct filter_planes *p,
                                      ptrdiff_t at)
{
    struct feature_row row = {.noise = p->features.noise + at};

    for (int i = 0; i < FILTER_FEATURES; i++)
        row.features[i] = p->features.means[i] + at;
    return row;
}

/* Computes the distances of features of the pixels at x - 1 to x + width and
 * those `away` from them, in units of their noise. */
VECTORISED static void noise_distances(const struct feature_row *row,
                                       ptrdiff_t away, int width,
                                       float *restrict distance)
{
    const struct feature_row r = *row;

    for (int x = -1; x <= width; x++) {
        float sum = 0.0f;

        for (int i = 0; i < FILTER_FEATURES; i++) {
            float d = r.features[i][x] - r.features[i][x + away];

            sum += d * d;
        }
        distance[x + 1] =
            filter_pixel_distance(sum, r.noise[x], r.noise[x + away]);
    }
}

/* Computes the weights of the features of a tile in pair k. All pixels of both
 * are in the picture. */
static void weigh_features_part(const struct filter_planes *p,
                                struct filter_tile t, int k, ptrdiff_t away)
{
    static const float none[WIDTH] = {0};
    tile_rows rows;

    for (int y = -1; y <= t.height; y++) {
        struct feature_row row = features_at(p, index_of(p, t.x, t.y + y));
        float distance[WIDTH + 2];

        noise_distances(&row, away, t.width, distance);
        add_three(distance, t.width, rows[y + 1]);
    }
    for (int y = 0; y < t.height; y++)
        weight_row(rows + y, none, pairs[k].tap, t.width,
                   p->weights[0][k] + index_of(p, t.x, t.y + y));
}

static void weigh_features(const struct filter_planes *p, struct filter_tile at,
                           int step)
{
    for (int k = 0; k < PAIRS; k++) {
        struct pair_tile pair = pair_inside(p, at, k, step, false);

        clear_outside(p, at, pair.at, p->weights[0][k]);
        if (is_filled(pair.at))
            weigh_features_part(p, pair.at, k, pair.away);
    }
}

static void average_features(const struct filter_planes *p,
                             struct filter_tile t, int step,
                             const struct filter_features *to)
{
    for (int y = 0; y < t.height; y++) {
        ptrdiff_t at = index_of(p, t.x, t.y + y);
        struct taps taps = taps_of(p, 0, at, step);
        float inverse[WIDTH];

        inverse_sums(&taps, t.width, inverse);
        for (int i = 0; i < FILTER_FEATURES; i++)
            average_light(&taps, p->features.means[i] + at, inverse, t.width,
                          to->means[i] + at);
        average_variance(&taps, p->features.noise + at, inverse, t.width,
                         to->noise + at);
    }
    for (int i = 0; i < FILTER_FEATURES; i++)
        filter_extend(p, to->means[i], t);
    filter_extend(p, to->noise, t);
}

/* A tile, and the halves that a level reads. */
struct tile {
    const struct filter_planes *planes;
    const struct filter_halves *from;
    struct filter_tile at;
};

/* ---- weights ---- */

/* Light of a row of a half. */
struct light_row {
    const float *r, *g, *b, *variance;
};

/* Computes the distances of the pixels at x - 1 to x + width and those `away`
 * from them. */
VECTORISED static void pixel_distances(const struct light_row *row,
                                       ptrdiff_t away, int width,
                                       float *restrict distance)
{
    const struct light_row l = *row;

    for (int x = -1; x <= width; x++) {
        float dr = l.r[x] - l.r[x + away];
        float dg = l.g[x] - l.g[x + away];
        float db = l.b[x] - l.b[x + away];

        distance[x + 1] =
            filter_pixel_distance(dr * dr + dg * dg + db * db, l.variance[x],
                                  l.variance[x + away]);
    }
}

/* Computes the distances of the pixels at x - 1 to x + width and the opposite
 * ones `away` from them. */
VECTORISED static void opposite_distances(const struct light_row *row,
                                          ptrdiff_t away, int width,
                                          float *restrict distance)
{
    const struct light_row l = *row;

    for (int x = -1; x <= width; x++) {
        float dr = l.r[x + away] + l.r[x - away] - 2.0f * l.r[x];
        float dg = l.g[x + away] + l.g[x - away] - 2.0f * l.g[x];
        float db = l.b[x + away] + l.b[x - away] - 2.0f * l.b[x];

        distance[x + 1] =
            filter_opposite_distance(dr * dr + dg * dg + db * db, l.variance[x],
                                     l.variance[x + away],
                                     l.variance[x - away]);
    }
}

/* Computes distances of light of half h, summed over three pixels of a row, for
 * all rows of the tile and their neighbours. */
static void row_distances(const struct tile *t, int h, ptrdiff_t away,
                          bool is_opposite, tile_rows rows)
{
    for (int y = -1; y <= t->at.height; y++) {
        ptrdiff_t at = index_of(t->planes, t->at.x, t->at.y + y);
        const struct light_row row = {t->from->light[h][0] + at,
                                      t->from->light[h][1] + at,
                                      t->from->light[h][2] + at,
                                      t->from->variance[h] + at};
        float distance[WIDTH + 2];

        (is_opposite ? opposite_distances
                     : pixel_distances)(&row, away, t->at.width, distance);
        add_three(distance, t->at.width, rows[y + 1]);
    }
}

/* Computes the distances of features of a row and the row `away`. */
VECTORISED static void feature_distances(const struct feature_row *row,
                                         ptrdiff_t away, int width,
                                         float *restrict distance)
{
    const struct feature_row r = *row;

    for (int x = 0; x < width; x++) {
        float sum = 0.0f;

        for (int i = 0; i < FILTER_FEATURES; i++) {
            float d = r.features[i][x] - r.features[i][x + away];

            sum += d * d;
        }
        distance[x] =
            filter_feature_distance(sum, r.noise[x], r.noise[x + away]);
    }
}

/* Computes the distances of features of a row and the opposite rows `away`. */
VECTORISED static void opposite_features(const struct feature_row *row,
                                         ptrdiff_t away, int width,
                                         float *restrict distance)
{
    const struct feature_row r = *row;

    for (int x = 0; x < width; x++) {
        float sum = 0.0f;

        for (int i = 0; i < FILTER_FEATURES; i++) {
            float d = r.features[i][x + away] + r.features[i][x - away] -
                      2.0f * r.features[i][x];

            sum += d * d;
        }
        distance[x] =
            filter_opposite_features(sum, r.noise[x], r.noise[x + away],
                                     r.noise[x - away]);
    }
}

/* Computes the weights of the pixels of a tile in pair k, or of their opposite
 * pixels. All of these are in the picture. */
static void weigh_part(const struct tile *t, int k, ptrdiff_t away,
                       bool is_opposite)
{
    tile_rows distances[2];

    for (int h = 0; h < 2; h++)
        row_distances(t, h, away, is_opposite, distances[h]);
    for (int y = 0; y < t->at.height; y++) {
        ptrdiff_t at = index_of(t->planes, t->at.x, t->at.y + y);
        struct feature_row row = features_at(t->planes, at);
        float features[WIDTH];

        (is_opposite ? opposite_features
                     : feature_distances)(&row, away, t->at.width, features);
        for (int h = 0; h < 2; h++) {
            weight_row(distances[h] + y, features, pairs[k].tap, t->at.width,
                       (is_opposite ? t->planes->opposite
                                    : t->planes->weights)[h][k] +
                           at);
        }
    }
}

/* Computes the weights of a tile in pair k. Those with pixels outside of the
 * picture are 0. */
static void weigh_pair(const struct tile *whole, int k, int step,
                       bool is_opposite)
{
    const struct filter_planes *p = whole->planes;
    struct pair_tile pair = pair_inside(p, whole->at, k, step, is_opposite);
    struct tile t = {p, whole->from, pair.at};

    for (int h = 0; h < 2; h++)
        clear_outside(p, whole->at, pair.at,
                      (is_opposite ? p->opposite : p->weights)[h][k]);
    if (is_filled(pair.at))
        weigh_part(&t, k, pair.away, is_opposite);
}

static void weigh(const struct filter_planes *p, struct filter_tile at,
                  const struct filter_level *level)
{
    struct tile t = {p, &p->halves[level->from], at};

    for (int k = 0; k < PAIRS; k++) {
        weigh_pair(&t, k, level->step, false);
        if (level->has_opposite)
            weigh_pair(&t, k, level->step, true);
    }
}

/* ---- averages ---- */

/* Values of the four pairs of pixels around each pixel of a row. */
typedef float pair_rows[PAIRS][WIDTH];

/* Computes the shares of the pixels `away` from those of a row in the weights
 * that they have in common with the opposite ones. */
VECTORISED static void share_row(const float *restrict albedo, ptrdiff_t away,
                                 int width, float *restrict shares)
{
    for (int x = 0; x < width; x++)
        shares[x] = filter_opposite_share(albedo[x + away], albedo[x - away]);
}

/* Joins the weights of a row and of its opposite pixels with those that they
 * have in common. */
VECTORISED static void join(const float *restrict opposite,
                            const float *restrict shares,
                            const float *const weights[2], float inverse_tap,
                            int width, float *const joined[2])
{
    const float *first = weights[0], *second = weights[1];
    float *restrict q = joined[0], *restrict r = joined[1];

    for (int x = 0; x < width; x++) {
        q[x] =
            filter_joined_weight(opposite[x], shares[x], first[x], inverse_tap);
        r[x] = filter_joined_weight(opposite[x], 1.0f - shares[x], second[x],
                                    inverse_tap);
    }
}

/* Joins the weights of a row, from half h, with those of opposite pixels. */
static void join_taps(const struct tile *t, int h, ptrdiff_t at,
                      pair_rows shares, float joined[TAPS][WIDTH],
                      struct taps *taps)
{
    for (int k = 0; k < PAIRS; k++) {
        const float *const weights[2] = {taps->weights[k],
                                         taps->weights[PAIRS + k]};
        float *const to[2] = {joined[k], joined[PAIRS + k]};

        join(t->planes->opposite[h][k] + at, shares[k], weights,
             1.0f / pairs[k].tap, t->at.width, to);
        taps->weights[k] = to[0];
        taps->weights[PAIRS + k] = to[1];
    }
}

/* Averages a row of half h with the weights of the other half. */
static void average_row(const struct tile *t, int h, ptrdiff_t at,
                        const struct filter_level *level, pair_rows shares)
{
    const struct filter_halves *to = &t->planes->halves[1 - level->from];
    struct taps taps = taps_of(t->planes, 1 - h, at, level->step);
    float inverse[WIDTH], joined[TAPS][WIDTH];

    if (level->has_opposite)
        join_taps(t, 1 - h, at, shares, joined, &taps);
    inverse_sums(&taps, t->at.width, inverse);
    for (int c = 0; c < 3; c++)
        average_light(&taps, t->from->light[h][c] + at, inverse, t->at.width,
                      to->light[h][c] + at);
    if (!level->is_last)
        average_variance(&taps, t->from->variance[h] + at, inverse, t->at.width,
                         to->variance[h] + at);
}

static void average_rows(const struct tile *t, const struct filter_level *level)
{
    const struct filter_planes *p = t->planes;
    pair_rows shares;

    for (int y = t->at.y; y < t->at.y + t->at.height; y++) {
        ptrdiff_t at = index_of(p, t->at.x, y);

        for (int k = 0; level->has_opposite && k < PAIRS; k++)
            share_row(p->albedo + at,
                      index_of(p, pairs[k].x, pairs[k].y) * level->step,
                      t->at.width, shares[k]);
        for (int h = 0; h < 2; h++)
            average_row(t, h, at, level, shares);
    }
}

static void average(const struct filter_planes *p, struct filter_tile at,
                    const struct filter_level *level)
{
    struct tile t = {p, &p->halves[level->from], at};
    const struct filter_halves *to = &p->halves[1 - level->from];

    average_rows(&t, level);
    for (int h = 0; h < 2 && !level->is_last; h++) {
        for (int c = 0; c < 3; c++)
            filter_extend(p, to->light[h][c], at);
        filter_extend(p, to->variance[h], at);
    }
}

/* ---- variance ---- */

/* Adds samples * (a - b)^2, summed over five pixels of a row. */
VECTORISED static void add_spread(const float *restrict a,
                                  const float *restrict b,
                                  const float *restrict samples, int width,
                                  float *restrict sum)
{
    float square[WIDTH + 4];

    for (int x = 0; x < width + 4; x++)
        square[x] =
            (a[x - 2] - b[x - 2]) * (a[x - 2] - b[x - 2]) * samples[x - 2];
    for (int x = 0; x < width; x++)
        sum[x] += square[x] + square[x + 1] + square[x + 2] + square[x + 3] +
                  square[x + 4];
}

static void variance(const struct filter_planes *p, struct filter_tile t)
{
    const struct filter_halves *s = &p->halves[0];
    float rows[HEIGHT + 4][WIDTH] = {{0}};

    for (int y = 0; y < t.height + 4; y++) {
        ptrdiff_t at = index_of(p, t.x, t.y + y - 2);

        for (int c = 0; c < 3; c++)
            add_spread(s->light[0][c] + at, s->light[1][c] + at,
                       p->samples + at, t.width, rows[y]);
    }
    for (int y = 0; y < t.height; y++) {
        ptrdiff_t at = index_of(p, t.x, t.y + y);
        const float *restrict samples = p->samples + at;
        float *restrict a = s->variance[0] + at;
        float *restrict b = s->variance[1] + at;

        for (int x = 0; x < t.width; x++)
            a[x] = b[x] =
                filter_variance(rows[y][x] + rows[y + 1][x] + rows[y + 2][x] +
                                    rows[y + 3][x] + rows[y + 4][x],
                                samples[x]);
    }
    filter_extend(p, s->variance[0], t);
    filter_extend(p, s->variance[1], t);
}

/* ---- sums ---- */

/* Converts without instructions for 64-bit integers, which few instruction sets
 * have for vectors: each half of the bits becomes the fraction of a double. */
static inline double double_of(uint64_t x)
{
    uint64_t low = (x & 0xffffffffu) | 0x4330000000000000u; /* 2^52 + x */
    uint64_t high = x >> 32 | 0x4530000000000000u;          /* 2^84 + 2^32 x */
    double a, b;

    memcpy(&a, &low, sizeof a);
    memcpy(&b, &high, sizeof b);
    return a + (b - 0x1.00000001p84);
}

VECTORISED static void convert(const struct sum *restrict sums, int count,
                               float *restrict to)
{
    for (int i = 0; i < count; i++)
        to[i] =
            (float)(double_of(sums[i].hi) + double_of(sums[i].lo) * 0x1p-64);
}

extern const struct filter_loops LOOPS;
const struct filter_loops LOOPS = {variance,         weigh,
                                   average,          weigh_features,
                                   average_features, convert};
