// SPDX-License-Identifier: MIT
/*
 * dialect.h - maps the C names of kernel code to OpenCL C 1.2
 *
 * Kernel code is compiled as C11 for the CPU and as OpenCL C for a device. This
 * is the only file with #ifdef about compilers.
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
#define APART
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

/* Inlines all calls in such a function. Traversals of trees would not keep
 * their vectors in registers across calls. */
#define FLATTENED  __attribute__((flatten))

/* Marks functions with a loop over lanes that is to become vector code. Calls
 * in the loop would prevent that, so they are inlined. The function itself is
 * not, as the compiler may unroll the loop in the caller before it vectorises.
 * Such a function is `static`, not `static inline`. */
#define VECTORISED __attribute__((noinline, flatten, unused))

/* Keeps a function that few scenes need out of its caller, unless the build is
 * flattened into one: 1 % fewer instructions in most scenes. */
#ifdef FLATTEN
#define APART __attribute__((unused))
#else
#define APART __attribute__((noinline, unused))
#endif
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
