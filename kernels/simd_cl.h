// SPDX-License-Identifier: MIT
/*
 * simd_cl.h - vectors of four and eight floats in OpenCL C: the functions of
 * src/base/simd4.h and simd8.h that traverse.h needs
 */
#ifndef KERNELS_SIMD_CL_H
#define KERNELS_SIMD_CL_H

#include "kernels/vec.h"

typedef float4 f4;
typedef float8 f8;

typedef int4 f4_mask;
typedef int8 f8_mask;

static inline f4 f4_load(GLOBAL const float *p)
{
    return *(GLOBAL const float4 *)p;
}

static inline void f4_store(float *p, f4 a)
{
    *(float4 *)p = a;
}

static inline f4 f4_set1(float x)
{
    return (float4)x;
}

static inline f4 f4_add(f4 a, f4 b)
{
    return a + b;
}

static inline f4 f4_sub(f4 a, f4 b)
{
    return a - b;
}

static inline f4 f4_mul(f4 a, f4 b)
{
    return a * b;
}

static inline f4 f4_div(f4 a, f4 b)
{
    return a / b;
}

static inline f4 f4_abs(f4 a)
{
    return fabs(a);
}

static inline f4 f4_min(f4 a, f4 b)
{
    return a < b ? a : b;
}

static inline f4 f4_max(f4 a, f4 b)
{
    return a > b ? a : b;
}

static inline f4_mask f4_le(f4 a, f4 b)
{
    return a <= b;
}

static inline f4_mask f4_lt(f4 a, f4 b)
{
    return a < b;
}

static inline f4_mask f4_equal3(f4 a, f4 b, f4 c)
{
    return (a == b) & (a == c);
}

static inline f4_mask f4_equal_u32(GLOBAL const uint *p, uint n)
{
    return *(GLOBAL const uint4 *)p == (uint4)n;
}

static inline f4_mask f4_or(f4_mask a, f4_mask b)
{
    return a | b;
}

static inline f4_mask f4_and(f4_mask a, f4_mask b)
{
    return a & b;
}

static inline f4_mask f4_but(f4_mask a, f4_mask b)
{
    return a & ~b;
}

static inline uint f4_bits(f4_mask a)
{
    int4 bits = a & (int4)(1, 2, 4, 8);
    int2 pairs = bits.lo | bits.hi;

    return (uint)(pairs.x | pairs.y);
}

static inline f4 f4_select(f4_mask a, f4 x, f4 y)
{
    return a ? x : y;
}

static inline f8 f8_load(GLOBAL const void *p)
{
    return *(GLOBAL const float8 *)p;
}

static inline void f8_store(float *p, f8 a)
{
    *(float8 *)p = a;
}

static inline f8 f8_set1(float x)
{
    return (float8)x;
}

static inline f8 f8_mul_sub(f8 a, f8 b, f8 c)
{
    return a * b - c;
}

/* Distances are compared as integers, which have the order of positive
 * floats. */
static inline f8 f8_distance_max(f8 a, f8 b)
{
    return as_float8(max(as_int8(a), as_int8(b)));
}

static inline f8 f8_distance_min(f8 a, f8 b)
{
    return as_float8(min(as_int8(a), as_int8(b)));
}

static inline f8 f8_distance_add_ulps(f8 a, int steps)
{
    return as_float8(as_int8(a) + steps);
}

static inline f8_mask f8_distance_lt(f8 a, f8 b)
{
    return as_int8(a) < as_int8(b);
}

static inline uint f8_bits(f8_mask a)
{
    int8 bits = a & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    int4 fours = bits.lo | bits.hi;
    int2 pairs = fours.lo | fours.hi;

    return (uint)(pairs.x | pairs.y);
}

#endif
