// SPDX-License-Identifier: MIT
/*
 * rng.h - random numbers as a function of (pixel, sample, dimension, seed)
 *
 * Each dimension of each pixel is an Owen-scrambled Sobol sequence of its own
 * over the samples (sobol.h), so that a pixel's samples avoid each other and
 * pixels are independent. Keys are hashed one after the other from a non-zero
 * start: adding or xor-ing them first would make neighbouring pixels share
 * streams. After 2^32 samples a pixel starts other sequences.
 *
 * In a draft all pixels share the sequences, and take from them in the order of
 * a Morton curve. The shuffle of the indices is then a nested scramble of the
 * curve: the samples of a square of pixels avoid each other as those of one
 * pixel do. What neighbours have too much of and too little cancels, and to the
 * eye, which blurs, the error is smaller (Ahmed and Wonka 2020, "Screen-space
 * blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering
 * of pixels"). That needs the number of samples in advance: sample 0 is a set
 * by itself, the next four are another. (Alone, one of a set of four has no
 * pattern at all; a set for each would let a pixel's samples clump.)
 *
 * Units:     numbers in [0, 1)
 */
#ifndef KERNELS_RNG_H
#define KERNELS_RNG_H

#include "kernels/sobol.h"
#include "kernels/vec.h"

/* Fixed dimensions: adding a feature does not shift the others. */
enum dimension {
    DIMENSION_PIXEL = 0,
    DIMENSION_LENS = 1,
    /* times a vertex's number, the first of which is 1, and one of the last */
    DIMENSION_STRIDE = 8,
    DIMENSION_BOUNCE = DIMENSION_STRIDE,
    DIMENSION_LIGHT_POSITION = 0,
    DIMENSION_LIGHT_CHOICE = 1,
    DIMENSION_BSDF_DIRECTION = 2,
    DIMENSION_BSDF_LOBE = 3, /* and roulette */
    DIMENSION_KINDS = 4      /* of those at a vertex */
};

/* Samples of a pixel in a draft, and its longest side: a pixel and one of four
 * samples are 32 bits. */
#define DRAFT_SPP      5u
#define DRAFT_SIDE_MAX 0x8000

struct sampler {
    uint32_t key;            /* of the pixel, the seed and the index's top */
    uint32_t reversed_index; /* the low 32 bits, the lowest first */
};

/* The top 24 bits: never 1. */
static inline float unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * 0x1p-24f;
}

static inline struct sampler sampler_start(uint32_t x, uint32_t y,
                                           uint64_t index, uint32_t seed)
{
    struct sampler s;

    s.key = hash_u32(x + 0x9e3779b9u);
    s.key = hash_u32(s.key ^ y);
    s.key = hash_u32(s.key ^ seed);
    s.key = hash_u32(s.key ^ (uint32_t)(index >> 32));
    s.reversed_index = reverse_bits((uint32_t)index);
    return s;
}

/* The bits of a 16-bit number with zeros between them. */
static inline uint32_t spread_bits(uint32_t x)
{
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

/* Sample `index`, below DRAFT_SPP, of a pixel in a draft. */
static inline struct sampler sampler_start_draft(uint32_t x, uint32_t y,
                                                 uint32_t index, uint32_t seed)
{
    uint32_t rank = spread_bits(x) | spread_bits(y) << 1;
    struct sampler s;

    s.key = hash_u32(seed + 0xc2b2ae35u);
    if (index != 0) {
        s.key = hash_u32(s.key);
        rank = rank << 2 | (index - 1);
    }
    s.reversed_index = reverse_bits(rank);
    return s;
}

static inline uint32_t dimension_key(struct sampler s, uint32_t dimension)
{
    return hash_u32(s.key ^ (dimension + 0x85ebca6bu));
}

static inline struct vec2 random_2d(struct sampler s, uint32_t dimension)
{
    struct bits2 p = sobol_point(s.reversed_index, dimension_key(s, dimension));

    return v2(unit_float(p.x), unit_float(p.y));
}

/* For decisions at holes on the ray that leaves the camera or a vertex. */
static inline uint32_t ray_key(struct sampler s, uint32_t vertex)
{
    uint32_t key = dimension_key(s, 0x40000000u + vertex);

    return hash_u32(key ^ s.reversed_index);
}

#endif
