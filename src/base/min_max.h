// SPDX-License-Identifier: MIT
/*
 * min_max.h - the smaller and the larger of two whole numbers
 *
 * Threads: any
 */
#ifndef GLIM_MIN_MAX_H
#define GLIM_MIN_MAX_H

#include <stdint.h>

static inline int int_min(int a, int b)
{
    return a < b ? a : b;
}

static inline int int_max(int a, int b)
{
    return a > b ? a : b;
}

/* The nearest index of a row of `count` items. */
static inline int index_clamp(int i, int count)
{
    return int_min(int_max(i, 0), count - 1);
}

static inline uint32_t u32_max(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static inline uint32_t u32_min(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint64_t u64_min(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static inline uint64_t u64_max(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

#endif
