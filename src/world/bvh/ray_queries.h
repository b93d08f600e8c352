// SPDX-License-Identifier: MIT
/*
 * ray_queries.h - the ray queries of kernels/traverse.h in the vectors of the
 * CPU, and packets of coherent rays
 *
 * Eight rays of a packet are tested against a triangle at once.
 *
 * Units:     normalised scene units
 * Threads:   any, on one world
 */
#ifndef GLIM_RAY_QUERIES_H
#define GLIM_RAY_QUERIES_H

#include "base/simd4.h"
#include "base/simd8.h"
#include "kernels/traverse.h"

#define PACKET_RAYS 8

/* A triangle of a block. */
struct block_tri {
    const struct tri_block *block;
    uint32_t i;
};

/* Operands of triangle_template.h: each lane has a ray, all have one triangle.
 */
static inline f8 f8_corner(struct block_tri t, int k, uint32_t axis)
{
    return f8_set1(t.block->corners[k][axis][t.i]);
}

static inline f8 f8_ray(const float *place)
{
    return f8_load(place);
}

#define LANES       f8
#define LANES_RAYS  PACKET_RAYS
#define LANES_BLOCK struct block_tri
#include "kernels/triangle_template.h"

/* A packet of rays, and their nearest hits so far. */
struct ray_packet {
    const struct world *world;
    const struct ray *rays;
    struct hit *hits;
    uint32_t count;
    struct f8_rays lanes;
    _Alignas(32) float t[PACKET_RAYS]; /* distances of the hits */
    float t_max;                       /* largest of t */
};

static inline void packet_set_ray(struct ray_packet *g, uint32_t lane,
                                  const struct ray *r)
{
    g->lanes.o[0][lane] = r->o.x;
    g->lanes.o[1][lane] = r->o.y;
    g->lanes.o[2][lane] = r->o.z;
    g->lanes.d[0][lane] = r->d.x;
    g->lanes.d[1][lane] = r->d.y;
    g->lanes.d[2][lane] = r->d.z;
    g->t[lane] = r->t_max;
}

/* shear_of() for all rays. Returns false if their axes differ, so that they
 * cannot be tested together. */
static inline bool packet_shear(struct f8_rays *r)
{
    f8 x = f8_abs(f8_load(r->d[0]));
    f8 y = f8_abs(f8_load(r->d[1]));
    f8 z = f8_abs(f8_load(r->d[2]));
    uint32_t x_over_y = f8_bits(f8_lt(y, x));
    uint32_t is_x = x_over_y & f8_bits(f8_lt(z, x));
    uint32_t is_y = ~x_over_y & f8_bits(f8_lt(z, y));
    uint32_t all = (1u << PACKET_RAYS) - 1;
    uint32_t axis = is_x == all ? 0 : is_y == all ? 1 : 2;
    f8 along = f8_load(r->d[axis]);

    f8_store(r->sx, f8_div(f8_load(r->d[(axis + 1) % 3]), along));
    f8_store(r->sy, f8_div(f8_load(r->d[(axis + 2) % 3]), along));
    f8_store(r->sz, f8_div(f8_set1(1.0f), along));
    r->axis = axis;
    return axis != 2 || (is_x | is_y) == 0;
}

/* ray_is_finite() for all rays. Lanes without a ray are NaN. */
static inline bool packet_is_finite(const struct ray_packet *g)
{
    f8 sum = f8_set1(0.0f);

    for (int i = 0; i < 3; i++)
        sum =
            f8_add(sum, f8_mul(f8_load(g->lanes.o[i]), f8_load(g->lanes.d[i])));
    return f8_bits(f8_le(f8_abs(sum), f8_set1(FLOAT_MAX))) ==
           (1u << g->count) - 1;
}

static inline float packet_t_max(const struct ray_packet *g)
{
    float far = g->t[0];

    for (int i = 1; i < PACKET_RAYS; i++)
        far = f_max(far, g->t[i]);
    return far;
}

/* Fills a packet with 1 to PACKET_RAYS rays. Call packet_shear() next. */
static inline void packet_begin(struct ray_packet *g, const struct world *w,
                                const struct ray *rays, uint32_t count,
                                struct hit *hits)
{
    struct ray none = rays[0]; /* hits nothing */

    none.o = v3(NAN, NAN, NAN);
    none.t_max = 0.0f;
    g->world = w;
    g->rays = rays;
    g->hits = hits;
    g->count = count;
    for (uint32_t i = 0; i < PACKET_RAYS; i++)
        packet_set_ray(g, i, i < count ? &rays[i] : &none);
    g->t_max = packet_t_max(g);
}

static inline void packet_intersect(struct ray_packet *g, struct block_tri t)
{
    struct placed_block b = {t.block, NULL};
    f8 zero = f8_set1(0.0f);
    struct simd_hits h;

    if (!f8_test(t, &g->lanes, f8_load(g->t), f8_lt(zero, zero), &h))
        return;
    for (; h.sure != 0; h.sure &= h.sure - 1) {
        uint32_t k = lowest_bit(h.sure);

        lane_accept(g->world, &h, k, g->rays[k], t.block->tri[t.i],
                    &g->hits[k]);
        g->t[k] = g->hits[k].t;
    }
    for (; h.unsure != 0; h.unsure &= h.unsure - 1) {
        uint32_t k = lowest_bit(h.unsure);
        struct shear s = {g->rays[k].o, g->lanes.sx[k], g->lanes.sy[k],
                          g->lanes.sz[k], g->lanes.axis};

        lane_retest(g->world, &g->rays[k], &s, b, t.i, &g->hits[k]);
        g->t[k] = g->hits[k].t;
    }
    g->t_max = packet_t_max(g);
}

/* Least number of rays in a packet, and the largest distance between them at
 * distance 1. Measured with lenses: a third of it takes 10 % less time for a
 * picture without bounces, twice as much 20 % more. */
#define PACKET_MIN    2
#define PACKET_SPREAD 0x1p-5f

/* Sets an axis of the two rays that bound all rays of a packet. Returns false
 * if the directions differ in sign or the rays are too far apart. */
static inline bool bvh8_bound(struct bvh8_ray *first, struct bvh8_ray *last,
                              uint32_t axis, const struct ray_packet *g)
{
    const float *o = g->lanes.o[axis], *d = g->lanes.d[axis];
    float o_lo = o[0], o_hi = o[0], d_lo = d[0], d_hi = d[0];
    uint32_t is_down;

    for (uint32_t i = 1; i < g->count; i++) {
        o_lo = f_min(o_lo, o[i]);
        o_hi = f_max(o_hi, o[i]);
        d_lo = f_min(d_lo, d[i]);
        d_hi = f_max(d_hi, d[i]);
    }
    is_down = float_bits(d_lo) >> 31;
    bvh8_ray_axis(first, axis, is_down ? o_lo : o_hi, is_down ? d_lo : d_hi);
    bvh8_ray_axis(last, axis, is_down ? o_hi : o_lo, is_down ? d_hi : d_lo);
    return is_down == float_bits(d_hi) >> 31 &&
           (o_hi - o_lo) + (d_hi - d_lo) <= PACKET_SPREAD;
}

static INLINED void packet_blocks(struct ray_packet *g,
                                  const struct tri_block *block, uint32_t more)
{
    for (;; more--, block++) {
        COUNT_BLOCK();
        for (uint32_t i = 0; i < BVH8_BLOCK_TRIS && block->tri[i] != NO_INDEX;
             i++)
            packet_intersect(g, (struct block_tri){block, i});
        if (more == 0)
            return;
    }
}

/* Traces rays as one packet. Returns false, with no answer, where they are too
 * few or go too far apart for it. */
static inline bool packet_closest(const struct world *w, const struct ray *rays,
                                  uint32_t count, struct hit *hits)
{
    struct bvh8_ray first, last;
    struct ray_packet g;
    uint64_t stack[BVH8_STACK];
    struct walk k;

    if (w->nodes == NULL || count < PACKET_MIN || has_instances(w))
        return false;
    packet_begin(&g, w, rays, count, hits);
    if (!packet_is_finite(&g) || !bvh8_bound(&first, &last, 0, &g) ||
        !bvh8_bound(&first, &last, 1, &g) ||
        !bvh8_bound(&first, &last, 2, &g) || !packet_shear(&g.lanes))
        return false;
    for (uint32_t i = 0; i < count; i++)
        hits[i] = no_hit(rays[i]);
    k = walk_begin(w->nodes, g.t_max);
    while (walk_nearest(&k, stack, &first, &last)) {
        packet_blocks(&g, walk_block(&k), walk_more(&k));
        k.t_far = bvh8_far(g.t_max);
    }
    return true;
}

/* Nearest hits of up to PACKET_RAYS rays: as one packet if they go much the
 * same way, else one by one. */
static inline void hits_closest(const struct world *w, const struct ray *rays,
                                uint32_t count, struct hit *hits)
{
    if (packet_closest(w, rays, count, hits))
        return;
    for (uint32_t i = 0; i < count; i++)
        hit_closest(w, rays[i], &hits[i]);
}

#endif
