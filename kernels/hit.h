// SPDX-License-Identifier: MIT
/*
 * hit.h - intersection of a ray and a triangle, and origins of secondary rays
 *
 * Watertight (Woop, Benthin and Wald 2013, JCGT 2:1): a ray through an edge or
 * a vertex hits at least one neighbour. Where rounding could have moved a
 * distance to the wrong side of the origin, or far along a needle, it is
 * computed again in compensated floats (bounds of the errors: Pharr et al., PBR
 * 4th ed., 6.8).
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_HIT_H
#define KERNELS_HIT_H

#include "kernels/vec.h"

#define FLOAT_EPSILON 0x1p-24f
#define GAMMA(n)      ((n)*FLOAT_EPSILON / (1.0f - (n)*FLOAT_EPSILON))

/* Shear of space in which the ray starts at 0 and runs along +z. */
struct shear {
    struct vec3 o;
    float sx, sy, sz;
    uint32_t axis; /* axis of the largest component of the direction */
};

static inline float v3_axis(struct vec3 v, uint32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Has no branches: they are unpredictable for rays in all directions. */
static inline struct shear shear_of(struct ray r)
{
    const float d[5] = {r.d.x, r.d.y, r.d.z, r.d.x, r.d.y};
    uint32_t x = float_bits(fabsf(r.d.x));
    uint32_t y = float_bits(fabsf(r.d.y));
    uint32_t z = float_bits(fabsf(r.d.z));
    uint32_t x_is_largest = (uint32_t)(x > y) & (uint32_t)(x > z);
    uint32_t y_is_largest = (uint32_t)(y >= x) & (uint32_t)(y > z);
    uint32_t axis = 2u - 2u * x_is_largest - y_is_largest;
    struct shear s = {r.o, d[axis + 1] / d[axis], d[axis + 2] / d[axis],
                      1.0f / d[axis], axis};

    return s;
}

static inline struct vec3 shear_apply(struct shear s, struct vec3 p)
{
    struct vec3 a = v3_sub(p, s.o);
    float x = s.axis == 0 ? a.y : s.axis == 1 ? a.z : a.x;
    float y = s.axis == 0 ? a.z : s.axis == 1 ? a.x : a.y;
    float z = v3_axis(a, s.axis);

    return v3(x - s.sx * z, y - s.sy * z, s.sz * z);
}

/* Number with twice the digits: the unevaluated sum of a float and its rounding
 * error (Dekker 1971; CompensatedFloat in Pharr et al., PBR). */
struct compensated_float {
    float hi, lo;
};

/* Returns the exact sum (Knuth). */
static inline struct compensated_float two_sum(float a, float b)
{
    struct compensated_float s;
    float bb;

    s.hi = a + b;
    bb = s.hi - a;
    s.lo = (a - (s.hi - bb)) + (b - bb);
    return s;
}

/* Returns the exact product (Dekker 1971), unless the low part underflows. */
static inline struct compensated_float two_product(float a, float b)
{
    struct compensated_float p;
    float ca = 4097.0f * a;
    float cb = 4097.0f * b;
    float ah = ca - (ca - a);
    float bh = cb - (cb - b);
    float al = a - ah;
    float bl = b - bh;

    p.hi = a * b;
    p.lo = ((ah * bh - p.hi) + ah * bl + al * bh) + al * bl;
    return p;
}

/* Adds both halves with two_sum(). The shorter sum is wrong where the high
 * halves cancel. */
static inline struct compensated_float
compensated_add(struct compensated_float a, struct compensated_float b)
{
    struct compensated_float s = two_sum(a.hi, b.hi);
    struct compensated_float t = two_sum(a.lo, b.lo);

    s = two_sum(s.hi, s.lo + t.hi);
    return two_sum(s.hi, s.lo + t.lo);
}

static inline struct compensated_float
compensated_mul(struct compensated_float a, struct compensated_float b)
{
    struct compensated_float p = two_product(a.hi, b.hi);

    p.lo += a.hi * b.lo + a.lo * b.hi;
    return two_sum(p.hi, p.lo);
}

static inline struct compensated_float
compensated_neg(struct compensated_float a)
{
    struct compensated_float n = {-a.hi, -a.lo};

    return n;
}

static inline struct compensated_float
compensated_minor(struct compensated_float a, struct compensated_float b,
                  struct compensated_float c, struct compensated_float d)
{
    return compensated_add(compensated_mul(a, d),
                           compensated_neg(compensated_mul(b, c)));
}

/* Returns the distance along the ray to the triangle's plane, in compensated
 * floats, or 0 if the ray is parallel to it. */
static inline float plane_distance(struct ray r, struct vec3 p0, struct vec3 p1,
                                   struct vec3 p2)
{
    struct compensated_float ax = two_sum(p1.x, -p0.x),
                             bx = two_sum(p2.x, -p0.x);
    struct compensated_float ay = two_sum(p1.y, -p0.y),
                             by = two_sum(p2.y, -p0.y);
    struct compensated_float az = two_sum(p1.z, -p0.z),
                             bz = two_sum(p2.z, -p0.z);
    struct compensated_float nx = compensated_minor(ay, az, by, bz);
    struct compensated_float ny = compensated_minor(az, ax, bz, bx);
    struct compensated_float nz = compensated_minor(ax, ay, bx, by);
    struct compensated_float dx = {r.d.x, 0.0f}, dy = {r.d.y, 0.0f},
                             dz = {r.d.z, 0.0f};
    struct compensated_float above = compensated_add(
        compensated_add(compensated_mul(nx, two_sum(p0.x, -r.o.x)),
                        compensated_mul(ny, two_sum(p0.y, -r.o.y))),
        compensated_mul(nz, two_sum(p0.z, -r.o.z)));
    struct compensated_float slope =
        compensated_add(compensated_add(compensated_mul(nx, dx),
                                        compensated_mul(ny, dy)),
                        compensated_mul(nz, dz));

    if (slope.hi == 0.0f)
        return 0.0f;
    return above.hi / slope.hi;
}

/* Returns true if all are equal. Processors cannot predict which triangle of a
 * lamp is tested, so there is no branch between the comparisons. */
static inline bool are_same(float a, float b, float c)
{
    return ((uint32_t)(a == b) & (uint32_t)(a == c)) != 0;
}

/* Distance to a triangle that is perpendicular to an axis. One division, the
 * same for all triangles in that plane, so that coincident ones tie. Returns
 * false for other triangles. */
static inline bool axis_distance(struct ray r, struct vec3 p0, struct vec3 p1,
                                 struct vec3 p2, float *t)
{
    if (are_same(p0.x, p1.x, p2.x))
        *t = (p0.x - r.o.x) / r.d.x;
    else if (are_same(p0.y, p1.y, p2.y))
        *t = (p0.y - r.o.y) / r.d.y;
    else if (are_same(p0.z, p1.z, p2.z))
        *t = (p0.z - r.o.z) / r.d.z;
    else
        return false;
    return true;
}

/* Returns a b - c d with the sign of the exact value. Rounding is monotonic, so
 * only a result of 0 can hide a sign; then the low parts of the products
 * decide. */
static inline float edge_function(float a, float b, float c, float d)
{
    float e = a * b - c * d;

    if (e == 0.0f)
        e = two_product(a, b).lo - two_product(c, d).lo;
    return e;
}

/* Bound of the error of the distance that is interpolated from the sheared
 * corners by the edge functions, whose sum is det. Errors of the weights move
 * it anywhere between the corners' distances. */
static inline float distance_error(struct vec3 a, struct vec3 b, struct vec3 c,
                                   float det)
{
    float spread = f_max(a.z, f_max(b.z, c.z)) - f_min(a.z, f_min(b.z, c.z));
    float reach_x = f_max(fabsf(a.x), f_max(fabsf(b.x), fabsf(c.x)));
    float reach_y = f_max(fabsf(a.y), f_max(fabsf(b.y), fabsf(c.y)));
    float reach_z = f_max(fabsf(a.z), f_max(fabsf(b.z), fabsf(c.z)));
    float error_x = GAMMA(5) * (reach_x + reach_z);
    float error_y = GAMMA(5) * (reach_y + reach_z);
    float weight = 2.0f * (GAMMA(2) * reach_x * reach_y + error_y * reach_x +
                           error_x * reach_y);

    return 3.0f * weight * spread / fabsf(det) + GAMMA(12) * reach_z;
}

/* Edge function in compensated floats. */
static inline struct compensated_float compensated_edge(float a, float b,
                                                        float c, float d)
{
    return compensated_add(two_product(a, b),
                           compensated_neg(two_product(c, d)));
}

/* Distance of the point that the edge functions of sheared corners interpolate,
 * in compensated floats. */
static inline float edge_distance(struct vec3 a, struct vec3 b, struct vec3 c)
{
    struct compensated_float u = compensated_edge(c.x, b.y, c.y, b.x);
    struct compensated_float v = compensated_edge(a.x, c.y, a.y, c.x);
    struct compensated_float w = compensated_edge(b.x, a.y, b.y, a.x);
    struct compensated_float az = {a.z, 0.0f}, bz = {b.z, 0.0f},
                             cz = {c.z, 0.0f};
    struct compensated_float sum =
        compensated_add(compensated_mul(u, az),
                        compensated_add(compensated_mul(v, bz),
                                        compensated_mul(w, cz)));

    return sum.hi / compensated_add(u, compensated_add(v, w)).hi;
}

/* Relative error from which a distance is computed again: that of needles, and
 * of faces near the origin. */
#define T_PRECISION 0x1p-14f

/* Distance to a needle, or to a face near the origin: that of the plane, which
 * tells on which side the origin is. The edge functions may let a ray hit that
 * misses the triangle by a few roundings. If it is almost parallel to the
 * plane, it meets the plane far from the triangle, where no tree would look. So
 * a hit is not nearer than the point that they interpolate, with T_PRECISION.
 */
static inline float distance_again(struct ray r, struct leaf_tri at,
                                   struct vec3 a, struct vec3 b, struct vec3 c)
{
    float t = plane_distance(r, at.p0, at.p1, at.p2);

    t = f_max(t, f_min(a.z, f_min(b.z, c.z)));
    t = f_min(t, f_max(a.z, f_max(b.z, c.z)));
    if (t > 0.0f)
        t = f_max(edge_distance(a, b, c) * (1.0f - T_PRECISION), t);
    return t;
}

/* Intersects a ray and a triangle. Returns true for a hit at a distance above 0
 * and up to t_max, and fills *h except tri. The other winding, p1 and p2
 * exchanged, gives the same distance to the bit: sums are grouped for that. */
static inline bool triangle_hit(struct ray r, struct shear s,
                                struct leaf_tri at, float t_max, struct hit *h)
{
    struct vec3 a = shear_apply(s, at.p0);
    struct vec3 b = shear_apply(s, at.p1);
    struct vec3 c = shear_apply(s, at.p2);
    float u = edge_function(c.x, b.y, c.y, b.x);
    float v = edge_function(a.x, c.y, a.y, c.x);
    float w = edge_function(b.x, a.y, b.y, a.x);
    float det, t;

    if ((u < 0.0f || v < 0.0f || w < 0.0f) &&
        (u > 0.0f || v > 0.0f || w > 0.0f))
        return false;
    det = u + (v + w);
    if (det == 0.0f)
        return false;
    if (!axis_distance(r, at.p0, at.p1, at.p2, &t)) {
        t = (u * a.z + (v * b.z + w * c.z)) / det;
        if (!(fabsf(t) * T_PRECISION > distance_error(a, b, c, det)))
            t = distance_again(r, at, a, b, c);
    }
    if (!(t > 0.0f && t <= t_max))
        return false;
    h->t = t;
    h->b0 = u / det;
    h->b1 = v / det;
    h->b2 = w / det;
    return true;
}

/* The distance that triangle_hit() finds for a ray that is aimed at a point of
 * the triangle. 0 or less if there is no hit. */
static inline float aimed_distance(struct ray r, struct vec3 p0, struct vec3 p1,
                                   struct vec3 p2)
{
    struct hit h = {0.0f, 0.0f, 0.0f, 0.0f, NO_INDEX};

    if (!axis_distance(r, p0, p1, p2, &h.t)) {
        const struct leaf_tri at = {p0, p1, p2, NO_INDEX};

        triangle_hit(r, shear_of(r), at, FLOAT_MAX, &h);
    }
    return h.t <= FLOAT_MAX ? h.t : 0.0f;
}

/* Position of a hit, and a bound of its rounding error on each axis. It is
 * computed from the barycentrics, so that the error does not depend on the
 * distance of the origin. Seven roundings, and less than two more in
 * offset_ray_origin(). */
static inline struct vec3 hit_point(struct hit h, struct vec3 p0,
                                    struct vec3 p1, struct vec3 p2,
                                    struct vec3 *error)
{
    struct vec3 a = v3_scale(p0, h.b0);
    struct vec3 b = v3_scale(p1, h.b1);
    struct vec3 c = v3_scale(p2, h.b2);

    *error = v3((fabsf(a.x) + fabsf(b.x) + fabsf(c.x)) * GAMMA(9),
                (fabsf(a.y) + fabsf(b.y) + fabsf(c.y)) * GAMMA(9),
                (fabsf(a.z) + fabsf(b.z) + fabsf(c.z)) * GAMMA(9));
    return v3_add(v3_add(a, b), c);
}

/* Least barycentric below which hit_point_inset() looks at the distance to the
 * edge. */
#define EDGE_NEAR 0x1p-7f

/* hit_point() for rays that start there. A point on an edge may by its error
 * lie behind the neighbour, and a ray from it could leave a closed mesh. So it
 * is moved towards the middle of its triangle until it is as far from each edge
 * as its error. */
static inline struct vec3 hit_point_inset(struct hit h, struct vec3 p0,
                                          struct vec3 p1, struct vec3 p2,
                                          struct vec3 *error)
{
    float least = f_min(h.b0, f_min(h.b1, h.b2));
    struct vec3 p = hit_point(h, p0, p1, p2, error);
    struct vec3 e1 = v3_sub(p1, p0);
    struct vec3 e2 = v3_sub(p2, p0);
    struct vec3 e3 = v3_sub(p2, p1);
    float longest, height, share;

    if (least >= EDGE_NEAR)
        return p;
    longest = f_max(v3_length(e1), f_max(v3_length(e2), v3_length(e3)));
    height = v3_length(v3_cross(e1, e2)) / longest;
    share = f_min((error->x + error->y + error->z) / height, 1.0f / 3.0f);
    if (least >= share)
        return p;
    share = 3.0f * (share - least);
    h.b0 += share * (1.0f / 3.0f - h.b0);
    h.b1 += share * (1.0f / 3.0f - h.b1);
    h.b2 += share * (1.0f / 3.0f - h.b2);
    return hit_point(h, p0, p1, p2, error);
}

/* Least offset of an origin, for planes through 0, where the error bound is 0.
 * Elsewhere it is lost in rounding. */
#define ORIGIN_OFFSET_MIN 0x1p-100f

/* Origin of a ray that leaves p on the side of the unit normal ng: offset by
 * the error bound of p, which includes the rounding here (Pharr et al., PBR 4th
 * ed., 6.8). */
static inline struct vec3 offset_ray_origin(struct vec3 p, struct vec3 error,
                                            struct vec3 ng)
{
    float distance =
        fabsf(ng.x) * error.x + fabsf(ng.y) * error.y + fabsf(ng.z) * error.z;

    return v3_add(p, v3_scale(ng, distance + ORIGIN_OFFSET_MIN));
}

/* Scales v so that its largest component is 1. Returns false if v is 0. Vectors
 * below 2^-64 are scaled by a power of two first, as the reciprocal of a number
 * below 2^-128 is infinite. */
static inline bool v3_enlarge(struct vec3 *v)
{
    float most = f_max(fabsf(v->x), f_max(fabsf(v->y), fabsf(v->z)));

    if (most < 0x1p-64f) {
        *v = v3_scale(*v, 0x1p64f);
        most *= 0x1p64f;
    }
    *v = v3_scale(*v, 1.0f / most);
    return most > 0.0f;
}

/* Computes the unit normal by the winding of the file. Edges are scaled first,
 * so that those of small triangles do not underflow. Returns false if there is
 * none after rounding. */
static inline bool triangle_normal(struct vec3 p0, struct vec3 p1,
                                   struct vec3 p2, struct vec3 *ng)
{
    struct vec3 e1 = v3_sub(p1, p0);
    struct vec3 e2 = v3_sub(p2, p0);
    struct vec3 n;

    if (!v3_enlarge(&e1) || !v3_enlarge(&e2))
        return false;
    n = v3_cross(e1, e2);
    if (!v3_enlarge(&n))
        return false;
    n = v3_unit(n);
    if (!(v3_dot(n, n) < 2.0f)) /* NaN, for infinite corners */
        return false;
    *ng = n;
    return true;
}

#endif
