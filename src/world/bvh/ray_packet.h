// SPDX-License-Identifier: MIT
/*
 * ray_packet.h - packets of coherent rays, intersected with a triangle all at
 * once
 *
 * Units:     normalised scene units
 * Threads:   any
 */
#ifndef GLIM_RAY_PACKET_H
#define GLIM_RAY_PACKET_H

#include <stdbool.h>
#include <stdint.h>

#include "base/simd8.h"
#include "world/bvh/bvh8_leaf.h"

#define PACKET_RAYS 8

/* Operands of simd_triangle_template.h: each lane has a ray, all have one
 * triangle. */
static inline f8 f8_corner(const float *place)
{
    return f8_set1(*place);
}

static inline f8 f8_ray(const float *place)
{
    return f8_load(place);
}

#define LANES      f8
#define LANES_RAYS PACKET_RAYS
#include "world/bvh/simd_triangle_template.h"

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
    uint32_t x_over_y = f8_mask_lt(y, x);
    uint32_t is_x = x_over_y & f8_mask_lt(z, x);
    uint32_t is_y = ~x_over_y & f8_mask_lt(z, y);
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
    return f8_mask_le(f8_abs(sum), f8_set1(FLOAT_MAX)) == (1u << g->count) - 1;
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

static inline void packet_intersect(struct ray_packet *g,
                                    const struct tri_block *block, uint32_t i)
{
    struct simd_hits h;

    if (!f8_test(block, i, &g->lanes, f8_load(g->t), ~0u, &h))
        return;
    for (; h.sure != 0; h.sure &= h.sure - 1) {
        uint32_t k = lowest_bit(h.sure);

        lane_accept(g->world, &h, k, &g->rays[k], block->tri[i], &g->hits[k]);
        g->t[k] = g->hits[k].t;
    }
    for (; h.unsure != 0; h.unsure &= h.unsure - 1) {
        uint32_t k = lowest_bit(h.unsure);
        struct shear s = {g->rays[k].o, g->lanes.sx[k], g->lanes.sy[k],
                          g->lanes.sz[k], g->lanes.axis};

        lane_retest(g->world, &g->rays[k], &s, block, i, &g->hits[k]);
        g->t[k] = g->hits[k].t;
    }
    g->t_max = packet_t_max(g);
}

#endif
