// SPDX-License-Identifier: MIT
/*
 * chi_square.h - whether counts follow their expected values
 *
 * Pearson's test. Cells with fewer than 5 expected counts are merged.
 *
 * Units:     counts; standard deviations
 * Threads:   one
 */
#ifndef TESTS_CHI_SQUARE_H
#define TESTS_CHI_SQUARE_H

#include <math.h>

#define CHI_EXPECTED_MIN 5

/* Sums over cells. The expected counts sum to the number of counts. */
struct chi_square {
    double sum, degrees;
    double rest, rest_count; /* expected and counted numbers in small cells */
};

static inline struct chi_square chi_begin(void)
{
    return (struct chi_square){.degrees = -1};
}

static inline void chi_add(struct chi_square *c, double expected, double count)
{
    if (expected < CHI_EXPECTED_MIN) {
        c->rest += expected;
        c->rest_count += count;
        return;
    }
    c->sum += pow(count - expected, 2) / expected;
    c->degrees++;
}

/* Ends the test after the last cell. The small cells are one cell, if they have
 * enough counts. */
static inline void chi_end(struct chi_square *c)
{
    double expected = c->rest, count = c->rest_count;

    if (expected < CHI_EXPECTED_MIN)
        return;
    c->rest = c->rest_count = 0;
    chi_add(c, expected, count);
}

/* Returns the upper tail as a normal deviate (Wilson and Hilferty 1931). */
static inline double chi_deviate(const struct chi_square *c)
{
    double v = 2 / (9 * c->degrees);

    return (cbrt(c->sum / c->degrees) - 1 + v) / sqrt(v);
}

#endif
