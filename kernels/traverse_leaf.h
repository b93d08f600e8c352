// SPDX-License-Identifier: MIT
/*
 * traverse_leaf.h - what all walks through trees share: which hit wins, and how
 * wide boxes are
 *
 * The nearest t wins, at equal t the lowest triangle: no tree decides.
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_TRAVERSE_LEAF_H
#define KERNELS_TRAVERSE_LEAF_H

#include "kernels/hit.h"
#include "kernels/rng.h"
#include "kernels/texture.h"

/* bvh.h promises trees that fit: at most one entry a level. */
#define TRAVERSE_STACK 96

/* Boxes are padded by this much when they are built, and entry and exit
 * distances are widened: together more than the rounding of a hit's t, and
 * of the edge tests, for any ray that starts within 1e3 scene sizes. */
#define BOX_PAD   0x1p-20f
#define BOX_WIDEN (16.0f * FLOAT_EPSILON)

/* Rays with a number that is NaN or infinite meet nothing: all such numbers end
 * up in this sum. */
static inline bool ray_is_finite(struct ray r)
{
    return fabsf(v3_dot(r.o, r.d)) <= FLOAT_MAX;
}

/* False where the surface lets this ray pass. */
static inline bool hit_is_solid(const struct world *w, struct ray r,
                                struct hit h)
{
    float coverage = coverage_at(w, h);

    return coverage >= 1.0f ||
           unit_float(hash_u32(r.key ^ hash_u32(h.tri + 1u))) < coverage;
}

/* Is what the ray meets nearer than the best, and there? */
static inline bool hit_wins(const struct world *w, struct ray r, struct hit h,
                            const struct hit *best)
{
    if (h.t > best->t || (h.t == best->t && h.tri >= best->tri))
        return false;
    return !has_coverage(w) || hit_is_solid(w, r, h);
}

/* Tests one triangle; true if it is a nearer hit. */
static inline bool tri_hit(const struct world *w, struct ray r, struct shear s,
                           struct leaf_tri t, struct hit *best)
{
    struct hit h;

    /* the test would say so as well, but slowly */
    if (t.tri + 1u == r.from)
        return false;
    if (!triangle_hit(r, s, t.p0, t.p1, t.p2, best->t, &h))
        return false;
    h.tri = t.tri;
    if (!hit_wins(w, r, h, best))
        return false;
    *best = h;
    return true;
}

#endif
