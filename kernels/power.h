// SPDX-License-Identifier: MIT
/*
 * power.h - powers and exponentials of + - x / only, so that they have the same
 * bits on the host and on each device
 *
 * Units:     relative errors below 1e-6
 */
#ifndef KERNELS_POWER_H
#define KERNELS_POWER_H

#include "kernels/vec.h"

#define LOG2_E 1.44269504f

/* Returns the binary logarithm of a normal number above 0. The mantissa is
 * within a factor of root 2 of 1, and log m = 2 artanh((m - 1) / (m + 1)). */
static inline float f_log2(float x)
{
    uint32_t bits = float_bits(x);
    float exponent = (float)((int)(bits >> 23) - 127);
    float m = bits_float((bits & 0x007fffffu) | 0x3f800000u);
    float f, f2;

    if (m > 1.41421356f) {
        m *= 0.5f;
        exponent += 1.0f;
    }
    f = (m - 1.0f) / (m + 1.0f);
    f2 = f * f;
    return exponent +
           2.0f * LOG2_E * f *
               (1.0f +
                f2 * (1.0f / 3.0f +
                      f2 * (0.2f + f2 * (1.0f / 7.0f + f2 * (1.0f / 9.0f)))));
}

/* Returns 2^x, 0 below 2^-126 and 2^126 at most. */
static inline float f_exp2(float x)
{
    float whole = floorf(f_min(x, 126.0f) + 0.5f);
    float t = (f_min(x, 126.0f) - whole) * 0.693147181f;
    float sum = 1.0f / 720.0f;

    if (!(x >= -126.0f))
        return 0.0f;
    sum = sum * t + 1.0f / 120.0f;
    sum = sum * t + 1.0f / 24.0f;
    sum = sum * t + 1.0f / 6.0f;
    sum = sum * t + 0.5f;
    sum = sum * t + 1.0f;
    sum = sum * t + 1.0f;
    return sum * bits_float((uint32_t)((int)whole + 127) << 23);
}

static inline float f_exp(float x)
{
    return f_exp2(x * LOG2_E);
}

/* Returns x^y for x of 0 or more, 0 for numbers that are not normal. */
static inline float f_pow(float x, float y)
{
    return x > 0x1p-126f ? f_exp2(y * f_log2(x)) : 0.0f;
}

#endif
