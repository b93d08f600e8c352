// SPDX-License-Identifier: MIT
/*
 * surfaces.h - rays to the surfaces of a scene, for picks, and moves of the
 * camera that surfaces stop
 *
 * Both sides of a face are a surface. Cut-outs with an opacity below one half
 * are holes, so that picks are not random. The eye is a point. Each part of its
 * way is tested against the tree, and it stops COLLISION_MARGIN before a
 * surface. An eye that is nearer than that, or inside of a thing, can move in
 * every direction that is free.
 *
 * Units:     file units of the scene; pixels, (0, 0) is the top left corner of
 *            the picture
 * Ownership: scene and world stay the caller's
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_SURFACES_H
#define GLIM_SURFACES_H

#include "world/world.h"

/* ---- rays ---- */

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

/* The surface at a point of the picture. */
struct pick {
    uint32_t tri;
    uint32_t face;     /* number in the file, from 0 */
    uint32_t object;   /* index into scene.object_names */
    uint32_t material; /* index into the world's materials */
    double distance;   /* from the eye */
    double position[3];
};

enum surface_glass { SURFACE_GLASS_STOPS, SURFACE_GLASS_PASSES };

/* Finds the first surface on a ray with the unit direction d. `most` may be
 * INFINITY. Returns false if there is none nearer than `most`. */
bool surfaces_hit(const struct surfaces *s, const double from[3],
                  const double d[3], double most, enum surface_glass glass,
                  struct surface_hit *hit);

/* Finds the surface at a point of the picture of a view, as the render shows it
 * there, by a ray through the middle of the lens. Returns false, with *pick
 * unchanged, if there is only sky. */
bool surfaces_pick(const struct surfaces *s, const struct view *view,
                   double x_px, double y_px, struct pick *pick);

/* Share of directions with a hit from which a place counts as enclosed.
 * Measured: at least 0.98 in rooms and an arcade, at most 0.5 outdoors. */
#define CLEARANCE_ENCLOSED 0.75

/* Distances from a point to the surfaces around it. */
struct clearance {
    double nearest; /* distance of the nearest hit; INFINITY without one */
    /* distance within which a tenth of all directions hit a surface; INFINITY
     * if fewer hit any */
    double near;
    double box_distance; /* distance to the scene's bounding box; 0 inside */
    double hit_share;    /* share of directions that hit a surface */
};

/* Traces 64 rays in fixed directions all around, in 5 to 12 us. */
struct clearance surfaces_clearance(const struct surfaces *s,
                                    const double point[3]);

/* Returns the length of the diagonal of the scene's bounding box. */
double surfaces_size(const struct surfaces *s);

/* Computes the point at some distance from another one. */
void point_along(const double from[3], const double d[3], double distance,
                 double point[3]);

/* ---- moves ---- */

/* Distance that the eye keeps from surfaces, relative to the size of the scene.
 * It is 1000 times the rounding error of rays, and lets the eye through a gap
 * of 2 cm in a scene of 100 m. */
#define COLLISION_MARGIN 1e-4

/* Moves from `from` towards `to`, slides along the surfaces before it, and sets
 * `to` to the end. Returns true, with the object that is in the way, if a
 * surface takes most of the motion. */
bool collision_slide(const struct surfaces *s, const double from[3],
                     double to[3], uint32_t *object);

/* Moves the eye of an orbit around the pivot from `from` to `to`, which has the
 * same distance to the pivot. Comes nearer to the pivot where a surface is in
 * the way, and goes back to `distance` from it where none is. Sets `to` to the
 * end. Returns false if no way is free. */
bool collision_orbit(const struct surfaces *s, const double pivot[3],
                     double distance, const double from[3], double to[3]);

#endif
