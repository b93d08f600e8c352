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

struct bits2 {
    uint32_t x, y;
};

/* Integer hash: xor-shift-multiply in two rounds with low bias (constants by
 * Ettinger for Wellons' hash prospector). */
static inline uint32_t hash_u32(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x21f0aaadu;
    h ^= h >> 15;
    h *= 0xd35a2d97u;
    h ^= h >> 15;
    return h;
}

/* Takes bits of a where the mask has 1, of b elsewhere. One instruction of
 * AVX-512. */
static inline uint32_t merge_bits(uint32_t mask, uint32_t a, uint32_t b)
{
    return ((a ^ b) & mask) ^ b;
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = merge_bits(0x55555555u, x >> 1, x << 1);
    x = merge_bits(0x33333333u, x >> 2, x << 2);
    x = merge_bits(0x0f0f0f0fu, x >> 4, x << 4);
    return x >> 24 | (x >> 8 & 0xff00u) | (x & 0xff00u) << 8 | x << 24;
}

/* Laine-Karras permutation: each bit is flipped depending on the lower bits. It
 * is an Owen scramble of the number whose bits are reversed. */
static inline uint32_t laine_karras_permutation(uint32_t x, uint32_t key)
{
    x ^= x * 0x3d20adeau;
    x += key;
    x *= key >> 16 | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The second Sobol dimension of a point, lowest bit first: p times Pascal's
 * triangle modulo 2 as a matrix. */
static inline uint32_t pascal_bits(uint32_t p)
{
    p ^= p >> 1 & 0x55555555u;
    p ^= p >> 2 & 0x33333333u;
    p ^= p >> 4 & 0x0f0f0f0fu;
    p ^= p >> 8 & 0x00ff00ffu;
    return p ^ p >> 16;
}

/* The scrambled point of an index, which is given with its bits reversed. */
static inline struct bits2 sobol_point(uint32_t reversed_index, uint32_t key)
{
    uint32_t i = reverse_bits(laine_karras_permutation(reversed_index, key));
    uint32_t key_x = hash_u32(key + 0x9e3779b9u);
    uint32_t key_y = hash_u32(key + 0x3c6ef372u);
    struct bits2 p;

    p.x = reverse_bits(laine_karras_permutation(i, key_x));
    p.y = reverse_bits(laine_karras_permutation(pascal_bits(i), key_y));
    return p;
}

#endif
