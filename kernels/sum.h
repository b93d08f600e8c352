// SPDX-License-Identifier: MIT
/*
 * sum.h - exact sums of floats as 128-bit fixed point
 *
 * 64 fraction bits and 64 integer bits: the order in which samples are added
 * never matters, so threads, devices and restarts give the same bits.
 *
 * Units:     whatever is added
 * Ownership: none
 * Threads:   one owner for each sum
 * Errors:    none; the caller counts what sum_accepts() refuses
 */
#ifndef KERNELS_SUM_H
#define KERNELS_SUM_H

#include "kernels/dialect.h"

struct sum {
    uint64_t lo; /* units of 2^-64 */
    uint64_t hi; /* units of 1 */
};

/* False for NaN, infinities and negative numbers (-0 is 0). */
static inline bool sum_accepts(float x)
{
    return x >= 0.0f && x <= 3.402823466e38f;
}

/* Adds x, which sum_accepts(). Bits below 2^-64 are cut off; values above
 * 2^62 count as 2^62, and sums stop at 2^63. */
static inline void sum_add(GLOBAL struct sum *s, float x)
{
    uint32_t bits = float_bits(x) & 0x7fffffffu;
    uint32_t exponent = bits >> 23;
    uint64_t mantissa = bits & 0x7fffffu;
    uint64_t lo = 0;
    uint64_t hi = 0;
    int32_t shift; /* of the mantissa, against units of 2^-64 */

    if (exponent != 0)
        mantissa |= 0x800000u;
    else
        exponent = 1;
    shift = (int32_t)exponent - 150 + 64;
    if (shift <= -24)
        return;
    if (exponent >= 127 + 62) {
        hi = (uint64_t)1 << 62;
    } else if (shift < 0) {
        lo = mantissa >> (uint32_t)-shift;
    } else if (shift < 64) {
        lo = mantissa << (uint32_t)shift;
        if (shift > 40)
            hi = mantissa >> (uint32_t)(64 - shift);
    } else {
        hi = mantissa << (uint32_t)(shift - 64);
    }
    s->lo += lo;
    s->hi += hi + (s->lo < lo ? 1 : 0);
    if (s->hi >> 63) {
        s->hi = (uint64_t)1 << 63;
        s->lo = 0;
    }
}

/* sum / count, within two units in the last place. count is not 0. */
static inline float sum_mean(struct sum s, uint64_t count)
{
    return ((float)s.hi + (float)s.lo * 0x1p-64f) / (float)count;
}

#endif
