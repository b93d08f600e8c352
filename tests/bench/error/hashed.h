// SPDX-License-Identifier: MIT
/*
 * hashed.h - replaces Sobol points by hashed random numbers
 *
 * Units:     32-bit fractions of the unit square
 */
#ifndef ERROR_HASHED_H
#define ERROR_HASHED_H

#include "kernels/sobol.h"

static inline struct bits2 hashed_point(uint32_t reversed_index, uint32_t key)
{
    struct bits2 p;

    p.x = hash_u32(hash_u32(key + 0x9e3779b9u) ^ reversed_index);
    p.y = hash_u32(hash_u32(key + 0x3c6ef372u) ^ reversed_index);
    return p;
}

#define sobol_point hashed_point

#endif
