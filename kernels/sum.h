// SPDX-License-Identifier: MIT
/*
 * sum.h - exact sums of floats as 128-bit fixed point
 *
 * 64 integer bits and 64 fraction bits. Addition is exact, so that threads,
 * devices and restarts may add samples in any order and get the same bits.
 *
 * Units:     those of the numbers added
 * Threads:   one owner for each sum
 * Errors:    none; the caller counts what sum_accepts() refuses
 */
#ifndef KERNELS_SUM_H
#define KERNELS_SUM_H

#include "kernels/vec.h"

struct sum {
    uint64_t lo; /* units of 2^-64 */
    uint64_t hi; /* units of 1 */
};

/* Returns false for NaN, infinities and negative numbers. -0 is 0. */
static inline bool sum_accepts(float x)
{
    return x >= 0.0f && x <= FLOAT_MAX;
}

/* Adds a number of at most 2^62, or a sum to one that has room for it. Returns
 * the high part, whose top bit says that sum_saturate() must follow. */
static inline uint64_t sum_put(GLOBAL struct sum *s, struct sum x)
{
    s->lo += x.lo;
    s->hi += x.hi + (s->lo < x.lo ? 1 : 0);
    return s->hi;
}

/* Sums saturate at 2^63. */
static inline void sum_saturate(GLOBAL struct sum *s)
{
    s->hi = (uint64_t)1 << 63;
    s->lo = 0;
}

/* Adds one sum to another. Returns false if the result is saturated. */
static inline bool sum_join(GLOBAL struct sum *s, struct sum x)
{
    uint64_t large = s->hi | x.hi; /* two saturated sums wrap to 0 */

    if (!((sum_put(s, x) | large) >> 63))
        return true;
    sum_saturate(s);
    return false;
}

/* Converts x, which sum_accepts() has accepted. Bits below 2^-64 are cut off.
 * Values above 2^62 count as 2^62. */
static inline struct sum sum_of(float x)
{
    uint32_t exponent = float_bits(x) >> 23 & 255u;
    uint64_t mantissa = (float_bits(x) & 0x7fffffu) | 0x800000u;
    struct sum value = {0, 0};

    if (exponent < 127 - 64) /* 0 and denormal numbers as well */
        return value;
    if (exponent < 127) { /* below 1 */
        value.lo = mantissa << 40 >> (126 - exponent);
    } else if (exponent < 150) {
        value.lo = mantissa << (exponent - (150 - 64));
        value.hi = mantissa >> (150 - exponent);
    } else if (exponent < 127 + 62) {
        value.hi = mantissa << (exponent - 150);
    } else {
        value.hi = (uint64_t)1 << 62;
    }
    return value;
}

/* Adds x. Returns false if the sum is saturated. */
static inline bool sum_add(GLOBAL struct sum *s, float x)
{
    return sum_join(s, sum_of(x));
}

/* Returns x - part, for sums of which one is a part of the other. */
static inline struct sum sum_without(struct sum x, struct sum part)
{
    struct sum rest = {x.lo - part.lo,
                       x.hi - part.hi - (x.lo < part.lo ? 1 : 0)};

    return rest;
}

/* Converts the sum to a float. The fraction is converted as a signed number; if
 * it is too large for that it is halved first and rounded to odd, which gives
 * the same float without an unpredictable branch. */
static inline float sum_float(struct sum s)
{
    uint64_t top = s.lo >> 63;
    int64_t fraction = (int64_t)(s.lo >> top | (s.lo & top));
    float unit = bits_float((uint32_t)(63 + top) << 23); /* 2^-64 or 2^-63 */

    return (float)s.hi + (float)fraction * unit;
}

#endif
