// SPDX-License-Identifier: MIT
/*
 * bvh8_instances.h - ray queries through the trees of a world with instances;
 * included by bvh8_traverse.h, whose walks it uses
 *
 * The walk through the tree of stand-ins goes on in the tree of the mesh, with
 * the ray in the mesh's space. The triangles of a block are moved to their
 * place before the test.
 *
 * Units:     normalised scene units
 * Threads:   any, on one world
 */
#ifndef GLIM_BVH8_INSTANCES_H
#define GLIM_BVH8_INSTANCES_H

#include "world/bvh/bvh8_leaf.h"
#include "kernels/instance.h"

/* One row of instance_point() for four points, in its order of operations. */
static inline f4 row_moved(struct vec3 row, float origin, const f4 p[3])
{
    f4 x = f4_mul(f4_set1(row.x), p[0]);
    f4 y = f4_mul(f4_set1(row.y), p[1]);
    f4 z = f4_mul(f4_set1(row.z), p[2]);

    return f4_add(f4_add(f4_add(x, y), z), f4_set1(origin));
}

/* instance_leaf_tri() for the triangles of a block. */
static inline struct tri_block block_moved(const struct instance *at,
                                           const struct tri_block *block)
{
    struct tri_block to;

    for (int k = 0; k < 3; k++) {
        const f4 p[3] = {f4_load(block->corners[k][0]),
                         f4_load(block->corners[k][1]),
                         f4_load(block->corners[k][2])};

        f4_store(to.corners[k][0], row_moved(at->rows[0], at->origin.x, p));
        f4_store(to.corners[k][1], row_moved(at->rows[1], at->origin.y, p));
        f4_store(to.corners[k][2], row_moved(at->rows[2], at->origin.z, p));
    }
    for (int i = 0; i < BLOCK_TRIS; i++)
        to.tri[i] = block->tri[i] == NO_INDEX ? NO_INDEX
                                              : at->first_tri + block->tri[i];
    return to;
}

/* A query in a world with instances. */
struct instances_query {
    const struct world *world;
    const struct bvh8 *tree;
    const struct instance *at; /* the instance whose mesh it is in */
    struct block_ray ray;
    struct bvh8_ray outer; /* the ray outside of meshes */
    struct hit *hit;
};

/* The rays that bound the ray in the space of a mesh, so that boxes are widened
 * by instance_ray(). */
static inline void bvh8_mesh_rays(const struct instance *at, struct ray r,
                                  struct bvh8_ray *first, struct bvh8_ray *last)
{
    struct mesh_ray m = instance_ray(*at, r);
    struct vec3 ahead =
        v3(copysignf(m.widen.x, m.d.x), copysignf(m.widen.y, m.d.y),
           copysignf(m.widen.z, m.d.z));

    bvh8_ray_axis(first, 0, m.o.x + ahead.x, m.d.x);
    bvh8_ray_axis(first, 1, m.o.y + ahead.y, m.d.y);
    bvh8_ray_axis(first, 2, m.o.z + ahead.z, m.d.z);
    bvh8_ray_axis(last, 0, m.o.x - ahead.x, m.d.x);
    bvh8_ray_axis(last, 1, m.o.y - ahead.y, m.d.y);
    bvh8_ray_axis(last, 2, m.o.z - ahead.z, m.d.z);
}

static inline __attribute__((always_inline)) bool
moved_blocks_hit(struct instances_query *q, const struct tri_block *block,
                 uint32_t more)
{
    bool found = false;

    for (;; more--, block++) {
        struct tri_block moved = block_moved(q->at, block);

        found |= blocks_hit(q->world, &q->ray, &moved, 0, q->hit);
        if (more == 0)
            return found;
    }
}

/* ---- nearest hit ---- */

static inline __attribute__((always_inline)) float
intersect_plain(void *query, const struct tri_block *block, uint32_t more)
{
    struct instances_query *q = query;

    blocks_hit(q->world, &q->ray, block, more, q->hit);
    return q->hit->t;
}

static inline __attribute__((always_inline)) float
intersect_moved(void *query, const struct tri_block *block, uint32_t more)
{
    struct instances_query *q = query;

    moved_blocks_hit(q, block, more);
    return q->hit->t;
}

/* Walks the tree that a stand-in leads to. */
static inline __attribute__((always_inline)) float
intersect_stand_in(void *query, const struct tri_block *block, uint32_t more)
{
    struct instances_query *q = query;
    const struct world *w = q->world;
    uint32_t instance = block->tri[0];

    (void)more;
    if (instance == NO_INDEX)
        return q->hit->t;
    if (instance == w->settings.instance_count) {
        bvh8_walk(q->tree->meshes[q->tree->mesh_count - 1].nodes, &q->outer,
                  &q->outer, q->hit->t, intersect_plain, q);
    } else {
        struct bvh8_ray first, last;

        q->at = &w->instances[instance];
        bvh8_mesh_rays(q->at, q->ray.ray, &first, &last);
        bvh8_walk(q->tree->meshes[q->at->mesh].nodes, &first, &last, q->hit->t,
                  intersect_moved, q);
    }
    return q->hit->t;
}

/* hit_closest() for finite rays in a world with instances. */
static __attribute__((noinline, flatten, unused)) void
instances_closest(const struct world *w, const struct bvh8 *tree, struct ray r,
                  struct hit *hit)
{
    struct instances_query q = {
        w, tree, NULL, block_ray_of(r, NO_INDEX), bvh8_ray_of(r), hit};

    bvh8_walk(tree->nodes, &q.outer, &q.outer, r.t_max, intersect_stand_in, &q);
}

/* ---- any hit ---- */

static inline __attribute__((always_inline)) bool
meets_plain(void *query, const struct tri_block *block, uint32_t more)
{
    struct instances_query *q = query;

    return blocks_hit(q->world, &q->ray, block, more, q->hit);
}

static inline __attribute__((always_inline)) bool
meets_moved(void *query, const struct tri_block *block, uint32_t more)
{
    return moved_blocks_hit(query, block, more);
}

static inline __attribute__((always_inline)) bool
meets_stand_in(void *query, const struct tri_block *block, uint32_t more)
{
    struct instances_query *q = query;
    uint32_t instance = block->tri[0];
    struct bvh8_ray first, last;

    (void)more;
    if (instance == NO_INDEX)
        return false;
    if (instance == q->world->settings.instance_count)
        return bvh8_any(q->tree->meshes[q->tree->mesh_count - 1].nodes,
                        &q->outer, &q->outer, q->hit->t, meets_plain, q);
    q->at = &q->world->instances[instance];
    bvh8_mesh_rays(q->at, q->ray.ray, &first, &last);
    return bvh8_any(q->tree->meshes[q->at->mesh].nodes, &first, &last,
                    q->hit->t, meets_moved, q);
}

/* hit_any() for finite rays in a world with instances. */
static __attribute__((noinline, flatten, unused)) bool
instances_any(const struct world *w, const struct bvh8 *tree, struct ray r,
              uint32_t tri)
{
    struct hit h = {r.t_max, 0.0f, 0.0f, 0.0f, tri};
    struct instances_query q = {
        w, tree, NULL, block_ray_of(r, tri), bvh8_ray_of(r), &h};

    return bvh8_any(tree->nodes, &q.outer, &q.outer, r.t_max, meets_stand_in,
                    &q);
}

#endif
