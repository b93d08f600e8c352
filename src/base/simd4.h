// SPDX-License-Identifier: MIT
/*
 * simd4.h - vectors of four floats: SSE2, or plain loops
 *
 * Arithmetic is that of floats, lane by lane, without contraction. A mask has
 * all bits of a lane set or none. simd8.h has the same functions for
 * eight floats, but not as a second use of one template: their bodies are
 * different intrinsics, and the halves without AVX2 are made of these four.
 */
#ifndef GLIM_SIMD4_H
#define GLIM_SIMD4_H

#include <math.h>
#include <stdint.h>

#if defined(__SSE2__)

#include <immintrin.h>

typedef __m128 f4;
typedef __m128 f4_mask;

static inline f4 f4_load(const float *p)
{
    return _mm_load_ps(p);
}

static inline void f4_store(float *p, f4 a)
{
    _mm_store_ps(p, a);
}

static inline f4 f4_set1(float x)
{
    return _mm_set1_ps(x);
}

static inline f4 f4_set3(float x, float y, float z)
{
    return _mm_set_ps(0.0f, z, y, x);
}

static inline f4 f4_add(f4 a, f4 b)
{
    return _mm_add_ps(a, b);
}

static inline f4 f4_sub(f4 a, f4 b)
{
    return _mm_sub_ps(a, b);
}

static inline f4 f4_mul(f4 a, f4 b)
{
    return _mm_mul_ps(a, b);
}

static inline f4 f4_div(f4 a, f4 b)
{
    return _mm_div_ps(a, b);
}

static inline f4 f4_abs(f4 a)
{
    return _mm_andnot_ps(_mm_set1_ps(-0.0f), a);
}

static inline f4 f4_min(f4 a, f4 b)
{
    return _mm_min_ps(a, b);
}

static inline f4 f4_max(f4 a, f4 b)
{
    return _mm_max_ps(a, b);
}

/* Returns a, with lanes above `most` set to 0. */
static inline f4 f4_zero_above(f4 a, f4 most)
{
    return _mm_and_ps(a, _mm_cmple_ps(a, most));
}

/* Converts integers below 2^31 to floats. */
static inline f4 f4_from_u32(const uint32_t *p)
{
    return _mm_cvtepi32_ps(_mm_load_si128((const void *)p));
}

/* Stores a truncated to integers, as f4_truncate(). */
static inline void f4_store_u32(uint32_t *p, f4 a)
{
    _mm_store_si128((void *)p, _mm_cvttps_epi32(a));
}

static inline f4 f4_truncate(f4 a)
{
    return _mm_cvtepi32_ps(_mm_cvttps_epi32(a));
}

/* Returns a0 a1 + a1 a2 + a2 a0: half the surface area of a box with these
 * sides. */
static inline float f4_pairs3(f4 a)
{
    f4 b = _mm_mul_ps(a, _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 0, 2, 1)));
    f4 second = _mm_shuffle_ps(b, b, _MM_SHUFFLE(1, 1, 1, 1));

    return _mm_cvtss_f32(
        _mm_add_ss(_mm_add_ss(b, second), _mm_movehl_ps(b, b)));
}

/* Transposes the first three lanes of three vectors. The last lane copies lane
 * 2. */
static inline void f4_transpose3(f4 a, f4 b, f4 c, f4 to[3])
{
    f4 low = _mm_unpacklo_ps(a, b), high = _mm_unpackhi_ps(a, b);

    to[0] = _mm_shuffle_ps(low, c, _MM_SHUFFLE(0, 0, 1, 0));
    to[1] = _mm_shuffle_ps(low, c, _MM_SHUFFLE(1, 1, 3, 2));
    to[2] = _mm_shuffle_ps(high, c, _MM_SHUFFLE(2, 2, 1, 0));
}

static inline f4_mask f4_le(f4 a, f4 b)
{
    return _mm_cmple_ps(a, b);
}

static inline f4_mask f4_lt(f4 a, f4 b)
{
    return _mm_cmplt_ps(a, b);
}

/* Returns the mask of lanes in which a, b and c are equal. */
static inline f4_mask f4_equal3(f4 a, f4 b, f4 c)
{
    return _mm_and_ps(_mm_cmpeq_ps(a, b), _mm_cmpeq_ps(a, c));
}

/* Returns the mask of integers equal to n. */
static inline f4_mask f4_equal_u32(const uint32_t *p, uint32_t n)
{
    return _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_load_si128((const void *)p),
                                            _mm_set1_epi32((int)n)));
}

static inline f4_mask f4_or(f4_mask a, f4_mask b)
{
    return _mm_or_ps(a, b);
}

static inline f4_mask f4_and(f4_mask a, f4_mask b)
{
    return _mm_and_ps(a, b);
}

/* Returns the lanes of a that are not in b. */
static inline f4_mask f4_but(f4_mask a, f4_mask b)
{
    return _mm_andnot_ps(b, a);
}

/* Returns a bit for each lane, lane 0 the lowest. */
static inline uint32_t f4_bits(f4_mask a)
{
    return (uint32_t)_mm_movemask_ps(a);
}

/* Selects x in the lanes of the mask, and y elsewhere. */
static inline f4 f4_select(f4_mask a, f4 x, f4 y)
{
    return _mm_or_ps(_mm_and_ps(a, x), _mm_andnot_ps(a, y));
}

#else

typedef struct {
    float v[4];
} f4;

typedef struct {
    uint32_t v[4];
} f4_mask;

#define F4_EACH(result, value)  \
    f4 result;                  \
    for (int i = 0; i < 4; i++) \
        result.v[i] = (value);  \
    return result

static inline f4 f4_load(const float *p)
{
    F4_EACH(r, p[i]);
}

static inline void f4_store(float *p, f4 a)
{
    for (int i = 0; i < 4; i++)
        p[i] = a.v[i];
}

static inline f4 f4_set1(float x)
{
    F4_EACH(r, x);
}

static inline f4 f4_set3(float x, float y, float z)
{
    f4 r = {{x, y, z, 0.0f}};

    return r;
}

static inline f4 f4_add(f4 a, f4 b)
{
    F4_EACH(r, a.v[i] + b.v[i]);
}

static inline f4 f4_sub(f4 a, f4 b)
{
    F4_EACH(r, a.v[i] - b.v[i]);
}

static inline f4 f4_mul(f4 a, f4 b)
{
    F4_EACH(r, a.v[i] * b.v[i]);
}

static inline f4 f4_div(f4 a, f4 b)
{
    F4_EACH(r, a.v[i] / b.v[i]);
}

static inline f4 f4_abs(f4 a)
{
    F4_EACH(r, fabsf(a.v[i]));
}

static inline f4 f4_min(f4 a, f4 b)
{
    F4_EACH(r, a.v[i] < b.v[i] ? a.v[i] : b.v[i]);
}

static inline f4 f4_max(f4 a, f4 b)
{
    F4_EACH(r, a.v[i] > b.v[i] ? a.v[i] : b.v[i]);
}

static inline f4 f4_zero_above(f4 a, f4 most)
{
    F4_EACH(r, a.v[i] <= most.v[i] ? a.v[i] : 0.0f);
}

static inline f4 f4_from_u32(const uint32_t *p)
{
    F4_EACH(r, (float)p[i]);
}

static inline void f4_store_u32(uint32_t *p, f4 a)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint32_t)a.v[i];
}

static inline f4 f4_truncate(f4 a)
{
    F4_EACH(r, (float)(uint32_t)a.v[i]);
}

static inline float f4_pairs3(f4 a)
{
    return a.v[0] * a.v[1] + a.v[1] * a.v[2] + a.v[2] * a.v[0];
}

static inline void f4_transpose3(f4 a, f4 b, f4 c, f4 to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = (f4){{a.v[i], b.v[i], c.v[i], c.v[i]}};
}

#define F4_MASK_EACH(is_set)                 \
    f4_mask r;                               \
    for (int i = 0; i < 4; i++)              \
        r.v[i] = (is_set) ? 0xffffffffu : 0; \
    return r

static inline f4_mask f4_le(f4 a, f4 b)
{
    F4_MASK_EACH(a.v[i] <= b.v[i]);
}

static inline f4_mask f4_lt(f4 a, f4 b)
{
    F4_MASK_EACH(a.v[i] < b.v[i]);
}

static inline f4_mask f4_equal3(f4 a, f4 b, f4 c)
{
    F4_MASK_EACH(a.v[i] == b.v[i] && a.v[i] == c.v[i]);
}

static inline f4_mask f4_equal_u32(const uint32_t *p, uint32_t n)
{
    F4_MASK_EACH(p[i] == n);
}

static inline f4_mask f4_or(f4_mask a, f4_mask b)
{
    F4_MASK_EACH((a.v[i] | b.v[i]) != 0);
}

static inline f4_mask f4_and(f4_mask a, f4_mask b)
{
    F4_MASK_EACH((a.v[i] & b.v[i]) != 0);
}

static inline f4_mask f4_but(f4_mask a, f4_mask b)
{
    F4_MASK_EACH((a.v[i] & ~b.v[i]) != 0);
}

static inline uint32_t f4_bits(f4_mask a)
{
    uint32_t bits = 0;

    for (int i = 0; i < 4; i++)
        bits |= (a.v[i] & 1u) << i;
    return bits;
}

static inline f4 f4_select(f4_mask a, f4 x, f4 y)
{
    F4_EACH(r, a.v[i] != 0 ? x.v[i] : y.v[i]);
}

#endif

#endif
