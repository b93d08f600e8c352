// SPDX-License-Identifier: MIT
/*
 * light_tree.h - builds the light tree, which kernels/light_tree.h samples
 *
 * A bounding volume hierarchy of lights by the surface area orientation
 * heuristic (Conty Estevez and Kulla 2018, 4.3). O(n log n). Below
 * LIGHT_SAH_DEPTH levels nodes are split in halves by count, so that no light
 * is deeper than LIGHT_LEVELS.
 *
 * Units:     normalised scene units
 * Ownership: the nodes belong to the lights
 * Threads:   one
 * Errors:    memory
 */
#ifndef GLIM_LIGHT_TREE_H
#define GLIM_LIGHT_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "world/light/lights.h"

struct emitter {
    struct vec3 lo, hi;
    struct vec3 normal; /* unit vector; the sign means nothing; 0: no normal */
    float spread;       /* sine of a cone around the normal with more of them */
    double power;
    uint32_t light; /* area lights, then point lights */
};

/* Makes the nodes for area lights and point lights, one emitter each, and sets
 * the `path` of both. The order of the emitters changes. */
bool light_tree_build(struct lights *lights, struct emitter *emitters,
                      struct error *err);

#endif
