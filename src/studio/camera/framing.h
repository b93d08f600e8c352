// SPDX-License-Identifier: MIT
/*
 * framing.h - finds a view of an object or of the whole scene
 *
 * Views from several directions and distances are compared by rays to points of
 * the object. Glass does not hide what is behind it. A view from within a room
 * stays in the room if the object can be seen there.
 *
 * Units:     file units of the scene; aspect is a picture's width over its
 *            height
 * Threads:   any, while scene and world are only read
 */
#ifndef GLIM_FRAMING_H
#define GLIM_FRAMING_H

#include "scene/pose.h"
#include "studio/camera/surfaces.h"

/* Points of the object to which rays are traced. */
#define FRAMING_POINTS 64

struct framing {
    const struct surfaces *surfaces;
    uint32_t object; /* NO_INDEX for the whole scene */
    double aspect;
    double lo[3], hi[3]; /* box that fills the picture */
    double points[FRAMING_POINTS][3];
    int point_count; /* 0 for an object without triangles */
};

/* Chooses the points of an object, or of the scene if it is NO_INDEX. They are
 * distributed over its triangles, so that details count more than walls. */
void framing_init(struct framing *f, const struct surfaces *surfaces,
                  uint32_t object, double aspect);

/* Moves the camera so that the object is seen, and fills the picture if nothing
 * is in the way. Turns it as little as is needed. Returns the share of points
 * that are seen, without those that only the object itself hides, or 0, with
 * the pose unchanged, if there is no such view. Takes milliseconds. */
double framing_find(const struct framing *f, struct pose *pose);

#endif
