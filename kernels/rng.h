// SPDX-License-Identifier: MIT
/*
 * rng.h - random numbers as a function of (pixel, sample, dimension, seed)
 *
 * Each dimension of each pixel has an Owen-scrambled Sobol sequence of its own
 * over the samples (sobol.h): samples of a pixel are stratified, and pixels are
 * independent. Keys are hashed one after the other from a non-zero start;
 * adding or xor-ing them first would make neighbouring pixels share sequences.
 * After 2^32 samples a pixel starts new sequences.
 *
 * A picture has two such sequences in each pixel, the halves: sample i is
 * sample i / 2 of half i % 2. The halves are independent, so the variance of
 * the pixel can be estimated from their difference (film/film_error.h).
 * Within one sequence samples depend on each other, and every such estimate is
 * wrong. The two halves together have 4 to 18 % more variance than a single
 * sequence of as many samples.
 *
 * In a draft all pixels share the sequences. Pixels take samples from them in
 * the order of a Morton curve, whose indices the shuffle of sobol.h scrambles
 * as a tree: the samples of a square of pixels are stratified like those of one
 * pixel. So errors of neighbouring pixels cancel, and the picture has less
 * visible error (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of
 * Monte Carlo sampling error via hierarchical ordering of pixels"). This needs
 * the number of samples in advance. Sample 0 is a set by itself, and samples 1
 * to 4 are a second set. (One sample of a set of four would have no pattern
 * alone, and a set for each sample would let a pixel's samples clump.)
 *
 * A draft with halves has three sets: sample 0, samples 1 and 3, and samples 2
 * and 4. So its halves are independent, for the price of a third more variance.
 * Further samples, up to DRAFT_HALVES_SPP, are those of a picture of its own.
 *
 * Units:     numbers in [0, 1)
 */
#ifndef KERNELS_RNG_H
#define KERNELS_RNG_H

#include "kernels/sobol.h"
#include "kernels/vec.h"

/* Dimensions have fixed numbers, so that a new feature does not shift the
 * others. Those of a vertex begin at DIMENSION_STRIDE times its number, which
 * counts from 1. */
enum dimension {
    DIMENSION_PIXEL = 0,
    DIMENSION_LENS = 1,
    DIMENSION_CELL = 2,       /* of light_cells.h */
    DIMENSION_WAVELENGTH = 5, /* of dispersion.h */
    /* at a vertex: */
    DIMENSION_STRIDE = 8,
    DIMENSION_BOUNCE = DIMENSION_STRIDE,
    DIMENSION_LIGHT_POSITION = 0,
    DIMENSION_LIGHT_CHOICE = 1,
    DIMENSION_BSDF_DIRECTION = 2,
    DIMENSION_BSDF_LOBE = 3, /* and Russian roulette */
    DIMENSION_KINDS = 4,     /* of these, which are computed together */
    DIMENSION_MEDIUM = 4,    /* distance and channel of a collision */
    DIMENSION_SMOKE = 5,     /* distance and reality of a tentative one */
    DIMENSION_ENTRY = 6,     /* direction below the surface: subsurface.h */
    DIMENSION_WALK = 7       /* two for each step of a walk */
};

/* Samples of a pixel in a draft, in one with halves, and the longest side of a
 * draft in pixels: the index of a sample on the Morton curve has 32 bits. */
#define DRAFT_SPP        5u
#define DRAFT_HALVES_SPP 16u
#define DRAFT_SIDE_MAX   0x8000

struct sampler {
    uint32_t key; /* hash of the pixel, the seed and the upper 32 bits */
    uint32_t reversed_index; /* lower 32 bits of the sample index, reversed */
};

/* A number in [0, 1) from the top 24 bits. It is never 1. */
static inline float unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * 0x1p-24f;
}

#if HAS_WIDE_VECTORS
static inline f32x8 unit_float_8(u32x8 bits)
{
    return f32x8_of(bits >> 8) * 0x1p-24f;
}
#endif

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

/* Sampler of sample `index` of a pixel in a picture. */
static inline struct sampler sampler_start_half(uint32_t x, uint32_t y,
                                                uint64_t index, uint32_t seed)
{
    struct sampler s = sampler_start(x, y, index >> 1, seed);

    s.key = hash_u32(s.key ^ ((uint32_t)index & 1u));
    return s;
}

/* Inserts a zero between any two bits of a 16-bit number. */
static inline uint32_t spread_bits(uint32_t x)
{
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

/* Sampler of sample `index`, below DRAFT_SPP, of a pixel in a draft. */
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

/* The same in a draft with halves. */
static inline struct sampler
sampler_start_draft_half(uint32_t x, uint32_t y, uint32_t index, uint32_t seed)
{
    uint32_t rank = spread_bits(x) | spread_bits(y) << 1;
    struct sampler s;

    if (index >= DRAFT_SPP)
        return sampler_start_half(x, y, index - (DRAFT_SPP - 1u),
                                  seed + 0xc2b2ae35u);
    s.key = hash_u32(seed + 0xc2b2ae35u);
    if (index != 0) {
        s.key = hash_u32(s.key + (index & 1u));
        rank = rank << 1 | (index - 1u) >> 1;
    }
    s.reversed_index = reverse_bits(rank);
    return s;
}

static inline struct vec2 random_2d(struct sampler s, uint32_t dimension)
{
    struct bits2 p =
        sobol_point(s.reversed_index, dimension_key(s.key, dimension));

    return v2(unit_float(p.x), unit_float(p.y));
}

/* Random key of a ray, for partial coverage (traverse_leaf.h). vertex: where
 * the ray arrives, counted from 1. */
static inline uint32_t ray_key(struct sampler s, uint32_t vertex)
{
    uint32_t key = dimension_key(s.key, 0x40000000u + vertex);

    return hash_u32(key ^ s.reversed_index);
}

#endif
