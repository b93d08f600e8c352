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

/* Vectors of eight numbers. Both compilers know the operators of C for them. */
#define HAS_WIDE_VECTORS 1
typedef uint8 u32x8;
typedef float8 f32x8;

#define APART
#define INLINED     inline
#define RARE        inline
#define ALIGNED(n)  __attribute__((aligned(n)))
#define PREFETCH(p) (void)(p)
#define UNROLLED    _Pragma("unroll")
#define GLOBAL      __global
#define CONSTANT    __constant
#define sqrtf(x)    sqrt(x)
#define fabsf(x)    fabs(x)
#ifdef __clang__ /* one instruction, where PoCL's floor() takes fifteen */
#define floorf(x) __builtin_floorf(x)
#else
#define floorf(x) floor(x)
#endif
#define float_bits(x) as_uint(x)
#define bits_float(x) as_float(x)

static inline f32x8 f32x8_of(u32x8 x)
{
    return convert_float8(as_int8(x));
}

static inline void f32x8_store(float *to, f32x8 x)
{
    vstore8(x, 0, to);
}

/* That of PoCL takes ten instructions. */
static inline float copysignf(float x, float y)
{
    return as_float((as_uint(x) & 0x7fffffffu) | (as_uint(y) & 0x80000000u));
}

static inline uint lowest_bit(uint mask)
{
    return popcount(~mask & (mask - 1));
}

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

#ifdef __AVX2__
#define HAS_WIDE_VECTORS 1
typedef uint32_t u32x8 __attribute__((vector_size(32)));
typedef int32_t i32x8 __attribute__((vector_size(32)));
typedef float f32x8 __attribute__((vector_size(32)));

/* Converts integers below 2^31. */
static inline f32x8 f32x8_of(u32x8 x)
{
    return __builtin_convertvector((i32x8)x, f32x8);
}

static inline void f32x8_store(float *to, f32x8 x)
{
    memcpy(to, &x, sizeof x);
}
#else
#define HAS_WIDE_VECTORS 0
#endif

/* Keeps a function out of its caller, unless the build is flattened into one:
 * few scenes need it, or registers do not suffice for both. Each has 1 % fewer
 * instructions in most scenes. */
#ifdef FLATTEN
#define APART __attribute__((unused))
#else
#define APART __attribute__((noinline, unused))
#endif

/* Inlines a function into every caller: those of the walks through trees. */
#define INLINED inline __attribute__((always_inline))

/* Keeps a function out of its callers, with all that it calls. */
#define RARE    __attribute__((noinline, flatten, unused))

#define ALIGNED(n)  _Alignas(n)
#define PREFETCH(p) __builtin_prefetch(p)
#define UNROLLED
#define GLOBAL
#define CONSTANT static const

/* The number of the lowest bit of a mask, which is not 0. */
static inline uint32_t lowest_bit(uint32_t mask)
{
    return (uint32_t)__builtin_ctz(mask);
}

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
