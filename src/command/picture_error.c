// SPDX-License-Identifier: MIT
#include "command/picture_error.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "kernels/vec.h"

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
