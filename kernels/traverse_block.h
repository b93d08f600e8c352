// SPDX-License-Identifier: MIT
/*
 * traverse_block.h - intersects a ray with the triangles of a leaf, four at
 * once (Wald, Benthin and Boulos 2008, "Getting rid of packets")
 *
 * Vectors are supplied by a file that is included first: src/base/simd8.h on
 * the CPU, simd_cl.h on a device.
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#ifndef KERNELS_TRAVERSE_BLOCK_H
#define KERNELS_TRAVERSE_BLOCK_H

#include "kernels/simd_hits.h"

/* Operands of triangle_template.h: each lane has a triangle, all have one ray.
 */

/* Component `axis` of corner k, by instance_point() where an instance shows it.
 */
static inline f4 f4_corner(struct placed_block b, int k, uint32_t axis)
{
    GLOBAL const float(*corner)[BVH8_BLOCK_TRIS] = b.block->corners[k];
    f4 x, y, z;

    if (!placed_is_moved(b))
        return f4_load(corner[axis]);
    x = f4_mul(f4_set1(b.at->rows[axis].x), f4_load(corner[0]));
    y = f4_mul(f4_set1(b.at->rows[axis].y), f4_load(corner[1]));
    z = f4_mul(f4_set1(b.at->rows[axis].z), f4_load(corner[2]));
    return f4_add(f4_add(f4_add(x, y), z),
                  f4_set1(v3_axis(b.at->origin, axis)));
}

static inline f4 f4_ray(const float *place)
{
    return f4_set1(*place);
}

#define LANES       f4
#define LANES_RAYS  1
#define LANES_BLOCK struct placed_block
#include "kernels/triangle_template.h"

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

/* Tests a block. Returns true if one of its triangles is a nearer hit. Inlined,
 * as across a call the traversal would not keep its vectors in registers: 4 %
 * of all time. */
static INLINED bool block_hit(const struct world *w, const struct block_ray *r,
                              struct placed_block b, bool is_any,
                              struct hit *best)
{
    uint32_t first = placed_first(b);
    f4_mask passed = f4_or(f4_equal_u32(b.block->tri, r->passed[0] - first),
                           f4_equal_u32(b.block->tri, r->passed[1] - first));
    bool found = false;
    struct simd_hits h;

    COUNT_BLOCK();
    if (!f4_test(b, &r->lanes, f4_set1(best->t), passed, &h))
        return false;
    for (; h.sure != 0; h.sure &= h.sure - 1) {
        uint32_t i = lowest_bit(h.sure);

        found |= lane_accept(w, &h, i, r->ray, first + b.block->tri[i], best);
        if (is_any && found)
            return true;
    }
    for (; h.unsure != 0; h.unsure &= h.unsure - 1)
        found |=
            lane_retest(w, &r->ray, &r->shear, b, lowest_bit(h.unsure), best);
    return found;
}

/* Tests the blocks of a leaf, of which `more` follow the first. */
static INLINED bool blocks_hit(const struct world *w, const struct block_ray *r,
                               struct placed_block b, uint32_t more,
                               bool is_any, struct hit *best)
{
    bool found = false;

    for (;; more--, b.block++) {
        found |= block_hit(w, r, b, is_any, best);
        if (is_any && found)
            return true;
        if (more == 0)
            return found;
    }
}

#endif
