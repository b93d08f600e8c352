// SPDX-License-Identifier: MIT
/*
 * noise.h - random numbers of mean 0, normal or with a long tail
 *
 * Threads:   any; *random is the caller's
 */
#ifndef TESTS_NOISE_H
#define TESTS_NOISE_H

#include <math.h>

#include "tests/unit/check.h"

static inline double normal(uint64_t *random)
{
    double r = sqrt(-2 * log(1 - check_random(random)));

    return r * cos(6.28318530717958648 * check_random(random));
}

/* Lognormal noise of this spread with mean 0; normal noise if it is 0. */
static inline double noise(double spread, uint64_t *random)
{
    return spread > 0 ? exp(spread * normal(random)) - exp(spread * spread / 2)
                      : normal(random);
}

#endif
