// SPDX-License-Identifier: MIT
/*
 * bvh8_leaf.h - intersects a ray with the triangles of a leaf, four at once
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#ifndef GLIM_BVH8_LEAF_H
#define GLIM_BVH8_LEAF_H

#include "base/simd4.h"
#include "world/bvh/bvh8.h"
#include "kernels/traverse_leaf.h"

/* Operands of simd_triangle_template.h: each lane has a triangle, all have one
 * ray. */
static inline f4 f4_corner(const float *place)
{
    return f4_load(place);
}

static inline f4 f4_ray(const float *place)
{
    return f4_set1(*place);
}

#define LANES      f4
#define LANES_RAYS 1
#include "world/bvh/simd_triangle_template.h"

/* A ray, prepared for tests of blocks. */
struct block_ray {
    struct ray ray;
    struct shear shear;
    struct f4_rays lanes;
    uint32_t passed[2]; /* triangles that do not count as hits */
};

/* Prepares a ray. It does not hit triangle `tri`, at which a shadow ray ends.
 */
static inline struct block_ray block_ray_of(struct ray r, uint32_t tri)
{
    struct shear s = shear_of(r);
    struct block_ray b = {r,
                          s,
                          {{{r.o.x}, {r.o.y}, {r.o.z}},
                           {{r.d.x}, {r.d.y}, {r.d.z}},
                           {s.sx},
                           {s.sy},
                           {s.sz},
                           s.axis},
                          {r.from - 1u, tri}};

    return b;
}

/* leaf_hit() of kernels/traverse.h for `more` + 1 blocks. Inlined, as across a
 * call the traversal would not keep its vectors in registers: 4 % of all time.
 */
static inline __attribute__((always_inline)) bool
blocks_hit(const struct world *w, const struct block_ray *r,
           const struct tri_block *block, uint32_t more, struct hit *best)
{
    bool found = false;
    struct simd_hits h;

    for (;; more--, block++) {
        uint32_t passed = f4_mask_equal_u32(block->tri, r->passed[0]) |
                          f4_mask_equal_u32(block->tri, r->passed[1]);

        if (f4_test(block, 0, &r->lanes, f4_set1(best->t), ~passed, &h)) {
            for (; h.sure != 0; h.sure &= h.sure - 1) {
                uint32_t i = lowest_bit(h.sure);

                found |= lane_accept(w, &h, i, &r->ray, block->tri[i], best);
            }
            for (; h.unsure != 0; h.unsure &= h.unsure - 1)
                found |= lane_retest(w, &r->ray, &r->shear, block,
                                     lowest_bit(h.unsure), best);
        }
        if (more == 0)
            return found;
    }
}

#endif
