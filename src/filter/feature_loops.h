// SPDX-License-Identifier: MIT
/*
 * feature_loops.h - averages of features over pixels that differ by noise only
 *
 * src/filter/filter_loops.c includes it, once for each instruction set.
 *
 * Units:     as kernels/filter.h
 * Threads:   any, on tiles that differ
 */
#ifndef GLIM_FEATURE_LOOPS_H
#define GLIM_FEATURE_LOOPS_H

#include "filter/filter_rows.h"

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
        weight_row(rows[y], rows[y + 1], rows[y + 2], none, pairs[k].tap,
                   t.width, p->weights[0][k] + index_of(p, t.x, t.y + y));
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

#endif
