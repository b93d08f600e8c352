// SPDX-License-Identifier: MIT
/*
 * vec.h - vectors of three floats, and functions that both compilers compute
 * with the same bits
 *
 * Polynomials are those of the Cephes library (Moshier 1989), errors below 2e-7
 * on their ranges.
 *
 * Units:     radians, or turns where a name says so
 */
#ifndef KERNELS_VEC_H
#define KERNELS_VEC_H

#include "kernels/types.h"

#define PI        3.14159265358979f
#define FLOAT_MAX 3.402823466e38f

/* The largest random number that unit_float() returns. */
#define UNIT_FLOAT_MAX (1.0f - 0x1p-24f)

/* Minimum and maximum. The result is b if either is NaN, so the value that may
 * be NaN comes first. */
static inline float f_min(float a, float b)
{
    return a < b ? a : b;
}

static inline float f_max(float a, float b)
{
    return a > b ? a : b;
}

static inline struct vec3 v3(float x, float y, float z)
{
    struct vec3 v = {x, y, z};

    return v;
}

static inline struct vec3 v3_add(struct vec3 a, struct vec3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct vec3 v3_sub(struct vec3 a, struct vec3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct vec3 v3_mul(struct vec3 a, struct vec3 b)
{
    return v3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline struct vec3 v3_scale(struct vec3 a, float s)
{
    return v3(a.x * s, a.y * s, a.z * s);
}

static inline struct vec3 v3_neg(struct vec3 a)
{
    return v3(-a.x, -a.y, -a.z);
}

static inline float v3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 v3_cross(struct vec3 a, struct vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
              a.x * b.y - a.y * b.x);
}

static inline float v3_length(struct vec3 a)
{
    return sqrtf(v3_dot(a, a));
}

/* The unit vector along a, which is not 0. */
static inline struct vec3 v3_unit(struct vec3 a)
{
    return v3_scale(a, 1.0f / v3_length(a));
}

/* v3_unit() of a vector that has unit length up to rounding: one Newton step
 * instead of a root and a division. */
static inline struct vec3 v3_unit_again(struct vec3 a)
{
    return v3_scale(a, 1.5f - 0.5f * v3_dot(a, a));
}

static inline float v3_max_component(struct vec3 a)
{
    return f_max(a.x, f_max(a.y, a.z));
}

/* True if all components are +0 or -0. One comparison, of all bits but the
 * signs. */
static inline bool v3_is_zero(struct vec3 a)
{
    return (float_bits(a.x) | float_bits(a.y) | float_bits(a.z)) << 1 == 0;
}

/* Componentwise minimum and maximum. */
static inline struct vec3 v3_min(struct vec3 a, struct vec3 b)
{
    return v3(f_min(a.x, b.x), f_min(a.y, b.y), f_min(a.z, b.z));
}

static inline struct vec3 v3_max(struct vec3 a, struct vec3 b)
{
    return v3(f_max(a.x, b.x), f_max(a.y, b.y), f_max(a.z, b.z));
}

/* Linear interpolation, componentwise. */
static inline struct vec3 v3_lerp(struct vec3 a, struct vec3 b, float s)
{
    return v3_add(a, v3_scale(v3_sub(b, a), s));
}

static inline struct vec2 v2(float x, float y)
{
    struct vec2 v = {x, y};

    return v;
}

/* Sine and cosine for |x| <= pi/4. */
static inline float sin_small(float x)
{
    float z = x * x;

    return ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) *
               z * x +
           x;
}

static inline float cos_small(float x)
{
    float z = x * x;

    return ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z +
            4.166664568298827e-2f) *
               z * z -
           0.5f * z + 1.0f;
}

/* -1 if is_minus, else 1. Without a branch: processors cannot predict the sides
 * of surfaces, and a misprediction costs as much as a square root. */
static inline float minus_if(bool is_minus)
{
    return bits_float(0x3f800000u | (uint32_t)is_minus << 31);
}

/* Exchanges x and y if is_swapped, without a branch for the same reason. */
static inline struct vec2 v2_swap_if(bool is_swapped, struct vec2 v)
{
    uint32_t x = float_bits(v.x), y = float_bits(v.y);
    uint32_t changes = (x ^ y) & (0u - (uint32_t)is_swapped);

    return v2(bits_float(x ^ changes), bits_float(y ^ changes));
}

/* (cosine, sine) of an angle of u turns, u in [0, 1]. Without branches, as no
 * processor can predict the quadrant. */
static inline struct vec2 cos_sin_turns(float u)
{
    float quarter = floorf(u * 4.0f + 0.5f);
    float x = (u * 4.0f - quarter) * (PI * 0.5f);
    uint32_t q = (uint32_t)(int32_t)quarter;
    struct vec2 v = v2_swap_if((q & 1u) != 0, v2(cos_small(x), sin_small(x)));

    return v2(minus_if(((q + 1u) & 2u) != 0) * v.x,
              minus_if((q & 2u) != 0) * v.y);
}

/* Unit vector of cosine z to the z axis, at an azimuth of u turns. */
static inline struct vec3 v3_around_z(float z, float u)
{
    float r = sqrtf(f_max((1.0f - z) * (1.0f + z), 0.0f));
    struct vec2 turn = cos_sin_turns(u);

    return v3(r * turn.x, r * turn.y, z);
}

/* Angle of the point (x, y), in (-pi, pi]; 0 for (0, 0). Without branches, as
 * no processor can predict the octant: a number minus 0 or divided by 1 keeps
 * its bits. */
static inline float atan2_rad(float y, float x)
{
    bool is_steep = !(fabsf(y) <= fabsf(x));
    float most = f_max(fabsf(x), fabsf(y));
    float r = f_min(fabsf(x), fabsf(y)) / (most + (most == 0.0f ? 1.0f : 0.0f));
    float is_wide = r > 0.41421356f ? 1.0f : 0.0f; /* tan(pi/8) */
    float z, a;

    r = (r - is_wide) / (is_wide * r + 1.0f);
    z = r * r;
    a = is_wide * (PI * 0.25f) +
        ((((8.05374449538e-2f * z - 1.38776856032e-1f) * z +
           1.99777106478e-1f) *
              z -
          3.33329491539e-1f) *
             z * r +
         r);
    a = (is_steep ? PI * 0.5f : 0.0f) + minus_if(is_steep) * a;
    a = (x < 0.0f ? PI : 0.0f) + minus_if(x < 0.0f) * a;
    return minus_if(y < 0.0f) * a;
}

/* Completes the unit vector n to a right-handed orthonormal frame t, b, n (Duff
 * et al. 2017, "Building an orthonormal basis, revisited", JCGT 6:1). */
static inline void frame_around(struct vec3 n, struct vec3 *t, struct vec3 *b)
{
    float sign = minus_if(n.z < 0.0f);
    float a = -1.0f / (sign + n.z);
    float c = n.x * n.y * a;

    *t = v3(1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x);
    *b = v3(c, sign + n.y * n.y * a, -n.y);
}

#endif
