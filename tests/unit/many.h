// SPDX-License-Identifier: MIT
/*
 * many.h - meshes large enough for threads to share, and boxes around triangles
 *
 * Units:     normalised scene units
 * Ownership: mesh_free() frees the mesh
 * Threads:   one
 */
#ifndef TESTS_MANY_H
#define TESTS_MANY_H

#include "tests/unit/brute.h"
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include "kernels/traverse_leaf.h"

#include <math.h>

/* Enough triangles for several parts that threads share. */
#define MANY 70000

/* Adds triangles of many sizes; every tenth has the place of the previous
 * one. */
static inline void mesh_add_many(struct mesh *m, uint32_t count, uint64_t seed)
{
    struct vec3 a = {0, 0, 0};

    for (uint32_t i = 0; i < count; i++) {
        float size = ldexpf(0.5f, -(int)(check_random(&seed) * 8));

        if (i % 10 != 9)
            a = random_point(&seed, 0.8f);
        mesh_add(m, a, v3_add(a, random_point(&seed, size)),
                 v3_add(a, random_point(&seed, size)), 0);
    }
}

static inline bool v3_is_between(struct vec3 p, struct vec3 lo, struct vec3 hi)
{
    return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x &&
           p.y <= hi.y && p.z <= hi.z;
}

/* Has a tolerance for the rounding of rays. */
static inline bool box_holds(struct vec3 lo, struct vec3 hi,
                             const struct vec3 p[3])
{
    const struct vec3 pad = {BOX_PAD / 2, BOX_PAD / 2, BOX_PAD / 2};

    for (int k = 0; k < 3; k++)
        if (!v3_is_between(v3_sub(p[k], pad), lo, hi) ||
            !v3_is_between(v3_add(p[k], pad), lo, hi))
            return false;
    return true;
}

#endif
