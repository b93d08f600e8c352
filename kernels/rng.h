// SPDX-License-Identifier: MIT
/*
 * rng.h - random numbers as a function of (pixel, sample, dimension, seed)
 *
 * The hash is xor-shift-multiply in two rounds with low bias (constants by
 * Ettinger for Wellons' hash prospector). Keys are hashed one after the other
 * from a non-zero start: adding or xor-ing them first would make neighbouring
 * pixels share streams.
 *
 * Units:     numbers in [0, 1)
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef KERNELS_RNG_H
#define KERNELS_RNG_H

#include "kernels/vec.h"

/* Fixed dimensions: adding a feature does not shift the others. */
enum dimension {
    DIMENSION_PIXEL = 0,
    DIMENSION_LENS = 1,
    DIMENSION_BOUNCE = 8, /* + 8 b + one of the following for bounce b */
    DIMENSION_STRIDE = 8,
    DIMENSION_LIGHT_POSITION = 0,
    DIMENSION_LIGHT_CHOICE = 1,
    DIMENSION_BSDF_DIRECTION = 2,
    DIMENSION_BSDF_LOBE = 3 /* and roulette */
};

struct sampler {
    uint32_t pixel_key;
    uint32_t index_key;
};

static inline uint32_t hash_u32(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x21f0aaadu;
    h ^= h >> 15;
    h *= 0xd35a2d97u;
    h ^= h >> 15;
    return h;
}

/* The top 24 bits: never 1. */
static inline float unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * 0x1p-24f;
}

static inline struct sampler sampler_start(uint32_t x, uint32_t y,
                                           uint64_t index, uint32_t seed)
{
    struct sampler s;

    s.pixel_key = hash_u32(x + 0x9e3779b9u);
    s.pixel_key = hash_u32(s.pixel_key ^ y);
    s.pixel_key = hash_u32(s.pixel_key ^ seed);
    s.index_key = hash_u32((uint32_t)(index >> 32) + 0x7f4a7c15u);
    s.index_key = hash_u32(s.index_key ^ (uint32_t)index);
    return s;
}

static inline uint32_t random_bits(struct sampler s, uint32_t dimension)
{
    uint32_t h = hash_u32(s.pixel_key ^ (dimension + 0x85ebca6bu));

    return hash_u32(h ^ s.index_key);
}

static inline struct vec2 random_2d(struct sampler s, uint32_t dimension)
{
    uint32_t first = random_bits(s, dimension);

    return v2(unit_float(first), unit_float(hash_u32(first + 0x9e3779b9u)));
}

/* For decisions at holes on the ray that leaves the camera or a vertex. */
static inline uint32_t ray_key(struct sampler s, uint32_t vertex)
{
    return random_bits(s, 0x40000000u + vertex);
}

#endif
