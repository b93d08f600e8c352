// SPDX-License-Identifier: MIT
/*
 * traverse.h - ray queries through the tree of eight
 *
 * Children are visited in the order of the distances at which the ray enters
 * them. The winning hit does not depend on the tree: the nearest t, at equal t
 * the lowest triangle.
 *
 * With instances a walk through the tree of stand-ins goes on in the tree of
 * the mesh, with the ray in the mesh's space.
 *
 * Vectors are supplied by a file that is included first: src/base/simd8.h on
 * the CPU, simd_cl.h on a device.
 *
 * Units:     normalised scene units
 * Threads:   any, on one world
 */
#ifndef KERNELS_TRAVERSE_H
#define KERNELS_TRAVERSE_H

/* Hooks that count the tests of a query, for pictures of traversal cost. A file
 * that counts defines them before it includes this one. */
#ifndef COUNT_NODE
#define COUNT_NODE()
#define COUNT_BLOCK()
#endif

#include "kernels/traverse_block.h"

/* Entries of the stack: all but one child of a node for each level; with
 * instances those of two trees. */
#define BVH8_STACK                                                             \
    (TRAVERSE_STACK * (HAS(FEATURE_INSTANCES) ? 2 : 1) * (BVH8_CHILDREN - 1) + \
     1)

/* Least magnitude of a component of a direction. With it the box test
 * multiplies no infinity by 0. Across the scene such a ray drifts by less than
 * the padding of boxes. */
#define DIRECTION_MIN 0x1p-60f

/* Widening of the distances at which a ray leaves a box, twice EXIT_WIDEN, in
 * ulps. An ulp is at least FLOAT_EPSILON of the number; one more, as
 * f8_distance_lt() excludes equality. */
#define WIDEN_STEPS 33

/* False in a world without triangles, where devices have a buffer without
 * nodes. */
static inline bool has_tree(const struct world *w)
{
    return w->nodes != 0 && w->settings.tri_count > 0;
}

static inline struct hit no_hit(struct ray r)
{
    struct hit none = {r.t_max, 0.0f, 0.0f, 0.0f, NO_INDEX};

    return none;
}

/* ---- children ---- */

/* The node that a child names in the tree with this root. */
static inline GLOBAL const struct bvh8_node *
bvh8_node_at(GLOBAL const struct bvh8_node *root, uint32_t child)
{
    return (GLOBAL const void *)((GLOBAL const char *)root +
                                 (size_t)child * (BVH8_UNIT / 8));
}

/* The first block of the leaf that a child names. */
static inline GLOBAL const struct tri_block *
bvh8_block_at(GLOBAL const struct bvh8_node *root, uint32_t child)
{
    return (GLOBAL const void *)bvh8_node_at(root,
                                             child & ~(BVH8_LEAF | BVH8_MORE));
}

/* ---- boxes ---- */

/* A ray, prepared for box tests: a plane at p is at distance p * inverse -
 * start. If the origin is further from the scene than its size, the error is in
 * proportion to the distance, which WIDEN_STEPS cover; nearer, it is a small
 * part of BOX_PAD. */
struct bvh8_ray {
    f8 inverse[3], start[3];
    size_t near[3], far[3]; /* offsets in a node, in bytes */
};

/* Sets an axis of the ray. Without branches, which could not be predicted for
 * rays in all directions. */
static inline void bvh8_ray_axis(struct bvh8_ray *r, uint32_t axis, float o,
                                 float d)
{
    const size_t side = sizeof(float[BVH8_CHILDREN]);
    float inverse = 1.0f / copysignf(f_max(fabsf(d), DIRECTION_MIN), d);
    uint32_t low_is_far = float_bits(d) >> 31;

    r->inverse[axis] = f8_set1(inverse);
    r->start[axis] = f8_set1(o * inverse);
    r->near[axis] = (2 * axis + low_is_far) * side;
    r->far[axis] = (2 * axis + (low_is_far ^ 1u)) * side;
}

static inline struct bvh8_ray bvh8_ray_of(struct ray r)
{
    struct bvh8_ray s;

    bvh8_ray_axis(&s, 0, r.o.x, r.d.x);
    bvh8_ray_axis(&s, 1, r.o.y, r.d.y);
    bvh8_ray_axis(&s, 2, r.o.z, r.d.z);
    return s;
}

static inline f8 bvh8_planes(GLOBAL const struct bvh8_node *n, size_t offset,
                             f8 inverse, f8 start)
{
    GLOBAL const void *planes = (GLOBAL const char *)n + offset;

    return f8_mul_sub(f8_load(planes), inverse, start);
}

/* Returns the mask of children that the ray enters before t_far, and the
 * distances. For a packet, and for boxes that grow, `first` enters before all
 * rays along each axis and `last` leaves after them. */
static INLINED uint32_t bvh8_enter(GLOBAL const struct bvh8_node *n,
                                   const struct bvh8_ray *first,
                                   const struct bvh8_ray *last, float t_far,
                                   f8 *entries)
{
    f8 in[3], out[3], leave;

    COUNT_NODE();
    UNROLLED
    for (int i = 0; i < 3; i++) {
        in[i] =
            bvh8_planes(n, first->near[i], first->inverse[i], first->start[i]);
        out[i] = bvh8_planes(n, last->far[i], last->inverse[i], last->start[i]);
    }
    *entries = f8_distance_max(f8_distance_max(in[0], in[1]),
                               f8_distance_max(in[2], f8_set1(0.0f)));
    leave = f8_distance_min(f8_distance_min(out[0], out[1]), out[2]);
    leave = f8_distance_add_ulps(leave, WIDEN_STEPS);
    return f8_bits(
        f8_distance_lt(*entries, f8_distance_min(leave, f8_set1(t_far))));
}

/* Distance beyond which no child is entered, for a hit at t. Finite, as the
 * boxes of missing children are at infinity. */
static inline float bvh8_far(float t)
{
    return f_min(t * (1.0f + ENTRY_WIDEN), FLOAT_MAX);
}

/* ---- the walk ---- */

/* A walk through a tree. Its stack belongs to the query. Every node is visited
 * at most once, also for invalid rays, as missing children name the empty
 * block. So BVH8_STACK entries are enough for trees within the depth that bvh.h
 * promises. */
struct walk {
    GLOBAL const struct bvh8_node *nodes; /* the root of the tree */
    float t_far;  /* no child is entered beyond: bvh8_far() */
    uint32_t at;  /* the root, which is child 0, then the leaf that was found */
    size_t depth; /* entries of the stack, */
    size_t base;  /* of which these are of the tree of stand-ins */
};

static inline struct walk walk_begin(GLOBAL const struct bvh8_node *nodes,
                                     float t_max)
{
    struct walk k = {nodes, bvh8_far(t_max), 0, 0, 0};

    return k;
}

/* The first block of the leaf that was found. */
static inline GLOBAL const struct tri_block *walk_block(const struct walk *k)
{
    return bvh8_block_at(k->nodes, k->at);
}

/* The number of those that follow. */
static inline uint32_t walk_more(const struct walk *k)
{
    return k->at & BVH8_MORE;
}

/* Prefetches a node, or a block and what follows it. */
static inline void walk_prefetch(const struct walk *k, uint32_t child)
{
    GLOBAL const char *p = (GLOBAL const char *)bvh8_node_at(k->nodes, child);

    for (size_t i = 0; i < sizeof(struct bvh8_node); i += 64)
        PREFETCH(p + i);
}

/* Stack entry of the lowest child in the mask, which it removes: the bits of
 * the entry distance, which have the order of the distance, above the child.
 */
static inline uint64_t walk_entry(const struct walk *k,
                                  GLOBAL const struct bvh8_node *n,
                                  const float *entries, uint32_t *mask)
{
    uint32_t i = lowest_bit(*mask);

    *mask &= *mask - 1;
    walk_prefetch(k, n->child[i]);
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
static inline uint32_t walk_push(struct walk *k, uint64_t *stack,
                                 GLOBAL const struct bvh8_node *n,
                                 uint32_t mask, f8 enter)
{
    ALIGNED(32) float entries[BVH8_CHILDREN];
    size_t base = k->depth;
    uint64_t a, b, c, d;

    f8_store(entries, enter);
    a = walk_entry(k, n, entries, &mask);
    b = walk_entry(k, n, entries, &mask);
    sort_two(&a, &b);
    if (mask != 0) {
        c = walk_entry(k, n, entries, &mask);
        if (mask != 0) {
            d = walk_entry(k, n, entries, &mask);
            sort_two(&c, &d);
            sort_two(&a, &c);
            sort_two(&b, &d);
            stack[k->depth++] = d;
        } else {
            sort_two(&a, &c);
        }
        sort_two(&b, &c);
        stack[k->depth++] = c;
    }
    stack[k->depth++] = b;
    while (mask != 0) {
        uint64_t e = walk_entry(k, n, entries, &mask);
        size_t at = k->depth++;

        sort_two(&a, &e);
        for (; at > base && stack[at - 1] < e; at--)
            stack[at] = stack[at - 1];
        stack[at] = e;
    }
    return (uint32_t)a;
}

/* Takes the next child from the stack. Returns false if there is none. */
static inline bool walk_pop(struct walk *k, const uint64_t *stack)
{
    do {
        if (k->depth == k->base)
            return false;
        k->depth--;
    } while (stack[k->depth] >> 32 > float_bits(k->t_far));
    k->at = (uint32_t)stack[k->depth];
    return true;
}

/* Walks to the next leaf that the rays enter before k->t_far, nearest first;
 * see bvh8_enter(). Returns false if the tree has no more. */
static INLINED bool walk_nearest(struct walk *k, uint64_t *stack,
                                 const struct bvh8_ray *first,
                                 const struct bvh8_ray *last)
{
    if ((k->at & BVH8_LEAF) != 0 && !walk_pop(k, stack))
        return false;
    while ((k->at & BVH8_LEAF) == 0) {
        GLOBAL const struct bvh8_node *n = bvh8_node_at(k->nodes, k->at);
        f8 enter;
        uint32_t mask = bvh8_enter(n, first, last, k->t_far, &enter);

        if (mask == 0) {
            if (!walk_pop(k, stack))
                return false;
        } else if ((mask & (mask - 1)) == 0) {
            k->at = n->child[lowest_bit(mask)];
        } else {
            k->at = walk_push(k, stack, n, mask, enter);
        }
    }
    return true;
}

/* Takes the next child from the stack of walk_any(). Returns false if there is
 * none. */
static inline bool walk_pop_any(struct walk *k, const uint32_t *stack)
{
    if (k->depth == k->base)
        return false;
    k->at = stack[--k->depth];
    return true;
}

/* Walks to the next leaf that the rays enter before k->t_far, in any order.
 * Returns false if the tree has no more. */
static INLINED bool walk_any(struct walk *k, uint32_t *stack,
                             const struct bvh8_ray *first,
                             const struct bvh8_ray *last)
{
    if ((k->at & BVH8_LEAF) != 0 && !walk_pop_any(k, stack))
        return false;
    while ((k->at & BVH8_LEAF) == 0) {
        GLOBAL const struct bvh8_node *n = bvh8_node_at(k->nodes, k->at);
        f8 enter;
        uint32_t mask = bvh8_enter(n, first, last, k->t_far, &enter);

        if (mask == 0) {
            if (!walk_pop_any(k, stack))
                return false;
            continue;
        }
        for (; (mask & (mask - 1)) != 0; mask &= mask - 1) {
            uint32_t child = n->child[lowest_bit(mask)];

            stack[k->depth++] = child;
            walk_prefetch(k, child);
        }
        k->at = n->child[lowest_bit(mask)];
    }
    return true;
}

/* ---- instances ---- */

/* The place of a walk with instances, and the two rays that bound its rays
 * there and outside of meshes. */
struct instance_walk {
    struct bvh8_ray first, last, outer_first, outer_last;
    bool is_in_mesh; /* or among the triangles outside of meshes */
    GLOBAL const struct instance *at; /* NULL there */
};

static inline void instance_walk_begin(struct instance_walk *i,
                                       const struct bvh8_ray *first,
                                       const struct bvh8_ray *last)
{
    i->first = i->outer_first = *first;
    i->last = i->outer_last = *last;
    i->is_in_mesh = false;
    i->at = 0;
}

/* Enters the tree that the stand-in in a leaf leads to. Returns true if that is
 * of a mesh, where the rays are others. */
static inline bool instance_walk_enter(struct instance_walk *i, struct walk *k,
                                       const struct world *w)
{
    uint32_t stand_in = walk_block(k)->tri[0];

    if (stand_in == NO_INDEX)
        return false;
    i->is_in_mesh = true;
    k->base = k->depth;
    k->at = 0;
    k->nodes = (GLOBAL const void *)((GLOBAL const char *)w->nodes +
                                     (size_t)w->roots[stand_in] * BVH8_UNIT);
    if (stand_in == w->settings.instance_count)
        return false;
    i->at = &w->instances[stand_in];
    return true;
}

/* Sets the rays that bound a ray in a mesh, whose boxes instance_ray() widens.
 */
static inline void instance_walk_aim(struct instance_walk *i, struct ray r)
{
    struct mesh_ray m = instance_ray(*i->at, r);

    m.widen = v3(copysignf(m.widen.x, m.d.x), copysignf(m.widen.y, m.d.y),
                 copysignf(m.widen.z, m.d.z));
    bvh8_ray_axis(&i->first, 0, m.o.x + m.widen.x, m.d.x);
    bvh8_ray_axis(&i->first, 1, m.o.y + m.widen.y, m.d.y);
    bvh8_ray_axis(&i->first, 2, m.o.z + m.widen.z, m.d.z);
    bvh8_ray_axis(&i->last, 0, m.o.x - m.widen.x, m.d.x);
    bvh8_ray_axis(&i->last, 1, m.o.y - m.widen.y, m.d.y);
    bvh8_ray_axis(&i->last, 2, m.o.z - m.widen.z, m.d.z);
}

/* Returns from a tree that has no more leaves. Returns false if it is that of
 * the stand-ins. */
static inline bool instance_walk_leave(struct instance_walk *i, struct walk *k,
                                       const struct world *w)
{
    if (!i->is_in_mesh)
        return false;
    i->is_in_mesh = false;
    i->at = 0;
    i->first = i->outer_first;
    i->last = i->outer_last;
    k->base = 0;
    k->at = BVH8_LEAF;
    k->nodes = w->nodes;
    return true;
}

/* hit_closest() for finite rays in a world with instances. */
static RARE void instances_closest(const struct world *w, struct ray r,
                                   struct hit *hit)
{
    struct block_ray ray = block_ray_of(r, NO_INDEX);
    struct bvh8_ray boxes = bvh8_ray_of(r);
    struct walk k = walk_begin(w->nodes, r.t_max);
    uint64_t stack[BVH8_STACK];
    struct instance_walk i;

    instance_walk_begin(&i, &boxes, &boxes);
    do {
        while (walk_nearest(&k, stack, &i.first, &i.last)) {
            struct placed_block b = {walk_block(&k), i.at};

            if (!i.is_in_mesh) {
                if (instance_walk_enter(&i, &k, w))
                    instance_walk_aim(&i, r);
                continue;
            }
            blocks_hit(w, &ray, b, walk_more(&k), false, hit);
            k.t_far = bvh8_far(hit->t);
        }
    } while (instance_walk_leave(&i, &k, w));
}

/* hit_any() for finite rays in a world with instances. */
static RARE bool instances_any(const struct world *w, struct ray r,
                               uint32_t tri)
{
    struct block_ray ray = block_ray_of(r, tri);
    struct hit h = {r.t_max, 0.0f, 0.0f, 0.0f, tri};
    struct bvh8_ray boxes = bvh8_ray_of(r);
    struct walk k = walk_begin(w->nodes, r.t_max);
    uint32_t stack[BVH8_STACK];
    struct instance_walk i;

    instance_walk_begin(&i, &boxes, &boxes);
    do {
        while (walk_any(&k, stack, &i.first, &i.last)) {
            struct placed_block b = {walk_block(&k), i.at};

            if (!i.is_in_mesh) {
                if (instance_walk_enter(&i, &k, w))
                    instance_walk_aim(&i, r);
                continue;
            }
            if (blocks_hit(w, &ray, b, walk_more(&k), true, &h))
                return true;
        }
    } while (instance_walk_leave(&i, &k, w));
    return false;
}

/* ---- queries ---- */

/* Finds the nearest hit up to r.t_max. Returns false if there is none. */
static inline bool hit_closest(const struct world *w, struct ray r,
                               struct hit *hit)
{
    struct block_ray ray = block_ray_of(r, NO_INDEX);
    struct bvh8_ray boxes = bvh8_ray_of(r);
    struct walk k = walk_begin(w->nodes, r.t_max);
    uint64_t stack[BVH8_STACK];

    *hit = no_hit(r);
    if (!has_tree(w) || !ray_is_finite(r))
        return false;
    if (has_instances(w)) {
        instances_closest(w, r, hit);
        return hit->tri != NO_INDEX;
    }
    while (walk_nearest(&k, stack, &boxes, &boxes)) {
        struct placed_block b = {walk_block(&k), 0};

        blocks_hit(w, &ray, b, walk_more(&k), false, hit);
        k.t_far = bvh8_far(hit->t);
    }
    return hit->tri != NO_INDEX;
}

/* Returns true if the ray is occluded before r.t_max, or at r.t_max by a
 * triangle with a number below `tri`. The ray is aimed at the triangle `tri` at
 * distance r.t_max, so that this is true where hit_closest() would find another
 * hit. */
static inline bool hit_any(const struct world *w, struct ray r, uint32_t tri)
{
    struct hit h = {r.t_max, 0.0f, 0.0f, 0.0f, tri};
    struct block_ray ray = block_ray_of(r, tri);
    struct bvh8_ray boxes = bvh8_ray_of(r);
    struct walk k = walk_begin(w->nodes, r.t_max);
    uint32_t stack[BVH8_STACK];

    if (!has_tree(w) || !ray_is_finite(r))
        return false;
    if (has_instances(w))
        return instances_any(w, r, tri);
    while (walk_any(&k, stack, &boxes, &boxes)) {
        struct placed_block b = {walk_block(&k), 0};

        if (blocks_hit(w, &ray, b, walk_more(&k), true, &h))
            return true;
    }
    return false;
}

#endif
