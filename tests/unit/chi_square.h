// SPDX-License-Identifier: MIT
/*
 * chi_square.h - do counts follow what is expected of them?
 *
 * Pearson's test. Cells with fewer than 5 expected are taken together.
 *
 * Units:     counts; standard deviations
 * Threads:   one
 */
#ifndef TESTS_CHI_SQUARE_H
#define TESTS_CHI_SQUARE_H

#include <math.h>

#define CHI_EXPECTED_MIN 5

/* Of cells whose expected counts sum up to what is counted. */
struct chi_square {
    double sum, degrees;
    double rest, rest_count; /* expected and counted in the small cells */
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

/* After the last cell: the small ones count as one, if they are enough. */
static inline void chi_end(struct chi_square *c)
{
    double expected = c->rest, count = c->rest_count;

    if (expected < CHI_EXPECTED_MIN)
        return;
    c->rest = c->rest_count = 0;
    chi_add(c, expected, count);
}

/* The upper tail as a normal deviate (Wilson and Hilferty 1931). */
static inline double chi_deviate(const struct chi_square *c)
{
    double v = 2 / (9 * c->degrees);

    return (cbrt(c->sum / c->degrees) - 1 + v) / sqrt(v);
}

#endif
