// SPDX-License-Identifier: MIT
/*
 * dialect.h - one language for a C11 compiler and an OpenCL C 1.2 compiler
 *
 * The only file with #ifdef about compilers. Kernel code is written in C
 * names; here they are mapped for the device.
 */
#ifndef KERNELS_DIALECT_H
#define KERNELS_DIALECT_H

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)

typedef int int32_t;
typedef ushort uint16_t;
typedef uint uint32_t;
typedef long int64_t;
typedef ulong uint64_t;

#define FLATTENED
#define VECTORISED
#define GLOBAL        __global
#define CONSTANT      __constant
#define sqrtf(x)      sqrt(x)
#define fabsf(x)      fabs(x)
#define floorf(x)     floor(x)
#define float_bits(x) as_uint(x)
#define bits_float(x) as_float(x)

#pragma OPENCL FP_CONTRACT OFF

#else

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* What such a function calls becomes part of it: walks through trees would not
 * keep their vectors in registers. */
#define FLATTENED  __attribute__((flatten))

/* Functions with loops over lanes, which would not become vector code with
 * calls in them; where they become part of others, it is chance whether a loop
 * is unrolled first. Not `inline`. */
#define VECTORISED __attribute__((noinline, flatten, unused))
#define GLOBAL
#define CONSTANT static const

static inline uint32_t float_bits(float x)
{
    uint32_t bits;

    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float bits_float(uint32_t bits)
{
    float x;

    memcpy(&x, &bits, sizeof x);
    return x;
}

#endif

#endif
