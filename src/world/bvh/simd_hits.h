// SPDX-License-Identifier: MIT
/*
 * simd_hits.h - results of the triangle test in lanes
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#ifndef GLIM_SIMD_HITS_H
#define GLIM_SIMD_HITS_H

#include "world/bvh/bvh8.h"
#include "kernels/traverse_leaf.h"

#define LANES_MAX 8

static inline uint32_t lowest_bit(uint32_t mask)
{
    return (uint32_t)__builtin_ctz(mask);
}

/* Masks with a bit for each lane, and the values that triangle_hit() computes.
 */
struct simd_hits {
    uint32_t sure; /* lanes with a hit at a distance above 0 and up to t_max */
    uint32_t unsure; /* lanes for which triangle_hit() has to decide */
    _Alignas(32) float t[LANES_MAX];
    _Alignas(32) float edges[3][LANES_MAX];
};

/* tri_hit() for a lane with a sure hit. Returns true if it is nearer. */
static inline bool lane_accept(const struct world *w, const struct simd_hits *h,
                               uint32_t lane, const struct ray *r, uint32_t tri,
                               struct hit *best)
{
    float u = h->edges[0][lane], v = h->edges[1][lane], s = h->edges[2][lane];
    float t = h->t[lane];
    float det = u + (v + s);
    struct hit met = {t, u / det, v / det, s / det, tri};

    if (tri + 1u == r->from || !hit_wins(w, *r, met, best))
        return false;
    *best = met;
    return true;
}

/* tri_hit() for triangle i of a block, where the lane is unsure. Rare. */
static __attribute__((noinline, flatten)) bool
lane_retest(const struct world *w, const struct ray *r, const struct shear *s,
            const struct tri_block *b, uint32_t i, struct hit *best)
{
    struct leaf_tri t = {
        {b->corners[0][0][i], b->corners[0][1][i], b->corners[0][2][i]},
        {b->corners[1][0][i], b->corners[1][1][i], b->corners[1][2][i]},
        {b->corners[2][0][i], b->corners[2][1][i], b->corners[2][2][i]},
        b->tri[i]};

    return tri_hit(w, *r, *s, t, best);
}

#endif
