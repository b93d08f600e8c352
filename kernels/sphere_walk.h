// SPDX-License-Identifier: MIT
/*
 * sphere_walk.h - finds the point lights with a radius that a ray may meet, by
 * a walk through the light tree
 *
 * The box of a cluster of lights is bounded by a sphere, too. Testing all
 * lights one by one makes paths take 4 times as long with 200 spheres.
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_SPHERE_WALK_H
#define KERNELS_SPHERE_WALK_H

#include "kernels/light_tree.h"

/* Added to the squared radius of a cluster, in squares of its distance: many
 * times the rounding of the ray's distance from its middle. */
#define WALK_SLACK 1e-5f

/* The nodes on the way to the current one, with the children that are left. */
struct sphere_walk {
    uint32_t nodes[LIGHT_LEVELS];
    uint32_t left[LIGHT_LEVELS];
    uint32_t level;
};

/* Children of a node that the ray may meet before its t_max, as bits. */
static inline uint32_t sphere_walk_children(const struct world *w,
                                            uint32_t node, struct ray r)
{
    uint32_t bits = 0;

    for (uint32_t i = 0; i < LIGHT_WIDTH; i++) {
        float x = w->light_nodes[node].x[i] - r.o.x;
        float y = w->light_nodes[node].y[i] - r.o.y;
        float z = w->light_nodes[node].z[i] - r.o.z;
        float square = x * x + y * y + z * z;
        float middle = x * r.d.x + y * r.d.y + z * r.d.z;
        float radius = w->light_nodes[node].radius[i];
        float reach = radius * radius + WALK_SLACK * square;
        float ahead = f_max(middle, 0.0f);
        float before = f_max(middle - r.t_max, 0.0f);
        /* squared distance of the middle from the way of the ray */
        float aside = square - ahead * ahead + before * before;

        bits |=
            (uint32_t)(w->light_nodes[node].power[i] > 0.0f && aside <= reach)
            << i;
    }
    return bits;
}

/* Begins at the root. There are at least two lights. */
static inline void sphere_walk_begin(struct sphere_walk *s,
                                     const struct world *w, struct ray r)
{
    s->level = 0;
    s->nodes[0] = 0;
    s->left[0] = sphere_walk_children(w, 0, r);
}

/* Returns the next light of the tree that the ray may meet, or NO_INDEX. */
static inline uint32_t sphere_walk_next(struct sphere_walk *s,
                                        const struct world *w, struct ray r)
{
    for (;;) {
        uint32_t left = s->left[s->level];
        uint32_t i = 0, child;

        if (left == 0) {
            if (s->level == 0)
                return NO_INDEX;
            s->level--;
            continue;
        }
        while ((left >> i & 1u) == 0)
            i++;
        s->left[s->level] = left & (left - 1u);
        child = w->light_nodes[s->nodes[s->level]].child[i];
        if ((child & LIGHT_LEAF) != 0)
            return child & ~LIGHT_LEAF;
        s->level++;
        s->nodes[s->level] = child;
        s->left[s->level] = sphere_walk_children(w, child, r);
    }
}

#endif
