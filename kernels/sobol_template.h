// SPDX-License-Identifier: MIT
/*
 * sobol_template.h - Owen-scrambled Sobol points in two dimensions
 *
 * This file is a template: sobol.h includes it for one point, and for eight in
 * the lanes of a vector. WORD is the type of 32-bit integers, and FN(name) the
 * name of a function for that type.
 *
 * Units:     32-bit fractions of the unit square
 */

/* The coordinates of a point. */
struct FN(bits2) {
    WORD x, y;
};

/* Integer hash: xor-shift-multiply in two rounds with low bias (constants by
 * Ettinger for Wellons' hash prospector). */
static inline WORD FN(hash_u32)(WORD h)
{
    h ^= h >> 16;
    h *= 0x21f0aaadu;
    h ^= h >> 15;
    h *= 0xd35a2d97u;
    h ^= h >> 15;
    return h;
}

/* The key of a dimension of points that have `key`. */
static inline WORD FN(dimension_key)(uint32_t key, WORD dimension)
{
    return FN(hash_u32)(key ^ (dimension + 0x85ebca6bu));
}

/* Takes bits of a where the mask has 1, of b elsewhere. One instruction of
 * AVX-512. */
static inline WORD FN(merge_bits)(uint32_t mask, WORD a, WORD b)
{
    return ((a ^ b) & mask) ^ b;
}

static inline WORD FN(reverse_bits)(WORD x)
{
    x = FN(merge_bits)(0x55555555u, x >> 1, x << 1);
    x = FN(merge_bits)(0x33333333u, x >> 2, x << 2);
    x = FN(merge_bits)(0x0f0f0f0fu, x >> 4, x << 4);
    return x >> 24 | (x >> 8 & 0xff00u) | (x & 0xff00u) << 8 | x << 24;
}

/* Laine-Karras permutation: each bit is flipped depending on the lower bits. It
 * is an Owen scramble of the number whose bits are reversed. */
static inline WORD FN(laine_karras_permutation)(WORD x, WORD key)
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
static inline WORD FN(pascal_bits)(WORD p)
{
    p ^= p >> 1 & 0x55555555u;
    p ^= p >> 2 & 0x33333333u;
    p ^= p >> 4 & 0x0f0f0f0fu;
    p ^= p >> 8 & 0x00ff00ffu;
    return p ^ p >> 16;
}

/* The scrambled point of an index, which is given with its bits reversed. */
static inline struct FN(bits2) FN(sobol_point)(WORD reversed_index, WORD key)
{
    WORD i =
        FN(reverse_bits)(FN(laine_karras_permutation)(reversed_index, key));
    WORD key_x = FN(hash_u32)(key + 0x9e3779b9u);
    WORD key_y = FN(hash_u32)(key + 0x3c6ef372u);
    struct FN(bits2) p;

    p.x = FN(reverse_bits)(FN(laine_karras_permutation)(i, key_x));
    p.y = FN(reverse_bits)(
        FN(laine_karras_permutation)(FN(pascal_bits)(i), key_y));
    return p;
}

#undef WORD
#undef FN
