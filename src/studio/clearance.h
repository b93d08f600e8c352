// SPDX-License-Identifier: MIT
/*
 * clearance.h - distances from a point to the surfaces around it
 *
 * Rays are traced in fixed directions all around.
 *
 * Units:     file units of the scene
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_CLEARANCE_H
#define GLIM_CLEARANCE_H

#include "studio/surfaces.h"

/* Share of directions with a hit from which a place counts as enclosed.
 * Measured: at least 0.98 in rooms and an arcade, at most 0.5 outdoors. */
#define CLEARANCE_ENCLOSED 0.75

struct clearance {
    double nearest; /* distance of the nearest hit; INFINITY without one */
    /* distance within which a tenth of all directions hit a surface; INFINITY
     * if fewer hit any */
    double near;
    double box_distance; /* distance to the scene's bounding box; 0 inside */
    double hit_share;    /* share of directions that hit a surface */
};

/* Returns the clearance of a point. Traces 64 rays, in 5 to 12 us. */
struct clearance clearance_of(const struct surfaces *s, const double point[3]);

#endif
