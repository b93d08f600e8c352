// SPDX-License-Identifier: MIT
/*
 * simd_hits.h - blocks of triangles, and results of the triangle test in lanes
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#ifndef KERNELS_SIMD_HITS_H
#define KERNELS_SIMD_HITS_H

#include "kernels/traverse_leaf.h"

#define LANES_MAX 8

/* A block where an instance shows its triangles. */
struct placed_block {
    GLOBAL const struct tri_block *block;
    GLOBAL const struct instance *at; /* NULL: outside of meshes */
};

static inline bool placed_is_moved(struct placed_block b)
{
    return HAS(FEATURE_INSTANCES) && b.at != 0;
}

/* What the numbers of its triangles are counted from. */
static inline uint32_t placed_first(struct placed_block b)
{
    return placed_is_moved(b) ? b.at->first_tri : 0u;
}

/* Triangle i of the block. */
static inline struct leaf_tri placed_leaf_tri(struct placed_block b, uint32_t i)
{
    GLOBAL const struct tri_block *k = b.block;
    struct leaf_tri t = {
        {k->corners[0][0][i], k->corners[0][1][i], k->corners[0][2][i]},
        {k->corners[1][0][i], k->corners[1][1][i], k->corners[1][2][i]},
        {k->corners[2][0][i], k->corners[2][1][i], k->corners[2][2][i]},
        k->tri[i]};

    return placed_is_moved(b) ? instance_leaf_tri(*b.at, t) : t;
}

/* Masks with a bit for each lane, and the values that triangle_hit() computes.
 */
struct simd_hits {
    uint32_t sure; /* lanes with a hit at a distance above 0 and up to t_max */
    uint32_t unsure; /* lanes for which triangle_hit() has to decide */
    ALIGNED(32) float t[LANES_MAX];
    ALIGNED(32) float edges[3][LANES_MAX];
};

/* tri_hit() for a lane with a sure hit. Returns true if it is nearer. */
static inline bool lane_accept(const struct world *w, const struct simd_hits *h,
                               uint32_t lane, struct ray r, uint32_t tri,
                               struct hit *best)
{
    float u = h->edges[0][lane], v = h->edges[1][lane], s = h->edges[2][lane];
    float det = u + (v + s);
    struct hit met = {h->t[lane], u / det, v / det, s / det, tri};

    if (tri + 1u == r.from || !hit_wins(w, r, met, best))
        return false;
    *best = met;
    return true;
}

/* tri_hit() for triangle i of a block, where the lane is unsure. */
static RARE bool lane_retest(const struct world *w, const struct ray *r,
                             const struct shear *s, struct placed_block b,
                             uint32_t i, struct hit *best)
{
    return tri_hit(w, *r, *s, placed_leaf_tri(b, i), best);
}

#endif
