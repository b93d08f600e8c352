// SPDX-License-Identifier: MIT
/*
 * sobol.h - Owen-scrambled Sobol points in two dimensions
 *
 * The first two Sobol dimensions, shuffled and scrambled anew for each key
 * (Burley 2020, "Practical hash-based Owen scrambling", JCGT 9:4; hash by
 * Vegdahl 2021, psychopath.io, "Building a better LK hash"). Every prefix of
 * 2^m points is a (0, m, 2)-net: each box of area 2^-m whose sides are powers
 * of two has one point. Points of two keys are independent.
 *
 * Units:     32-bit fractions of the unit square
 */
#ifndef KERNELS_SOBOL_H
#define KERNELS_SOBOL_H

#include "kernels/dialect.h"

/* sobol_point(): one point. */
#define WORD     uint32_t
#define FN(name) name
#include "kernels/sobol_template.h"

#if HAS_WIDE_VECTORS
/* sobol_point_8(): eight points. */
#define WORD     u32x8
#define FN(name) name##_8
#include "kernels/sobol_template.h"
#endif

#endif
