// SPDX-License-Identifier: MIT
/*
 * wide_hit.h - ray queries through the wide tree, for kernels/path.h
 *
 * They find the hits of kernels/traverse.h, to the bit: vector code only says
 * which triangles cannot be hit, kernels/hit.h decides on the others. Children
 * are visited by the distance at which the ray enters them.
 *
 * Units:     normalised scene units
 * Ownership: none
 * Threads:   any, on one world
 * Errors:    none
 */
#ifndef GLIM_WIDE_HIT_H
#define GLIM_WIDE_HIT_H

#include "glim/simd.h"
#include "glim/wide.h"
#include "kernels/traverse_leaf.h"

/* Entries that wait: all but one child of a node a level. */
#define WIDE_STACK (TRAVERSE_STACK * (WIDE_CHILDREN - 1) + 1)

static inline const struct wide *wide_of(const struct world *w)
{
    return ((const struct wide_world *)w)->tree;
}

/* A ray as box tests want it. */
struct wide_ray {
    float o[3], inverse[3];
    uint32_t near[3]; /* 0: the low plane comes first */
};

static inline struct wide_ray wide_ray_of(struct ray r)
{
    struct wide_ray s = {{r.o.x, r.o.y, r.o.z},
                         {1.0f / r.d.x, 1.0f / r.d.y, 1.0f / r.d.z},
                         {0, 0, 0}};

    for (int i = 0; i < 3; i++)
        s.near[i] = s.inverse[i] < 0.0f ? 1u : 0u;
    return s;
}

/* Which children the ray enters before t_max, and where; as box_entry(). */
static inline uint32_t wide_enter(const struct wide_node *n,
                                  const struct wide_ray *s, float t_max,
                                  float entries[WIDE_CHILDREN])
{
    f8 enter = f8_all(0.0f);
    f8 leave = f8_all(FLOAT_MAX);

    for (int i = 0; i < 3; i++) {
        f8 o = f8_all(s->o[i]);
        f8 inverse = f8_all(s->inverse[i]);
        f8 in = f8_load(n->planes[i][s->near[i]]);
        f8 out = f8_load(n->planes[i][s->near[i] ^ 1u]);

        enter = f8_max(f8_mul(f8_sub(in, o), inverse), enter);
        leave = f8_min(f8_mul(f8_sub(out, o), inverse), leave);
    }
    enter = f8_mul(enter, f8_all(1.0f - BOX_WIDEN));
    leave = f8_mul(leave, f8_all(1.0f + BOX_WIDEN));
    f8_store(entries, enter);
    return f8_not_above(enter, f8_min(leave, f8_all(t_max)));
}

/* Which triangles of a block the edge functions do not refuse: those of
 * triangle_hit(), where a 0 may have either sign. */
static inline uint32_t block_candidates(const struct tri_block *block,
                                        const struct shear *s)
{
    const float o[3] = {s->o.x, s->o.y, s->o.z};
    uint32_t kz = s->axis;
    uint32_t kx = kz == 2 ? 0 : kz + 1;
    uint32_t ky = kx == 2 ? 0 : kx + 1;
    f4 zero = f4_all(0.0f);
    f4 x[3], y[3], u[3];
    uint32_t not_below = 15, not_above = 15;

    for (int i = 0; i < 3; i++) {
        f4 z = f4_sub(f4_load(block->corners[i][kz]), f4_all(o[kz]));

        x[i] = f4_sub(f4_sub(f4_load(block->corners[i][kx]), f4_all(o[kx])),
                      f4_mul(f4_all(s->sx), z));
        y[i] = f4_sub(f4_sub(f4_load(block->corners[i][ky]), f4_all(o[ky])),
                      f4_mul(f4_all(s->sy), z));
    }
    u[0] = f4_sub(f4_mul(x[2], y[1]), f4_mul(y[2], x[1]));
    u[1] = f4_sub(f4_mul(x[0], y[2]), f4_mul(y[0], x[2]));
    u[2] = f4_sub(f4_mul(x[1], y[0]), f4_mul(y[1], x[0]));
    for (int i = 0; i < 3; i++) {
        not_below &= f4_not_above(zero, u[i]);
        not_above &= f4_not_above(u[i], zero);
    }
    return not_below | not_above;
}

static inline struct leaf_tri block_tri(const struct tri_block *b, uint32_t i)
{
    struct leaf_tri t = {
        {b->corners[0][0][i], b->corners[0][1][i], b->corners[0][2][i]},
        {b->corners[1][0][i], b->corners[1][1][i], b->corners[1][2][i]},
        {b->corners[2][0][i], b->corners[2][1][i], b->corners[2][2][i]},
        b->tri[i]};

    return t;
}

/* As leaf_hit() of kernels/traverse.h. */
static inline bool wide_leaf_hit(const struct world *w, struct ray r,
                                 struct shear s, uint32_t child,
                                 struct hit *best)
{
    const struct tri_block *block =
        &wide_of(w)->blocks[(child & ~WIDE_LEAF) >> 2];
    bool found = false;

    for (uint32_t more = child & WIDE_MORE;; more--, block++) {
        uint32_t candidates = block_candidates(block, &s);

        for (; candidates != 0; candidates &= candidates - 1) {
            uint32_t i = (uint32_t)__builtin_ctz(candidates);

            found |= tri_hit(w, r, s, block_tri(block, i), best);
        }
        if (more == 0)
            return found;
    }
}

struct wide_entry {
    float t;
    uint32_t child;
};

/* Puts the children of the mask on the stack, the nearest last. */
static inline struct wide_entry *wide_push(const struct wide_node *n,
                                           uint32_t mask, const float *entries,
                                           struct wide_entry *top)
{
    struct wide_entry *base = top;

    for (; mask != 0; mask &= mask - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(mask);
        struct wide_entry e = {entries[i], n->child[i]};
        struct wide_entry *at = top++;

        for (; at > base && at[-1].t < e.t; at--)
            *at = at[-1];
        *at = e;
    }
    return top;
}

/* Nearest hit up to r.t_max. */
static inline bool hit_closest(const struct world *w, struct ray r,
                               struct hit *best)
{
    const struct wide_node *nodes = wide_of(w)->nodes;
    struct wide_ray ray = wide_ray_of(r);
    struct shear shear = shear_of(r);
    struct wide_entry stack[WIDE_STACK];
    struct wide_entry *top = stack;

    best->t = r.t_max;
    best->b0 = best->b1 = best->b2 = 0.0f;
    best->tri = NO_INDEX;
    if (nodes == NULL)
        return false;
    *top++ = (struct wide_entry){0.0f, 0};
    while (top > stack) {
        struct wide_entry at = *--top;

        if (at.t > best->t)
            continue;
        if ((at.child & WIDE_LEAF) != 0) {
            wide_leaf_hit(w, r, shear, at.child, best);
        } else {
            _Alignas(32) float entries[WIDE_CHILDREN];
            const struct wide_node *n = &nodes[at.child];
            uint32_t mask = wide_enter(n, &ray, best->t, entries);

            top = wide_push(n, mask, entries, top);
        }
    }
    return best->tri != NO_INDEX;
}

/* As hit_any() of kernels/traverse.h. */
static inline bool hit_any(const struct world *w, struct ray r, uint32_t tri)
{
    const struct wide_node *nodes = wide_of(w)->nodes;
    struct wide_ray ray = wide_ray_of(r);
    struct shear shear = shear_of(r);
    uint32_t stack[WIDE_STACK];
    uint32_t depth = 0;
    struct hit h;

    if (nodes == NULL)
        return false;
    h.t = r.t_max;
    h.tri = tri;
    stack[depth++] = 0;
    while (depth > 0) {
        uint32_t at = stack[--depth];

        if ((at & WIDE_LEAF) != 0) {
            if (wide_leaf_hit(w, r, shear, at, &h))
                return true;
        } else {
            _Alignas(32) float entries[WIDE_CHILDREN];
            const struct wide_node *n = &nodes[at];
            uint32_t mask = wide_enter(n, &ray, r.t_max, entries);

            for (; mask != 0; mask &= mask - 1)
                stack[depth++] = n->child[__builtin_ctz(mask)];
        }
    }
    return false;
}

#endif
