// SPDX-License-Identifier: MIT
/*
 * bvh8_traverse.h - ray queries through the tree of eight, for kernels/path.h
 *
 * They find the hits of kernels/traverse.h, to the bit. Children are visited in
 * the order of the distances at which the ray enters them.
 *
 * Units:     normalised scene units
 * Threads:   any, on one world
 */
#ifndef GLIM_BVH8_TRAVERSE_H
#define GLIM_BVH8_TRAVERSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/simd8.h"
#include "world/bvh/ray_packet.h"

/* Entries of the stack: all but one child of a node for each level. */
#define BVH8_STACK (TRAVERSE_STACK * (BVH8_CHILDREN - 1) + 1)

/* Least magnitude of a component of a direction. With it the box test
 * multiplies no infinity by 0. Across the scene such a ray drifts by less than
 * the padding of boxes. */
#define DIRECTION_MIN 0x1p-60f

/* Widening of the distances at which a ray leaves a box, twice EXIT_WIDEN, in
 * ulps. An ulp is at least FLOAT_EPSILON of the number; one more, as
 * f8_distance_mask_lt() excludes equality. */
#define WIDEN_STEPS 33

static inline struct hit no_hit(struct ray r)
{
    struct hit none = {r.t_max, 0.0f, 0.0f, 0.0f, NO_INDEX};

    return none;
}

static inline const struct bvh8 *bvh8_of(const struct world *w)
{
    return ((const struct bvh8_world *)w)->tree;
}

/* A ray, prepared for box tests: a plane at p is at distance p * inverse -
 * start. If the origin is further from the scene than its size, the error is in
 * proportion to the distance, which WIDEN_STEPS cover; nearer, it is a small
 * part of BOX_PAD. */
struct bvh8_ray {
    f8 inverse[3], start[3];
    size_t near[3], far[3]; /* offsets in a node's planes, in bytes */
};

/* Sets an axis of the ray. Without branches, which could not be predicted for
 * rays in all directions. */
static inline void bvh8_ray_axis(struct bvh8_ray *r, int axis, float o, float d)
{
    float inverse = 1.0f / copysignf(f_max(fabsf(d), DIRECTION_MIN), d);
    uint32_t low_is_far = float_bits(d) >> 31;
    size_t low = offsetof(struct bvh8_node, planes[axis][0]);

    r->inverse[axis] = f8_set1(inverse);
    r->start[axis] = f8_set1(o * inverse);
    r->near[axis] = low + low_is_far * sizeof(float[BVH8_CHILDREN]);
    r->far[axis] = low + (low_is_far ^ 1u) * sizeof(float[BVH8_CHILDREN]);
}

static inline struct bvh8_ray bvh8_ray_of(struct ray r)
{
    struct bvh8_ray s;

    bvh8_ray_axis(&s, 0, r.o.x, r.d.x);
    bvh8_ray_axis(&s, 1, r.o.y, r.d.y);
    bvh8_ray_axis(&s, 2, r.o.z, r.d.z);
    return s;
}

static inline f8 bvh8_planes(const struct bvh8_node *n, size_t offset,
                             f8 inverse, f8 start)
{
    const void *planes = (const char *)n + offset;

    return f8_mul_sub(f8_load(planes), inverse, start);
}

/* Returns the mask of children that the ray enters before t_far, and the
 * distances; see box_entry(). For a packet, `first` enters before all rays
 * along each axis and `last` leaves after them. */
static inline __attribute__((always_inline)) uint32_t
bvh8_enter(const struct bvh8_node *n, const struct bvh8_ray *first,
           const struct bvh8_ray *last, float t_far, f8 *entries)
{
    f8 in[3], out[3], leave;

    for (int i = 0; i < 3; i++) {
        in[i] =
            bvh8_planes(n, first->near[i], first->inverse[i], first->start[i]);
        out[i] = bvh8_planes(n, last->far[i], last->inverse[i], last->start[i]);
    }
    *entries = f8_distance_max(f8_distance_max(in[0], in[1]),
                               f8_distance_max(in[2], f8_set1(0.0f)));
    leave = f8_distance_min(f8_distance_min(out[0], out[1]), out[2]);
    leave = f8_distance_add_ulps(leave, WIDEN_STEPS);
    return f8_distance_mask_lt(*entries,
                               f8_distance_min(leave, f8_set1(t_far)));
}

/* Distance beyond which no child is entered, for a hit at t. Finite, as the
 * boxes of missing children are at infinity. */
static inline float bvh8_far(float t)
{
    return f_min(t * (1.0f + ENTRY_WIDEN), FLOAT_MAX);
}

static inline const struct bvh8_node *bvh8_node_at(const struct bvh8_node *root,
                                                   uint32_t child)
{
    return (const void *)((const char *)root + (size_t)child * (BVH8_UNIT / 8));
}

static inline const struct tri_block *
bvh8_block_at(const struct bvh8_node *root, uint32_t child)
{
    return (const void *)bvh8_node_at(root, child & ~(BVH8_LEAF | BVH8_MORE));
}

/* Prefetches a node, or a block and what follows it. */
static inline void bvh8_prefetch(const struct bvh8_node *root, uint32_t child)
{
    const char *p = (const char *)bvh8_node_at(root, child);

    for (size_t i = 0; i < sizeof *root; i += 64)
        __builtin_prefetch(p + i);
}

/* Stack entry of the lowest child in the mask, which it removes: the bits of
 * the entry distance, which have the order of the distance, above the code of
 * the child. */
static inline uint64_t bvh8_child_key(const struct bvh8_node *nodes,
                                      const struct bvh8_node *n,
                                      const float entries[BVH8_CHILDREN],
                                      uint32_t *mask)
{
    uint32_t i = lowest_bit(*mask);

    *mask &= *mask - 1;
    bvh8_prefetch(nodes, n->child[i]);
    return (uint64_t)float_bits(entries[i]) << 32 | n->child[i];
}

/* Sorts two entries without a branch, as half of the predictions would be
 * wrong. */
static inline void sort_two(uint64_t *a, uint64_t *b)
{
    uint64_t less = *a < *b ? *a : *b;

    *b = *a < *b ? *b : *a;
    *a = less;
}

/* Returns the nearest of two or more children and pushes the others, nearer
 * ones on top. Most are two to four, which a sorting network sorts. */
static inline uint32_t bvh8_push_children(const struct bvh8_node *nodes,
                                          const struct bvh8_node *n,
                                          uint32_t mask, f8 enter,
                                          uint64_t **stack)
{
    _Alignas(32) float entries[BVH8_CHILDREN];
    uint64_t *base = *stack, *top = base;
    uint64_t a, b, c, d;

    f8_store(entries, enter);
    a = bvh8_child_key(nodes, n, entries, &mask);
    b = bvh8_child_key(nodes, n, entries, &mask);
    sort_two(&a, &b);
    if (mask != 0) {
        c = bvh8_child_key(nodes, n, entries, &mask);
        if (mask != 0) {
            d = bvh8_child_key(nodes, n, entries, &mask);
            sort_two(&c, &d);
            sort_two(&a, &c);
            sort_two(&b, &d);
            *top++ = d;
        } else {
            sort_two(&a, &c);
        }
        sort_two(&b, &c);
        *top++ = c;
    }
    *top++ = b;
    while (mask != 0) {
        uint64_t e = bvh8_child_key(nodes, n, entries, &mask);
        uint64_t *at = top++;

        sort_two(&a, &e);
        for (; at > base && at[-1] < e; at--)
            *at = at[-1];
        *at = e;
    }
    *stack = top;
    return (uint32_t)a;
}

/* Callback of a traversal for the blocks of a leaf, of which `more` follow the
 * first. Returns the distance beyond which hits no longer count. */
typedef float bvh8_leaf(void *query, const struct tri_block *block,
                        uint32_t more);

/* Visits the leaves that are entered before t_max, nearest first; see
 * bvh8_enter(). Every node is visited at most once, also for invalid rays, as
 * missing children name the empty block. So BVH8_STACK is enough for trees
 * within the depth that bvh.h promises. */
static inline __attribute__((always_inline)) void
bvh8_walk(const struct bvh8_node *nodes, const struct bvh8_ray *first,
          const struct bvh8_ray *last, float t_max, bvh8_leaf *leaf,
          void *query)
{
    uint64_t stack[BVH8_STACK];
    uint64_t *top = stack;
    float t_far = bvh8_far(t_max);
    uint32_t at = 0;

    for (;;) {
        if ((at & BVH8_LEAF) == 0) {
            const struct bvh8_node *n = bvh8_node_at(nodes, at);
            f8 enter;
            uint32_t mask = bvh8_enter(n, first, last, t_far, &enter);

            if (mask != 0) {
                at = n->child[lowest_bit(mask)];
                if ((mask & (mask - 1)) != 0)
                    at = bvh8_push_children(nodes, n, mask, enter, &top);
                continue;
            }
        } else {
            t_far =
                bvh8_far(leaf(query, bvh8_block_at(nodes, at), at & BVH8_MORE));
        }
        do {
            if (top == stack)
                return;
            top--;
        } while (*top >> 32 > float_bits(t_far));
        at = (uint32_t)*top;
    }
}

/* Callback of a traversal for any hit. Returns true if the ray is occluded. */
typedef bool bvh8_any_leaf(void *query, const struct tri_block *block,
                           uint32_t more);

/* Visits the leaves that are entered before t_max, in any order, until one
 * occludes the ray. */
static inline __attribute__((always_inline)) bool
bvh8_any(const struct bvh8_node *nodes, const struct bvh8_ray *first,
         const struct bvh8_ray *last, float t_max, bvh8_any_leaf *leaf,
         void *query)
{
    float t_far = bvh8_far(t_max);
    uint32_t stack[BVH8_STACK];
    uint32_t *top = stack;
    uint32_t at = 0;

    for (;;) {
        if ((at & BVH8_LEAF) == 0) {
            const struct bvh8_node *n = bvh8_node_at(nodes, at);
            f8 enter;
            uint32_t mask = bvh8_enter(n, first, last, t_far, &enter);

            if (mask != 0) {
                for (; (mask & (mask - 1)) != 0; mask &= mask - 1) {
                    *top = n->child[lowest_bit(mask)];
                    bvh8_prefetch(nodes, *top);
                    top++;
                }
                at = n->child[lowest_bit(mask)];
                continue;
            }
        } else if (leaf(query, bvh8_block_at(nodes, at), at & BVH8_MORE)) {
            return true;
        }
        if (top == stack)
            return false;
        at = *--top;
    }
}

#include "world/bvh/bvh8_instances.h"

struct bvh8_query {
    const struct world *world;
    struct block_ray ray;
    struct hit *hit;
};

static inline __attribute__((always_inline)) float
intersect_blocks(void *query, const struct tri_block *block, uint32_t more)
{
    struct bvh8_query *q = query;

    blocks_hit(q->world, &q->ray, block, more, q->hit);
    return q->hit->t;
}

/* Finds the nearest hit up to r.t_max. Returns false if there is none. */
static inline bool hit_closest(const struct world *w, struct ray r,
                               struct hit *hit)
{
    const struct bvh8_node *nodes = bvh8_of(w)->nodes;
    struct bvh8_query query = {w, block_ray_of(r, NO_INDEX), hit};
    struct bvh8_ray ray = bvh8_ray_of(r);

    *hit = no_hit(r);
    if (nodes == NULL || !ray_is_finite(r))
        return false;
    if (has_instances(w))
        instances_closest(w, bvh8_of(w), r, hit);
    else
        bvh8_walk(nodes, &ray, &ray, r.t_max, intersect_blocks, &query);
    return hit->tri != NO_INDEX;
}

/* Least number of rays in a packet, and the largest distance between them at
 * distance 1. Measured with lenses: a third of it takes 10 % less time for a
 * picture without bounces, twice as much 20 % more. */
#define PACKET_MIN    2
#define PACKET_SPREAD 0x1p-5f

/* Sets an axis of the two rays that bound all rays of a packet. Returns false
 * if the directions differ in sign or the rays are too far apart. */
static inline bool bvh8_bound(struct bvh8_ray *first, struct bvh8_ray *last,
                              int axis, const struct ray_packet *g)
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

static inline __attribute__((always_inline)) float
intersect_packet(void *query, const struct tri_block *block, uint32_t more)
{
    struct ray_packet *g = query;

    for (;; more--, block++) {
        for (uint32_t i = 0; i < BLOCK_TRIS && block->tri[i] != NO_INDEX; i++)
            packet_intersect(g, block, i);
        if (more == 0)
            return g->t_max;
    }
}

/* Traces rays as one packet. Returns false, with no answer, where they are too
 * few or go too far apart for it. */
static inline bool packet_closest(const struct world *w, const struct ray *rays,
                                  uint32_t count, struct hit *hits)
{
    const struct bvh8_node *nodes = bvh8_of(w)->nodes;
    struct bvh8_ray first, last;
    struct ray_packet g;

    if (nodes == NULL || count < PACKET_MIN || has_instances(w))
        return false;
    packet_begin(&g, w, rays, count, hits);
    if (!packet_is_finite(&g) || !bvh8_bound(&first, &last, 0, &g) ||
        !bvh8_bound(&first, &last, 1, &g) ||
        !bvh8_bound(&first, &last, 2, &g) || !packet_shear(&g.lanes))
        return false;
    for (uint32_t i = 0; i < count; i++)
        hits[i] = no_hit(rays[i]);
    bvh8_walk(nodes, &first, &last, g.t_max, intersect_packet, &g);
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

static inline __attribute__((always_inline)) bool
meets_blocks(void *query, const struct tri_block *block, uint32_t more)
{
    struct bvh8_query *q = query;

    return blocks_hit(q->world, &q->ray, block, more, q->hit);
}

/* hit_any() of kernels/traverse.h. */
static inline bool hit_any(const struct world *w, struct ray r, uint32_t tri)
{
    const struct bvh8_node *nodes = bvh8_of(w)->nodes;
    struct hit h = {r.t_max, 0.0f, 0.0f, 0.0f, tri};
    struct bvh8_query query = {w, block_ray_of(r, tri), &h};
    struct bvh8_ray ray = bvh8_ray_of(r);

    if (nodes == NULL || !ray_is_finite(r))
        return false;
    if (has_instances(w))
        return instances_any(w, bvh8_of(w), r, tri);
    return bvh8_any(nodes, &ray, &ray, r.t_max, meets_blocks, &query);
}

#endif
