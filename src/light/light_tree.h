// SPDX-License-Identifier: MIT
/*
 * light_tree.h - builds the tree that finds lights
 *
 * Like a bounding volume hierarchy, by the surface area orientation heuristic
 * of Conty Estevez and Kulla 2018, 4.3. O(n log n); below LIGHT_SAH_DEPTH nodes
 * are split in halves by count, so that the way to every light fits
 * LIGHT_LEVELS. kernels/light_tree.h walks it.
 *
 * Units:     normalised scene units
 * Ownership: the nodes become the lights'
 * Threads:   one
 * Errors:    memory
 */
#ifndef GLIM_LIGHT_TREE_H
#define GLIM_LIGHT_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "light/lights.h"

struct emitter {
    struct vec3 lo, hi;
    struct vec3 normal; /* unit; its sign means nothing */
    double power;
    uint32_t light;
};

/* Makes the nodes for the lights, one emitter each, and fills in the ways to
 * them. Leaves the emitters in another order. */
bool light_tree_build(struct lights *lights, struct emitter *emitters,
                      struct error *err);

#endif
