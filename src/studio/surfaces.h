// SPDX-License-Identifier: MIT
/*
 * surfaces.h - rays to the surfaces of a scene, for moves of the camera
 *
 * Both sides of a face are a surface. Cut-outs with an opacity below one half
 * are holes, as for picks.
 *
 * Units:     file units of the scene
 * Ownership: scene and world stay the caller's
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_SURFACES_H
#define GLIM_SURFACES_H

#include "scene/world.h"

/* Least opacity of what counts as a surface. */
#define SURFACE_OPACITY 0.5f

/* The surfaces of a world. A world without a tree has none. */
struct surfaces {
    const struct scene *scene;
    const struct host_world *host;
};

struct surface_hit {
    double distance;
    double normal[3]; /* unit vector, on the side of the ray's origin */
    uint32_t object;
};

enum surface_glass { SURFACE_GLASS_STOPS, SURFACE_GLASS_PASSES };

/* Finds the first surface on a ray with the unit direction d. `most` may be
 * INFINITY. Returns false if there is none nearer than `most`. */
bool surfaces_hit(const struct surfaces *s, const double from[3],
                  const double d[3], double most, enum surface_glass glass,
                  struct surface_hit *hit);

/* Returns the length of the diagonal of the scene's bounding box. */
double surfaces_size(const struct surfaces *s);

/* Computes the point at some distance from another one. */
void point_along(const double from[3], const double d[3], double distance,
                 double point[3]);

#endif
