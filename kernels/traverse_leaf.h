// SPDX-License-Identifier: MIT
/*
 * traverse_leaf.h - rules that all traversals share: which hit wins, and the
 * padding of boxes
 *
 * The nearest t wins, at equal t the lowest triangle, whatever the tree.
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_TRAVERSE_LEAF_H
#define KERNELS_TRAVERSE_LEAF_H

#include "kernels/hit.h"
#include "kernels/rng.h"
#include "kernels/texture.h"

/* Entries of the stack: at most one a level of the binary tree, whose depth
 * bvh.h limits. */
#define TRAVERSE_STACK 96

/* Padding of boxes when they are built, and widening of the distances at which
 * rays leave and enter them. No tree may lose a hit that triangle_hit() has.
 *
 * A ray meets the boxes of a triangle that it hits. Let u be FLOAT_EPSILON, the
 * coordinates at most 1, and X the way of the ray along an axis. The signs of
 * the edge functions are exact, so the ray has a point Q of the triangle with
 * corners that the roundings of the shear have moved. A corner at p - o = (x,
 * z) moves by u (|x| + 3 |s z| + |x - s z|), where s is the slope of the ray;
 * in the mean over Q, for which x = s z, that is at most 4 u X + 8 u. A box
 * test adds 3 u X + 3 u, and the distance of Q 4 u. BOX_PAD is more than the
 * terms in u, and EXIT_WIDEN more than those in u X of two axes, from any
 * distance.
 *
 * No box is entered beyond the hit. A distance that is interpolated by the edge
 * functions differs from that of Q by distance_error(), up to T_PRECISION of
 * it; distance_again() sees to the same, and ENTRY_WIDEN covers it. Distances
 * to triangles across an axis differ by a few u. Searches found boxes that are
 * entered at most 6 u beyond an interpolated distance, but the bound allows
 * more. ENTRY_WIDEN costs .03 % of the nodes of scattered rays and .05 % of
 * those of camera rays, .4 % in 4 M triangles. */
#define BOX_PAD     0x1p-20f
#define EXIT_WIDEN  (16.0f * FLOAT_EPSILON)
#define ENTRY_WIDEN (2.0f * T_PRECISION)

/* False if a number of the ray is NaN or infinite, as the sum then is. Such
 * rays hit nothing. */
static inline bool ray_is_finite(struct ray r)
{
    return fabsf(v3_dot(r.o, r.d)) <= FLOAT_MAX;
}

/* Value of ray.from for a ray that leaves no triangle and that all coverage
 * above 0 stops. */
#define RAY_STOPS_EARLY NO_INDEX

/* Decides by the random key of the ray whether partial coverage stops it. */
static inline bool hit_is_solid(const struct world *w, struct ray r,
                                struct hit h)
{
    float coverage = coverage_at(w, h);

    if (r.from == RAY_STOPS_EARLY)
        return coverage > 0.0f;
    return coverage >= 1.0f ||
           unit_float(hash_u32(r.key ^ hash_u32(h.tri + 1u))) < coverage;
}

/* True if hit h wins over the best so far and its surface stops the ray. */
static inline bool hit_wins(const struct world *w, struct ray r, struct hit h,
                            const struct hit *best)
{
    if (h.t > best->t || (h.t == best->t && h.tri >= best->tri))
        return false;
    return !has_coverage(w) || hit_is_solid(w, r, h);
}

/* A triangle of a mesh, numbered within the mesh, where an instance shows it.
 */
static inline struct leaf_tri instance_leaf_tri(struct instance at,
                                                struct leaf_tri t)
{
    t.p0 = instance_point(at, t.p0);
    t.p1 = instance_point(at, t.p1);
    t.p2 = instance_point(at, t.p2);
    t.tri = at.first_tri + t.tri;
    return t;
}

/* Tests one triangle. Returns true if it is a nearer hit. */
static inline bool tri_hit(const struct world *w, struct ray r, struct shear s,
                           struct leaf_tri t, struct hit *best)
{
    struct hit h;

    /* triangle_hit() would say the same, but slowly */
    if (t.tri + 1u == r.from)
        return false;
    if (!triangle_hit(r, s, t, best->t, &h))
        return false;
    h.tri = t.tri;
    if (!hit_wins(w, r, h, best))
        return false;
    *best = h;
    return true;
}

#endif
