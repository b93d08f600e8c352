// SPDX-License-Identifier: MIT
/*
 * block_hit.h - a ray against the triangles of a block, four at once
 *
 * Lane by lane these are the steps of triangle_hit() in kernels/hit.h, and they
 * give the same bits. Where that takes another way, to the lost digits of an
 * edge or of a distance, the block says so, and triangle_hit() itself decides.
 *
 * Units:     normalised scene units
 * Ownership: none
 * Threads:   any
 * Errors:    none
 */
#ifndef GLIM_BLOCK_HIT_H
#define GLIM_BLOCK_HIT_H

#include "glim/simd.h"
#include "glim/wide.h"
#include "kernels/traverse_leaf.h"

/* As shear_of(), without branches: no processor can predict them for rays in
 * all directions. */
static inline struct shear block_shear_of(struct ray r)
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

/* Bits of lanes, and what triangle_hit() computes in them. */
struct block_hits {
    uint32_t sure;   /* met at a distance above 0 and not beyond t_max */
    uint32_t unsure; /* triangle_hit() has to say */
    _Alignas(16) float t[BLOCK_TRIS];
    _Alignas(16) float edges[3][BLOCK_TRIS];
};

/* Corners in the space of the sheared ray: x, y and z of each. */
struct block_corners {
    f4 x[3], y[3], z[3];
};

static inline f4 f4_least(const f4 v[3])
{
    return f4_min(v[0], f4_min(v[1], v[2]));
}

static inline f4 f4_most(const f4 v[3])
{
    return f4_max(v[0], f4_max(v[1], v[2]));
}

static inline f4 f4_reach(const f4 v[3])
{
    return f4_max(f4_abs(v[0]), f4_max(f4_abs(v[1]), f4_abs(v[2])));
}

/* As shear_apply(), but for the factor of z: few blocks need it. */
static inline struct block_corners block_shear(const struct tri_block *block,
                                               const struct shear *s)
{
    const float o[3] = {s->o.x, s->o.y, s->o.z};
    uint32_t kz = s->axis;
    uint32_t kx = kz == 2 ? 0 : kz + 1;
    uint32_t ky = kx == 2 ? 0 : kx + 1;
    struct block_corners c;

    for (int i = 0; i < 3; i++) {
        c.z[i] = f4_sub(f4_load(block->corners[i][kz]), f4_all(o[kz]));
        c.x[i] = f4_sub(f4_sub(f4_load(block->corners[i][kx]), f4_all(o[kx])),
                        f4_mul(f4_all(s->sx), c.z[i]));
        c.y[i] = f4_sub(f4_sub(f4_load(block->corners[i][ky]), f4_all(o[ky])),
                        f4_mul(f4_all(s->sy), c.z[i]));
    }
    return c;
}

/* As distance_error(), or more than it: what rounds in another order is made
 * larger by more than that can matter. */
static inline f4 block_error(const struct block_corners *c, f4 det)
{
    f4 spread = f4_sub(f4_most(c->z), f4_least(c->z));
    f4 reach_x = f4_reach(c->x);
    f4 reach_y = f4_reach(c->y);
    f4 reach_z = f4_reach(c->z);
    f4 error_x = f4_mul(f4_all(GAMMA(5)), f4_add(reach_x, reach_z));
    f4 error_y = f4_mul(f4_all(GAMMA(5)), f4_add(reach_y, reach_z));
    f4 products =
        f4_add(f4_mul(f4_mul(f4_all(GAMMA(2)), reach_x), reach_y),
               f4_add(f4_mul(error_y, reach_x), f4_mul(error_x, reach_y)));

    return f4_add(f4_div(f4_mul(f4_mul(f4_all(6.0f * (1.0f + 0x1p-20f)),
                                       products),
                                spread),
                         f4_abs(det)),
                  f4_mul(f4_all(GAMMA(12)), reach_z));
}

/* The distances, and in *is_exact the lanes where they are triangle_hit()'s:
 * those across an axis by axis_distance(), the others by the edge functions if
 * these are good enough. */
static inline f4 block_distance(const struct tri_block *block,
                                const struct ray *r, const struct shear *s,
                                struct block_corners *c, const f4 edges[3],
                                uint32_t *is_exact)
{
    const float o[3] = {r->o.x, r->o.y, r->o.z};
    const float d[3] = {r->d.x, r->d.y, r->d.z};
    f4 det = f4_add(edges[0], f4_add(edges[1], edges[2]));
    f4 over, under = det, t;
    uint32_t is_flat = 0;

    for (int i = 0; i < 3; i++)
        c->z[i] = f4_mul(f4_all(s->sz), c->z[i]);
    over = f4_add(f4_mul(edges[0], c->z[0]),
                  f4_add(f4_mul(edges[1], c->z[1]), f4_mul(edges[2], c->z[2])));
    for (int i = 2; i >= 0; i--) {
        f4 p0 = f4_load(block->corners[0][i]);
        f4 p1 = f4_load(block->corners[1][i]);
        f4 p2 = f4_load(block->corners[2][i]);

        over = f4_if_same(p0, p1, p2, f4_sub(p0, f4_all(o[i])), over);
        under = f4_if_same(p0, p1, p2, f4_all(d[i]), under);
        is_flat |= f4_same(p0, p1, p2);
    }
    t = f4_div(over, under);
    *is_exact = is_flat | f4_below(block_error(c, det),
                                   f4_mul(f4_abs(t), f4_all(T_PRECISION)));
    return t;
}

/* False if the ray passes by all of them. */
static inline bool block_test(const struct tri_block *block,
                              const struct ray *r, const struct shear *s,
                              float t_max, struct block_hits *h)
{
    struct block_corners c = block_shear(block, s);
    f4 zero = f4_all(0.0f);
    f4 edges[3] = {
        f4_sub(f4_mul(c.x[2], c.y[1]), f4_mul(c.y[2], c.x[1])),
        f4_sub(f4_mul(c.x[0], c.y[2]), f4_mul(c.y[0], c.x[2])),
        f4_sub(f4_mul(c.x[1], c.y[0]), f4_mul(c.y[1], c.x[0])),
    };
    uint32_t met = f4_not_above(zero, f4_least(edges)) |
                   f4_not_above(f4_most(edges), zero);
    uint32_t is_exact;
    f4 t;

    if (met == 0)
        return false;
    t = block_distance(block, r, s, &c, edges, &is_exact);
    /* an edge function of 0 has lost its sign; a product that is too small for
     * a float only costs time */
    is_exact &=
        ~f4_not_above(f4_abs(f4_mul(f4_mul(edges[0], edges[1]), edges[2])),
                      zero);
    h->unsure = met & ~is_exact;
    h->sure =
        met & is_exact & f4_below(zero, t) & f4_not_above(t, f4_all(t_max));
    f4_store(h->t, t);
    for (int i = 0; i < 3; i++)
        f4_store(h->edges[i], edges[i]);
    return true;
}

static inline struct leaf_tri block_tri(const struct tri_block *b, uint32_t i)
{
    struct leaf_tri t = {
        {b->corners[0][0][i], b->corners[0][1][i], b->corners[0][2][i]},
        {b->corners[1][0][i], b->corners[1][1][i], b->corners[1][2][i]},
        {b->corners[2][0][i], b->corners[2][1][i], b->corners[2][2][i]},
        b->tri[i]};

    return t;
}

/* The lanes that triangle_hit() decides on; rare, unless surfaces have holes.
 */
static __attribute__((noinline)) bool
block_decide(const struct world *w, const struct ray *r, const struct shear *s,
             const struct tri_block *block, uint32_t lanes, struct hit *best)
{
    bool found = false;

    for (; lanes != 0; lanes &= lanes - 1)
        found |=
            tri_hit(w, *r, *s, block_tri(block, (uint32_t)__builtin_ctz(lanes)),
                    best);
    return found;
}

/* The rule of tri_hit() for a lane that is sure; true if it is a nearer hit. */
static inline bool block_take(const struct ray *r,
                              const struct tri_block *block,
                              const struct block_hits *h, uint32_t i,
                              struct hit *best)
{
    uint32_t tri = block->tri[i];
    float t = h->t[i];
    float det;

    if (tri + 1u == r->from || t > best->t ||
        (t == best->t && tri >= best->tri))
        return false;
    det = h->edges[0][i] + (h->edges[1][i] + h->edges[2][i]);
    best->t = t;
    best->b0 = h->edges[0][i] / det;
    best->b1 = h->edges[1][i] / det;
    best->b2 = h->edges[2][i] / det;
    best->tri = tri;
    return true;
}

/* As leaf_hit() of kernels/traverse.h, for `more` + 1 blocks. A call would make
 * the walk put its vectors aside: 4 % of all. */
static inline __attribute__((always_inline)) bool
blocks_hit(const struct world *w, const struct ray *r, const struct shear *s,
           const struct tri_block *block, uint32_t more, struct hit *best)
{
    bool has_holes =
        HAS(FEATURE_COVERAGE) && (w->settings.features & FEATURE_COVERAGE) != 0;
    bool found = false;
    struct block_hits h;

    for (;; more--, block++) {
        if (block_test(block, r, s, best->t, &h)) {
            if (has_holes) {
                h.unsure |= h.sure;
                h.sure = 0;
            }
            for (; h.sure != 0; h.sure &= h.sure - 1)
                found |= block_take(r, block, &h,
                                    (uint32_t)__builtin_ctz(h.sure), best);
            if (h.unsure != 0)
                found |= block_decide(w, r, s, block, h.unsure, best);
        }
        if (more == 0)
            return found;
    }
}

#endif
