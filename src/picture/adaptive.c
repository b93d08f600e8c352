// SPDX-License-Identifier: MIT
#include "picture/adaptive.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "picture/film_error.h"

/* Pilots around a cell, in each direction, whose deviations it takes. */
#define REACH 2

/* What the cells get from the film, and sums over cells: means, variances of
 * one sample, the relative variance, and the number of pilots. */
enum moment { MEAN, VARIANCE = 3, RELATIVE = 6, PILOTS, MOMENTS };

/* Share of a pilot that replaces the mean around it if it is larger, as in
 * film_error.c. */
#define OWN_SHARE 0.25f

static int columns_of(const struct adaptive *a)
{
    return (a->width + 1) / 2;
}

static int rows_of(const struct adaptive *a)
{
    return (a->height + 1) / 2;
}

bool adaptive_init(struct adaptive *a, int width, int height, struct error *err)
{
    *a = (struct adaptive){.width = width,
                           .height = height,
                           .version = a->version};
    a->cells = (size_t)columns_of(a) * (size_t)rows_of(a);
    a->targets = alloc_array(a->cells, 2 * sizeof *a->targets);
    a->quotas = alloc_array(a->cells, 2 * sizeof *a->quotas);
    a->deviations = alloc_array(a->cells, 2 * sizeof *a->deviations);
    if (a->targets != NULL && a->quotas != NULL && a->deviations != NULL)
        return true;
    adaptive_free(a);
    return fail(err, "out of memory for adaptive sampling of %dx%d pixels",
                width, height);
}

void adaptive_free(struct adaptive *a)
{
    free(a->targets);
    free(a->quotas);
    free(a->deviations);
    *a = (struct adaptive){.version = a->version};
}

void adaptive_reset(struct adaptive *a)
{
    a->planned = 0;
}

/* Reads the pilot of a cell, which has samples in both halves: means, and
 * variances of one sample. */
static void read_pilot(struct film *f, int x, int y, float *to)
{
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    float e[3];

    film_pixel_error(f, at, to + MEAN, e);
    for (int c = 0; c < 3; c++)
        to[VARIANCE + c] = f_min(e[c] * e[c] * (float)f->counts[at], 1e30f);
    to[PILOTS] = 1.0f;
}

static void read_pilots(const struct adaptive *a, struct film *f, float *cells)
{
    for (int row = 0; row < rows_of(a); row++) {
        film_lock_row(f, 2 * row);
        for (int i = 0; i < columns_of(a); i++)
            read_pilot(f, 2 * i, 2 * row,
                       cells + MOMENTS * (row * columns_of(a) + i));
        film_unlock_row(f, 2 * row);
    }
}

/* Adds up the pilots around a cell, with or without its own. */
static void sum_around(const struct adaptive *a, const float *cells, int column,
                       int row, int reach, bool with_own, float sums[MOMENTS])
{
    memset(sums, 0, MOMENTS * sizeof *sums);
    for (int y = row - reach; y <= row + reach; y++)
        for (int x = column - reach; x <= column + reach; x++) {
            if (x < 0 || y < 0 || x >= columns_of(a) || y >= rows_of(a) ||
                (!with_own && x == column && y == row))
                continue;
            for (int i = 0; i < MOMENTS; i++)
                sums[i] += cells[MOMENTS * (y * columns_of(a) + x) + i];
        }
}

/* Returns the relative variance of one sample: of variances, by means. */
static float relative_variance(const float variances[3], const float means[3],
                               float floor)
{
    float total = 0.0f;

    for (int c = 0; c < 3; c++)
        total += variances[c] / (means[c] * means[c] + floor);
    return total / 3.0f;
}

/* Fills in the relative variance of a cell's pilot, by the pilots around. */
static void relate_pilot(const struct adaptive *a, float *cells, int column,
                         int row, float floor)
{
    float *own = cells + MOMENTS * (row * columns_of(a) + column);
    float sums[MOMENTS];
    float means[3];

    sum_around(a, cells, column, row, 1, false, sums);
    for (int c = 0; c < 3; c++)
        means[c] =
            f_max(sums[MEAN + c] / sums[PILOTS], OWN_SHARE * own[MEAN + c]);
    own[RELATIVE] = relative_variance(own + VARIANCE, means, floor);
}

/* Returns the relative deviation of the other pixels of a cell. */
static float deviation_of_cell(const struct adaptive *a, const float *cells,
                               int column, int row)
{
    float sums[MOMENTS];

    sum_around(a, cells, column, row, REACH, true, sums);
    return sqrtf(sums[RELATIVE] / sums[PILOTS]);
}

/* Returns the relative deviation of a pilot, in which its own values have no
 * part. */
static float deviation_of_pilot(const struct adaptive *a, const float *cells,
                                int column, int row, float floor)
{
    float sums[MOMENTS];

    sum_around(a, cells, column, row, REACH, false, sums);
    for (int i = 0; i < PILOTS; i++)
        sums[i] /= sums[PILOTS];
    return sqrtf(relative_variance(sums + VARIANCE, sums + MEAN, floor));
}

static bool find_deviations(struct adaptive *a, struct film *f, float exposure,
                            bool is_first, struct error *err)
{
    float *cells = alloc_array(a->cells, MOMENTS * sizeof *cells);
    double black = 0.1 * exp2(-(double)exposure);
    float floor = (float)(black * black);

    if (cells == NULL)
        return fail(err, "out of memory for adaptive sampling of %dx%d pixels",
                    a->width, a->height);
    read_pilots(a, f, cells);
    for (int row = 0; row < rows_of(a); row++)
        for (int column = 0; column < columns_of(a); column++)
            relate_pilot(a, cells, column, row, floor);
    for (int row = 0, i = 0; row < rows_of(a); row++)
        for (int column = 0; column < columns_of(a); column++, i++) {
            a->deviations[2 * i + 1] = deviation_of_cell(a, cells, column, row);
            if (is_first)
                a->deviations[2 * i] =
                    deviation_of_pilot(a, cells, column, row, floor);
        }
    free(cells);
    return true;
}

/* Number of pixels that have target i. */
static double pixels_at(const struct adaptive *a, size_t i)
{
    int column = (int)(i / 2 % (size_t)columns_of(a));
    int row = (int)(i / 2 / (size_t)columns_of(a));
    int wide = 2 * column + 1 < a->width ? 2 : 1;
    int high = 2 * row + 1 < a->height ? 2 : 1;

    return i % 2 == 0 ? 1 : wide * high - 1;
}

/* Returns the samples of a pixel per pass that bring its total nearest to
 * `factor` times its deviation in a number of passes. */
static double quota_of(const struct adaptive *a, size_t i, double factor,
                       double passes)
{
    double lack = factor * (double)a->deviations[i] - (double)a->targets[i];
    double quota = lack > 0 ? floor(lack / passes + 0.5) : 0;

    return quota < ADAPTIVE_MOST ? quota : ADAPTIVE_MOST;
}

static double samples_with(const struct adaptive *a, double factor,
                           double passes)
{
    double samples = 0;

    for (size_t i = 0; i < 2 * a->cells; i++)
        samples += quota_of(a, i, factor, passes) * pixels_at(a, i);
    return samples;
}

/* Chooses the quotas of a round that begins after `done` samples: with the
 * largest factor for which they are at most ADAPTIVE_PASS in the mean. */
static void choose_quotas(struct adaptive *a, uint64_t done)
{
    double passes = (double)done / ADAPTIVE_PASS;
    double most = (double)ADAPTIVE_PASS * (double)a->width * (double)a->height;
    double low = 0, high = 1;

    while (high < 1e30 && samples_with(a, high, passes) < most)
        high *= 4;
    for (int i = 0; i < 24; i++) {
        double middle = (low + high) / 2;

        if (samples_with(a, middle, passes) <= most)
            low = middle;
        else
            high = middle;
    }
    for (size_t i = 0; i < 2 * a->cells; i++)
        a->quotas[i] = (uint8_t)quota_of(a, i, low, passes);
    if (!(samples_with(a, low, passes) > 0)) /* no pixel has an error */
        memset(a->quotas, ADAPTIVE_PASS, 2 * a->cells);
}

static void add_quotas(struct adaptive *a, uint64_t more)
{
    for (size_t i = 0; i < 2 * a->cells; i++)
        a->targets[i] += (uint32_t)((a->quotas[i] * more + ADAPTIVE_PASS / 2) /
                                    ADAPTIVE_PASS);
}

uint64_t adaptive_round_end(uint64_t done)
{
    uint64_t end = ADAPTIVE_FIRST;

    while (end <= done)
        end *= 2;
    return end;
}

bool adaptive_next_pass(struct adaptive *a, struct film *f, float exposure,
                        uint64_t done, uint64_t *target, struct error *err)
{
    uint64_t end = adaptive_round_end(done);
    bool is_first = a->planned < ADAPTIVE_FIRST;

    if (a->planned <= done) { /* otherwise it was interrupted */
        if (is_first)
            for (size_t i = 0; i < 2 * a->cells; i++)
                a->targets[i] = (uint32_t)done;
        if (is_first || 2 * done == end) {
            if (!find_deviations(a, f, exposure, is_first, err))
                return false;
            choose_quotas(a, end / 2);
        }
        assert(*target <= done + ADAPTIVE_PASS && *target <= end);
        add_quotas(a, *target - done);
        a->planned = *target;
        a->version++;
    }
    *target = a->planned;
    return true;
}
