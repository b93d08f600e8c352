// SPDX-License-Identifier: MIT
/*
 * traverse.h - ray queries through the binary tree
 *
 * Queries of OpenCL devices, and the reference for those of the CPU. The
 * winning hit does not depend on the tree: the nearest t, at equal t the lowest
 * triangle.
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_TRAVERSE_H
#define KERNELS_TRAVERSE_H

#include "kernels/traverse_leaf.h"

/* Hooks that count the tests of a query, for pictures of traversal cost. A file
 * that counts defines them before it includes this one. */
#ifndef COUNT_BOX
#define COUNT_BOX()
#define COUNT_TRIANGLE()
#endif

struct slabs {
    struct vec3 o;
    struct vec3 inverse;
    struct vec3 widen; /* of boxes, only with FEATURE_INSTANCES */
};

/* Entries of the stack: with instances those of two trees. */
#define QUERY_STACK ((HAS(FEATURE_INSTANCES) ? 2 : 1) * TRAVERSE_STACK)

static inline struct slabs slabs_of(struct ray r)
{
    struct slabs s;

    s.o = r.o;
    s.inverse = v3(1.0f / r.d.x, 1.0f / r.d.y, 1.0f / r.d.z);
    s.widen = v3(0.0f, 0.0f, 0.0f);
    return s;
}

/* The slabs of a ray in an instance, or in the triangles outside of meshes. */
static inline struct slabs slabs_in(const struct world *w, struct ray r,
                                    uint32_t instance)
{
    struct slabs s = slabs_of(r);

    if (instance != NO_INDEX) {
        struct mesh_ray m = instance_ray(w->instances[instance], r);

        s.o = m.o;
        s.inverse = v3(1.0f / m.d.x, 1.0f / m.d.y, 1.0f / m.d.z);
        s.widen = m.widen;
    }
    return s;
}

/* Intersects the slab between two planes. Where the origin lies in a plane 0 *
 * inf is NaN, and f_min and f_max keep the other value. */
static inline void slab_axis(float lo, float hi, float o, float inverse,
                             float *enter, float *leave)
{
    float a = (lo - o) * inverse;
    float b = (hi - o) * inverse;
    float in = inverse < 0.0f ? b : a;
    float out = inverse < 0.0f ? a : b;

    *enter = f_max(in, *enter);
    *leave = f_min(out, *leave);
}

/* Distance at which the ray enters the box, or infinity if it misses the box or
 * enters it beyond t_max. */
static inline float box_entry(struct slabs s, struct vec3 lo, struct vec3 hi,
                              float t_max)
{
    float enter = 0.0f;
    float leave = FLOAT_MAX;

    COUNT_BOX();
    if (HAS(FEATURE_INSTANCES)) {
        lo = v3_sub(lo, s.widen);
        hi = v3_add(hi, s.widen);
    }
    slab_axis(lo.x, hi.x, s.o.x, s.inverse.x, &enter, &leave);
    slab_axis(lo.y, hi.y, s.o.y, s.inverse.y, &enter, &leave);
    slab_axis(lo.z, hi.z, s.o.z, s.inverse.z, &enter, &leave);
    enter *= 1.0f - ENTRY_WIDEN;
    leave *= 1.0f + EXIT_WIDEN;
    return enter <= leave && enter <= t_max ? enter : bits_float(0x7f800000u);
}

/* Tests the triangles of a leaf, where the instance shows them. Returns true if
 * one is a nearer hit. */
static inline bool leaf_hit(const struct world *w, struct ray r, struct shear s,
                            struct node leaf, uint32_t instance,
                            struct hit *best)
{
    bool found = false;

    for (uint32_t i = 0; i < leaf.count; i++) {
        struct leaf_tri t = w->leaf_tris[leaf.next + i];

        COUNT_TRIANGLE();
        if (HAS(FEATURE_INSTANCES) && instance != NO_INDEX)
            t = instance_leaf_tri(w->instances[instance], t);
        if (tri_hit(w, r, s, t, best))
            found = true;
    }
    return found;
}

/* Finds the nearest hit up to r.t_max. Returns false if there is none. With
 * instances the first tree leads to the trees of meshes. `base` is the depth of
 * the stack where the ray entered that of a mesh. */
static inline bool hit_closest(const struct world *w, struct ray r,
                               struct hit *best)
{
    struct slabs slabs = slabs_of(r);
    struct shear shear = shear_of(r);
    uint32_t stack[QUERY_STACK];
    float entries[QUERY_STACK];
    uint32_t depth = 0;
    uint32_t at = 0;
    uint32_t instance = NO_INDEX, base = NO_INDEX;
    bool is_in_tris = !has_instances(w);

    best->t = r.t_max;
    best->b0 = best->b1 = best->b2 = 0.0f;
    best->tri = NO_INDEX;
    if (w->settings.tri_count == 0 || !ray_is_finite(r) ||
        box_entry(slabs, w->nodes[0].lo, w->nodes[0].hi, best->t) > best->t)
        return false;
    for (;;) {
        struct node n = w->nodes[at];

        if (n.count == 0) {
            uint32_t near = at + 1;
            uint32_t far = n.next;
            float near_entry =
                box_entry(slabs, w->nodes[near].lo, w->nodes[near].hi, best->t);
            float far_entry =
                box_entry(slabs, w->nodes[far].lo, w->nodes[far].hi, best->t);

            if (far_entry < near_entry) {
                uint32_t index = near;
                float entry = near_entry;

                near = far;
                near_entry = far_entry;
                far = index;
                far_entry = entry;
            }
            if (near_entry <= best->t) {
                if (far_entry <= best->t) {
                    stack[depth] = far;
                    entries[depth] = far_entry;
                    depth++;
                }
                at = near;
                continue;
            }
        } else if (HAS(FEATURE_INSTANCES) && !is_in_tris) {
            is_in_tris = true;
            base = depth;
            instance = n.next;
            slabs = slabs_in(w, r, instance);
            at = n.count;
            continue;
        } else {
            leaf_hit(w, r, shear, n, instance, best);
        }
        do {
            if (HAS(FEATURE_INSTANCES) && depth == base) {
                is_in_tris = false;
                base = NO_INDEX;
                slabs = slabs_of(r);
            }
            if (depth == 0)
                return best->tri != NO_INDEX;
            depth--;
        } while (entries[depth] > best->t);
        at = stack[depth];
    }
}

/* Finds the nearest hits of `count` rays. */
static inline void hits_closest(const struct world *w, const struct ray *rays,
                                uint32_t count, struct hit *hits)
{
    for (uint32_t i = 0; i < count; i++)
        hit_closest(w, rays[i], &hits[i]);
}

/* Returns true if the ray is occluded before r.t_max, or at r.t_max by a
 * triangle with a number below `tri`. The ray is aimed at the triangle `tri` at
 * distance r.t_max, so that this is true where hit_closest() would find another
 * hit. Children are visited in any order. */
static inline bool hit_any(const struct world *w, struct ray r, uint32_t tri)
{
    struct slabs slabs = slabs_of(r);
    struct shear shear = shear_of(r);
    uint32_t stack[QUERY_STACK];
    uint32_t depth = 0;
    uint32_t instance = NO_INDEX, base = NO_INDEX;
    bool is_in_tris = !has_instances(w);
    struct hit h;

    if (w->settings.tri_count == 0 || !ray_is_finite(r))
        return false;
    h.t = r.t_max;
    h.tri = tri;
    stack[depth++] = 0;
    while (depth > 0) {
        uint32_t at = stack[--depth];
        struct node n = w->nodes[at];

        if (HAS(FEATURE_INSTANCES) && depth < base && base != NO_INDEX) {
            is_in_tris = false;
            base = NO_INDEX;
            slabs = slabs_of(r);
        }
        while (box_entry(slabs, n.lo, n.hi, r.t_max) <= r.t_max) {
            if (HAS(FEATURE_INSTANCES) && n.count != 0 && !is_in_tris) {
                is_in_tris = true;
                base = depth;
                instance = n.next;
                slabs = slabs_in(w, r, instance);
                at = n.count;
                n = w->nodes[at];
                continue;
            }
            if (n.count != 0) {
                if (leaf_hit(w, r, shear, n, instance, &h))
                    return true;
                break;
            }
            stack[depth++] = n.next;
            at = at + 1;
            n = w->nodes[at];
        }
    }
    return false;
}

#endif
