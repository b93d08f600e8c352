// SPDX-License-Identifier: MIT
/*
 * pose.h - the camera's position, direction and lens
 *
 * Units:     file units of the scene, degrees
 * Threads:   any
 * Errors:    pose_check() for an impossible camera
 */
#ifndef GLIM_POSE_H
#define GLIM_POSE_H

#include <stdbool.h>

#include "base/error.h"

struct pose {
    double eye[3], at[3], up[3];
    double fovy_deg; /* vertical field of view; above 0, below 180 */
    double aperture; /* diameter of the lens; 0 for a pinhole */
    double
        focus; /* distance of the sharp plane from the eye; 0: that of `at` */
};

/* Unit vectors of the picture: to its right, to its top, and into it. The pole
 * is the normalised up vector of the pose. */
struct axes {
    double right[3], up[3], forward[3];
    double pole[3];
};

/* Returns false if eye, at, up and fovy do not define a camera. The error
 * begins with `place`. */
bool pose_check(const struct pose *pose, const char *place, struct error *err);

/* Computes the axes for any pose. If up is zero or parallel to the viewing
 * direction, the coordinate axis most perpendicular to that replaces it. If eye
 * and at coincide, the direction is -z. */
void pose_axes(const struct pose *pose, struct axes *axes);

/* Returns true if up is parallel to the viewing direction, so that pose_axes()
 * replaces it. */
bool pose_up_is_parallel(const struct pose *pose);

/* Returns the distance from eye to at, or 1 if it is 0 or not finite. */
double pose_reach(const struct pose *pose);

#endif
