// SPDX-License-Identifier: MIT
/*
 * simd.h - four and eight floats at once: AVX2, SSE2, or plain loops
 *
 * f4 and f8 are the arithmetic of floats, lane by lane, without contraction,
 * but for what is about distances, which need not have the same bits
 * everywhere: f8_mul_sub rounds once or twice; of two negative numbers f8_later
 * and f8_sooner return any, and f8_before is for a first number that is not
 * negative; f8_further goes on by so many floats, or a little more. Masks have
 * a bit a lane, lane 0 the lowest.
 *
 * Units:     none
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef GLIM_SIMD_H
#define GLIM_SIMD_H

#include <math.h>
#include <stdint.h>

#if defined(__SSE2__)

#include <immintrin.h>

typedef __m128 f4;

static inline f4 f4_load(const float *p)
{
    return _mm_load_ps(p);
}

static inline void f4_store(float *p, f4 a)
{
    _mm_store_ps(p, a);
}

static inline f4 f4_all(float x)
{
    return _mm_set1_ps(x);
}

static inline f4 f4_of(float x, float y, float z)
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

/* 0 where it is above the most. */
static inline f4 f4_up_to(f4 a, f4 most)
{
    return _mm_and_ps(a, _mm_cmple_ps(a, most));
}

/* Of whole numbers below 2^31. */
static inline f4 f4_of_counts(const uint32_t *p)
{
    return _mm_cvtepi32_ps(_mm_load_si128((const void *)p));
}

/* Without what is behind the point, as f4_whole(). */
static inline void f4_store_counts(uint32_t *p, f4 a)
{
    _mm_store_si128((void *)p, _mm_cvttps_epi32(a));
}

static inline f4 f4_whole(f4 a)
{
    return _mm_cvtepi32_ps(_mm_cvttps_epi32(a));
}

/* The sum of the products of two of the first three numbers. */
static inline float f4_pairs3(f4 a)
{
    f4 b = _mm_mul_ps(a, _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 0, 2, 1)));
    f4 second = _mm_shuffle_ps(b, b, _MM_SHUFFLE(1, 1, 1, 1));

    return _mm_cvtss_f32(
        _mm_add_ss(_mm_add_ss(b, second), _mm_movehl_ps(b, b)));
}

/* Of three vectors all first numbers, all second and all third ones; the last
 * lane is as the one before. */
static inline void f4_transpose(f4 a, f4 b, f4 c, f4 to[3])
{
    f4 low = _mm_unpacklo_ps(a, b), high = _mm_unpackhi_ps(a, b);

    to[0] = _mm_shuffle_ps(low, c, _MM_SHUFFLE(0, 0, 1, 0));
    to[1] = _mm_shuffle_ps(low, c, _MM_SHUFFLE(1, 1, 3, 2));
    to[2] = _mm_shuffle_ps(high, c, _MM_SHUFFLE(2, 2, 1, 0));
}

static inline uint32_t f4_not_above(f4 a, f4 b)
{
    return (uint32_t)_mm_movemask_ps(_mm_cmple_ps(a, b));
}

static inline uint32_t f4_below(f4 a, f4 b)
{
    return (uint32_t)_mm_movemask_ps(_mm_cmplt_ps(a, b));
}

/* Where a, b and c are the same. */
static inline uint32_t f4_same(f4 a, f4 b, f4 c)
{
    return (uint32_t)_mm_movemask_ps(
        _mm_and_ps(_mm_cmpeq_ps(a, b), _mm_cmpeq_ps(a, c)));
}

/* Where one of four numbers is n. */
static inline uint32_t f4_which(const uint32_t *p, uint32_t n)
{
    __m128i same = _mm_cmpeq_epi32(_mm_load_si128((const void *)p),
                                   _mm_set1_epi32((int)n));

    return (uint32_t)_mm_movemask_ps(_mm_castsi128_ps(same));
}

/* There x, y elsewhere. */
static inline f4 f4_if_same(f4 a, f4 b, f4 c, f4 x, f4 y)
{
    f4 same = _mm_and_ps(_mm_cmpeq_ps(a, b), _mm_cmpeq_ps(a, c));

    return _mm_or_ps(_mm_and_ps(same, x), _mm_andnot_ps(same, y));
}

#else

typedef struct {
    float v[4];
} f4;

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

static inline f4 f4_all(float x)
{
    F4_EACH(r, x);
}

static inline f4 f4_of(float x, float y, float z)
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

static inline f4 f4_up_to(f4 a, f4 most)
{
    F4_EACH(r, a.v[i] <= most.v[i] ? a.v[i] : 0.0f);
}

static inline f4 f4_of_counts(const uint32_t *p)
{
    F4_EACH(r, (float)p[i]);
}

static inline void f4_store_counts(uint32_t *p, f4 a)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint32_t)a.v[i];
}

static inline f4 f4_whole(f4 a)
{
    F4_EACH(r, (float)(uint32_t)a.v[i]);
}

static inline float f4_pairs3(f4 a)
{
    return a.v[0] * a.v[1] + a.v[1] * a.v[2] + a.v[2] * a.v[0];
}

static inline void f4_transpose(f4 a, f4 b, f4 c, f4 to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = (f4){{a.v[i], b.v[i], c.v[i], c.v[i]}};
}

static inline uint32_t f4_not_above(f4 a, f4 b)
{
    uint32_t mask = 0;

    for (int i = 0; i < 4; i++)
        mask |= (a.v[i] <= b.v[i] ? 1u : 0u) << i;
    return mask;
}

static inline uint32_t f4_below(f4 a, f4 b)
{
    uint32_t mask = 0;

    for (int i = 0; i < 4; i++)
        mask |= (a.v[i] < b.v[i] ? 1u : 0u) << i;
    return mask;
}

static inline uint32_t f4_same(f4 a, f4 b, f4 c)
{
    uint32_t mask = 0;

    for (int i = 0; i < 4; i++)
        mask |= (a.v[i] == b.v[i] && a.v[i] == c.v[i] ? 1u : 0u) << i;
    return mask;
}

static inline uint32_t f4_which(const uint32_t *p, uint32_t n)
{
    uint32_t mask = 0;

    for (int i = 0; i < 4; i++)
        mask |= (p[i] == n ? 1u : 0u) << i;
    return mask;
}

static inline f4 f4_if_same(f4 a, f4 b, f4 c, f4 x, f4 y)
{
    F4_EACH(r, a.v[i] == b.v[i] && a.v[i] == c.v[i] ? x.v[i] : y.v[i]);
}

#endif

#if defined(__AVX2__)

typedef __m256 f8;

static inline f8 f8_load(const float *p)
{
    return _mm256_load_ps(p);
}

static inline void f8_store(float *p, f8 a)
{
    _mm256_store_ps(p, a);
}

static inline f8 f8_all(float x)
{
    return _mm256_set1_ps(x);
}

static inline f8 f8_add(f8 a, f8 b)
{
    return _mm256_add_ps(a, b);
}

static inline f8 f8_sub(f8 a, f8 b)
{
    return _mm256_sub_ps(a, b);
}

static inline f8 f8_mul(f8 a, f8 b)
{
    return _mm256_mul_ps(a, b);
}

static inline f8 f8_div(f8 a, f8 b)
{
    return _mm256_div_ps(a, b);
}

static inline f8 f8_abs(f8 a)
{
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a);
}

static inline f8 f8_min(f8 a, f8 b)
{
    return _mm256_min_ps(a, b);
}

static inline f8 f8_max(f8 a, f8 b)
{
    return _mm256_max_ps(a, b);
}

static inline uint32_t f8_not_above(f8 a, f8 b)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OS));
}

static inline uint32_t f8_below(f8 a, f8 b)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OS));
}

static inline f8 f8_are_same(f8 a, f8 b, f8 c)
{
    return _mm256_and_ps(_mm256_cmp_ps(a, b, _CMP_EQ_OQ),
                         _mm256_cmp_ps(a, c, _CMP_EQ_OQ));
}

static inline uint32_t f8_same(f8 a, f8 b, f8 c)
{
    return (uint32_t)_mm256_movemask_ps(f8_are_same(a, b, c));
}

static inline f8 f8_if_same(f8 a, f8 b, f8 c, f8 x, f8 y)
{
    return _mm256_blendv_ps(y, x, f8_are_same(a, b, c));
}

static inline f8 f8_mul_sub(f8 a, f8 b, f8 c)
{
#if defined(__FMA__)
    return _mm256_fmsub_ps(a, b, c);
#else
    return _mm256_sub_ps(_mm256_mul_ps(a, b), c);
#endif
}

/* The bits of positive floats sort as these do, and integers are compared in a
 * quarter of the time. */
static inline f8 f8_later(f8 a, f8 b)
{
    return _mm256_castsi256_ps(
        _mm256_max_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
}

static inline f8 f8_sooner(f8 a, f8 b)
{
    return _mm256_castsi256_ps(
        _mm256_min_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
}

static inline f8 f8_further(f8 a, int steps)
{
    return _mm256_castsi256_ps(
        _mm256_add_epi32(_mm256_castps_si256(a), _mm256_set1_epi32(steps)));
}

static inline uint32_t f8_before(f8 a, f8 b)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(
        _mm256_cmpgt_epi32(_mm256_castps_si256(b), _mm256_castps_si256(a))));
}

#else

typedef struct {
    f4 lo, hi;
} f8;

static inline f8 f8_load(const float *p)
{
    return (f8){f4_load(p), f4_load(p + 4)};
}

static inline void f8_store(float *p, f8 a)
{
    f4_store(p, a.lo);
    f4_store(p + 4, a.hi);
}

static inline f8 f8_all(float x)
{
    return (f8){f4_all(x), f4_all(x)};
}

static inline f8 f8_add(f8 a, f8 b)
{
    return (f8){f4_add(a.lo, b.lo), f4_add(a.hi, b.hi)};
}

static inline f8 f8_sub(f8 a, f8 b)
{
    return (f8){f4_sub(a.lo, b.lo), f4_sub(a.hi, b.hi)};
}

static inline f8 f8_mul(f8 a, f8 b)
{
    return (f8){f4_mul(a.lo, b.lo), f4_mul(a.hi, b.hi)};
}

static inline f8 f8_div(f8 a, f8 b)
{
    return (f8){f4_div(a.lo, b.lo), f4_div(a.hi, b.hi)};
}

static inline f8 f8_abs(f8 a)
{
    return (f8){f4_abs(a.lo), f4_abs(a.hi)};
}

static inline f8 f8_min(f8 a, f8 b)
{
    return (f8){f4_min(a.lo, b.lo), f4_min(a.hi, b.hi)};
}

static inline f8 f8_max(f8 a, f8 b)
{
    return (f8){f4_max(a.lo, b.lo), f4_max(a.hi, b.hi)};
}

static inline uint32_t f8_not_above(f8 a, f8 b)
{
    return f4_not_above(a.lo, b.lo) | f4_not_above(a.hi, b.hi) << 4;
}

static inline uint32_t f8_below(f8 a, f8 b)
{
    return f4_below(a.lo, b.lo) | f4_below(a.hi, b.hi) << 4;
}

static inline uint32_t f8_same(f8 a, f8 b, f8 c)
{
    return f4_same(a.lo, b.lo, c.lo) | f4_same(a.hi, b.hi, c.hi) << 4;
}

static inline f8 f8_if_same(f8 a, f8 b, f8 c, f8 x, f8 y)
{
    return (f8){f4_if_same(a.lo, b.lo, c.lo, x.lo, y.lo),
                f4_if_same(a.hi, b.hi, c.hi, x.hi, y.hi)};
}

static inline f8 f8_mul_sub(f8 a, f8 b, f8 c)
{
    return f8_sub(f8_mul(a, b), c);
}

static inline f8 f8_later(f8 a, f8 b)
{
    return f8_max(a, b);
}

static inline f8 f8_sooner(f8 a, f8 b)
{
    return f8_min(a, b);
}

static inline f8 f8_further(f8 a, int steps)
{
    return f8_mul(a, f8_all(1.0f + (float)steps * 0x1p-23f));
}

static inline uint32_t f8_before(f8 a, f8 b)
{
    return f8_below(a, b);
}

#endif

#endif
