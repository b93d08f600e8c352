// SPDX-License-Identifier: MIT
#include "command/difference.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/memory.h"
#include "command/replicates.h"
#include "inspect/false_color.h"
#include "kernels/vec.h"

/* ---- errors ---- */

/* Added to squares of the reference, so that dark pixels do not dominate. */
#define DARK 0.01

/* Share of the reference's own error that is left in the measured one. */
#define OWN_SHARE_MAX 0.05

#define PERCENT_999 0.999

static size_t value_count(const struct picture_pair *p)
{
    return 3 * (size_t)p->width * (size_t)p->height;
}

static double difference_at(const struct picture_pair *p, size_t i)
{
    return (double)p->rgb[i] - (double)p->reference[i];
}

/* Returns the part of 16 bits by which pass 0 or 1 sorts. Floats that are not
 * negative are ordered as their bits. */
static uint32_t digit_of(float x, int pass)
{
    return pass == 0 ? float_bits(x) >> 16 : float_bits(x) & 0xffff;
}

/* Returns the value of this rank, from 0, among the absolute differences. Two
 * passes of a radix sort find it without a copy of the values. */
static double ranked_difference(const struct picture_pair *p, size_t rank)
{
    static const size_t digits = 65536;
    size_t *counts = malloc(digits * sizeof *counts);
    uint32_t bits = 0;

    if (counts == NULL)
        return NAN;
    for (int pass = 0; pass < 2; pass++) {
        uint32_t digit = 0;

        for (size_t i = 0; i < digits; i++)
            counts[i] = 0;
        for (size_t i = 0; i < value_count(p); i++) {
            float x = (float)fabs(difference_at(p, i));

            if (pass == 0 || digit_of(x, 0) == bits)
                counts[digit_of(x, pass)]++;
        }
        while (rank >= counts[digit])
            rank -= counts[digit++];
        bits = pass == 0 ? digit : bits << 16 | digit;
    }
    free(counts);
    return (double)bits_float(bits);
}

/* Sets the bias and its margin from the mean differences of the pixels. */
static void set_bias(struct picture_error *e, const struct picture_pair *p)
{
    size_t pixels = value_count(p) / 3;
    double sum = 0, squares = 0, reference = 0, mean, variance;

    for (size_t i = 0; i < 3 * pixels; i += 3) {
        double d = 0;

        for (size_t c = 0; c < 3; c++) {
            d += difference_at(p, i + c) / 3;
            reference += (double)p->reference[i + c] / 3;
        }
        sum += d;
        squares += d * d;
    }
    mean = sum / (double)pixels;
    variance = fmax(squares / (double)pixels - mean * mean, 0);
    e->bias = sum / reference;
    /* 1.96 standard errors of a mean of many */
    e->bias_margin = pixels > 1 ? 1.96 * sqrt(variance / (double)(pixels - 1)) *
                                      (double)pixels / reference
                                : NAN;
}

struct picture_error picture_error_of(const struct picture_pair *p)
{
    struct picture_error e = {0};
    size_t count = value_count(p), largest = 0;

    for (size_t i = 0; i < count; i++) {
        double r = (double)p->reference[i], d = difference_at(p, i);

        e.mse += d * d;
        e.relmse += d * d / (r * r + DARK);
        if (fabs(d) > fabs(e.largest)) {
            e.largest = d;
            largest = i;
        }
    }
    e.mse /= (double)count;
    e.relmse /= (double)count;
    e.largest_channel = (int)(largest % 3);
    e.largest_x = (int)(largest / 3 % (size_t)p->width);
    e.largest_y = (int)(largest / 3 / (size_t)p->width);
    e.percentile =
        ranked_difference(p, (size_t)ceil(PERCENT_999 * (double)count) - 1);
    set_bias(&e, p);
    return e;
}

/* Returns the mean of the reference over the pixels around (x, y), up to two
 * pixels away and without it, or a quarter of the pixel if that is more. */
static double local_mean(const struct picture_pair *p, int x, int y, size_t c)
{
    double own = 0, sum = 0;
    int count = 0;

    for (int v = y - 2; v <= y + 2; v++)
        for (int u = x - 2; u <= x + 2; u++) {
            double r;

            if (u < 0 || v < 0 || u >= p->width || v >= p->height)
                continue;
            r = (double)p
                    ->reference[3 * ((size_t)v * (size_t)p->width + (size_t)u) +
                                c];
            if (u == x && v == y) {
                own = r;
                continue;
            }
            sum += r;
            count++;
        }
    return fmax(count > 0 ? sum / count : 0, own / 4);
}

double picture_error_stated(const struct picture_pair *p, double exposure)
{
    double black = 0.1 * exp2(-exposure), sum = 0;

    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            for (size_t c = 0; c < 3; c++) {
                size_t pixel = (size_t)y * (size_t)p->width + (size_t)x;
                double m = local_mean(p, x, y, c);
                double d = difference_at(p, 3 * pixel + c);

                sum += d * d / (m * m + black * black);
            }
    return sqrt(sum / (double)value_count(p));
}

struct group_errors picture_error_groups(const struct picture_pair *p)
{
    struct group_errors e = {{0}, {0}};
    size_t counts[PIXEL_GROUPS] = {0};

    for (size_t i = 0; i < value_count(p); i++) {
        size_t x = i / 3 % (size_t)p->width, y = i / 3 / (size_t)p->width;
        size_t group = (x + 5 * y) % PIXEL_GROUPS;
        double r = (double)p->reference[i], d = difference_at(p, i);

        e.mse[group] += d * d;
        e.relmse[group] += d * d / (r * r + DARK);
        counts[group]++;
    }
    for (int i = 0; i < PIXEL_GROUPS; i++) {
        e.mse[i] /= (double)counts[i];
        e.relmse[i] /= (double)counts[i];
    }
    return e;
}

double picture_error_without(double measured, double own)
{
    return own > OWN_SHARE_MAX * measured ? measured - own : measured;
}

/* ---- differences ---- */

/* ---- tiles ---- */

/* The mean of fewer pixels is too skewed under skewed noise: with tiles of 8x8
 * and one bright pixel in 50, false alarms were twice as frequent as wanted. */
#define SIDE_MIN_PX 16

/* Moments of one channel in a tile. */
struct moments {
    double difference, reference; /* means */
    double variance;              /* of the differences */
};

static int limit(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* Splits `size` pixels into `count` parts whose sizes differ by at most one.
 * Returns the first pixel of part i. */
static int part_begin(int size, int count, int i)
{
    return (int)((long long)size * i / count);
}

static struct moments moments_of(const struct picture_pair *p,
                                 const struct tile *t, int channel)
{
    struct moments m = {0, 0, 0};
    double count = (double)t->width * t->height, squares = 0;

    /* two passes, since the square of a mean cancels */
    for (int pass = 0; pass < 2; pass++) {
        for (int y = t->y; y < t->y + t->height; y++) {
            for (int x = t->x; x < t->x + t->width; x++) {
                size_t i = 3 * ((size_t)y * (size_t)p->width + (size_t)x) +
                           (size_t)channel;
                double r = (double)p->reference[i];
                double d = (double)p->rgb[i] - r;

                if (pass == 0) {
                    m.difference += d / count;
                    m.reference += r / count;
                } else {
                    squares += (d - m.difference) * (d - m.difference);
                }
            }
        }
    }
    m.variance = count > 1 ? squares / (count - 1) : 0;
    return m;
}

/* Returns the mean variance of a tile and the tiles around it. */
static double variance_around(const struct tile_test *test,
                              const struct moments *all, int col, int row,
                              int channel)
{
    double sum = 0;
    int count = 0;

    for (int y = row - 1; y <= row + 1; y++)
        for (int x = col - 1; x <= col + 1; x++)
            if (x >= 0 && y >= 0 && x < test->cols && y < test->rows) {
                sum += all[3 * (y * test->cols + x) + channel].variance;
                count++;
            }
    return sum / count;
}

/* Sets the channel if it is the most significant one so far. */
static void test_channel(struct tile *t, int channel, const struct moments *m,
                         double variance)
{
    double error = sqrt(variance / ((double)t->width * t->height));
    double value = m->difference == 0 ? 0 : m->difference / error;

    if (channel > 0 && fabs(value) <= fabs(t->t))
        return;
    t->channel = channel;
    t->t = value;
    t->difference = m->difference;
    t->reference = m->reference;
}

/* Tests a tile. Noise of light is skewed: a tile that lacks the rare bright
 * samples is too dark and seems too calm, and its own variance would make
 * hundreds of times more false alarms than wanted. The variance is at least
 * that of its surroundings. */
static void test_tile(struct tile_test *test, const struct moments *all,
                      int col, int row)
{
    struct tile *t = &test->tiles[row * test->cols + col];

    for (int c = 0; c < 3; c++) {
        const struct moments *m = &all[3 * (row * test->cols + col) + c];
        double around = variance_around(test, all, col, row, c);

        test_channel(t, c, m, fmax(m->variance, around));
    }
    t->differs = fabs(t->t) > test->bound;
    test->differing += t->differs;
}

/* Tests the whole picture, which shows differences that are too small for a
 * tile. */
static void test_whole(struct tile_test *test, const struct picture_pair *p)
{
    struct tile *t = &test->whole;

    *t = (struct tile){.width = p->width, .height = p->height};
    for (int c = 0; c < 3; c++) {
        struct moments m = moments_of(p, t, c);

        test_channel(t, c, &m, m.variance);
    }
    t->differs = fabs(t->t) > test->bound;
}

static void place_tiles(struct tile_test *test, const struct picture_pair *p)
{
    for (int row = 0; row < test->rows; row++)
        for (int col = 0; col < test->cols; col++) {
            struct tile *t = &test->tiles[row * test->cols + col];

            t->x = part_begin(p->width, test->cols, col);
            t->y = part_begin(p->height, test->rows, row);
            t->width = part_begin(p->width, test->cols, col + 1) - t->x;
            t->height = part_begin(p->height, test->rows, row + 1) - t->y;
        }
}

/* Returns the bound of the smallest tile for all, as bounds of larger ones
 * differ by less than one per cent. */
static double bound_of(const struct picture_pair *p,
                       const struct tile_test *test, double false_alarms)
{
    double tests = 3.0 * (test->cols * test->rows + 1);
    int64_t pixels =
        (int64_t)(p->width / test->cols) * (p->height / test->rows);

    return student_t_bound(false_alarms / tests,
                           (double)(pixels > 1 ? pixels - 1 : 1));
}

bool tile_test_init(struct tile_test *test, const struct picture_pair *p,
                    int side_max, double false_alarms, struct error *err)
{
    struct moments *all;
    size_t count;

    test->cols = limit(p->width / SIDE_MIN_PX, 1, side_max);
    test->rows = limit(p->height / SIDE_MIN_PX, 1, side_max);
    test->differing = 0;
    count = (size_t)test->cols * (size_t)test->rows;
    test->tiles = alloc_array(count, sizeof *test->tiles);
    all = alloc_array(count, 3 * sizeof *all);
    if (test->tiles == NULL || all == NULL) {
        free(all);
        return fail(err, "out of memory for %zu tiles", count);
    }
    place_tiles(test, p);
    test->bound = bound_of(p, test, false_alarms);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            all[3 * i + (size_t)c] = moments_of(p, &test->tiles[i], c);
    for (int row = 0; row < test->rows; row++)
        for (int col = 0; col < test->cols; col++)
            test_tile(test, all, col, row);
    test_whole(test, p);
    free(all);
    return true;
}

void tile_test_free(struct tile_test *test)
{
    free(test->tiles);
    *test = (struct tile_test){0};
}

/* ---- picture ---- */

#define WHITE 0xffffff

/* The brightest colour is for this many times the root mean square, so that a
 * few bright pixels do not make all others black. */
#define SCALE 3.0

/* Dark pixels are compared with this radiance instead of their own, as in
 * relMSE. */
#define DARK_MEAN 0.1

/* Returns the mean difference of a pixel's channels, relative to the reference.
 */
static double relative_at(const struct picture_pair *p, size_t pixel)
{
    double difference = 0, reference = 0;

    for (size_t i = 3 * pixel; i < 3 * pixel + 3; i++) {
        difference += ((double)p->rgb[i] - (double)p->reference[i]) / 3;
        reference += (double)p->reference[i] / 3;
    }
    return difference / hypot(reference, DARK_MEAN);
}

static void draw_tiles(const struct tile_test *test, struct frame *frame)
{
    for (int i = 0; i < test->cols * test->rows; i++) {
        const struct tile *t = &test->tiles[i];

        if (t->differs)
            frame_box(frame, t->x + 0.5, t->y + 0.5, t->x + t->width - 0.5,
                      t->y + t->height - 0.5, WHITE);
    }
}

double difference_draw(const struct picture_pair *p,
                       const struct tile_test *test, struct frame *frame)
{
    size_t count = (size_t)p->width * (size_t)p->height;
    double squares = 0, full;

    for (size_t i = 0; i < count; i++)
        squares += relative_at(p, i) * relative_at(p, i);
    full = SCALE * sqrt(squares / (double)count);
    for (size_t i = 0; i < count; i++) {
        double part = full > 0 ? relative_at(p, i) / full : 0;
        uint32_t color = false_color_difference((float)part);

        for (int c = 0; c < 3; c++)
            frame->rgb[3 * i + (size_t)c] = (uint8_t)(color >> (16 - 8 * c));
    }
    draw_tiles(test, frame);
    return full;
}
