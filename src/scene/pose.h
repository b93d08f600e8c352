// SPDX-License-Identifier: MIT
/*
 * pose.h - the camera: where it stands, where it looks, its lens
 *
 * Units:     file units of the scene, degrees
 * Threads:   any
 * Errors:    an impossible camera
 */
#ifndef GLIM_POSE_H
#define GLIM_POSE_H

#include <stdbool.h>

#include "base/error.h"

struct pose {
    double eye[3], at[3], up[3];
    double fovy_deg; /* vertical; above 0, below 180 */
    double aperture; /* diameter of the lens; 0: a pinhole */
    double focus;    /* from eye to the sharp plane; 0: as far as at */
};

/* Unit vectors of the picture: to its right, to its top, into it. The pole is
 * the pose's up with length 1. */
struct axes {
    double right[3], up[3], forward[3];
    double pole[3];
};

/* Checks that eye, at, up and fovy make a camera. The place is for messages. */
bool pose_check(const struct pose *pose, const char *place, struct error *err);

/* Finds the axes, for any pose: where up says nothing, the axis that is least
 * along the look stands in for it; without a look it is -z. */
void pose_axes(const struct pose *pose, struct axes *axes);

/* Returns true if pose_axes() takes another axis for up, which runs along the
 * look. */
bool pose_up_is_parallel(const struct pose *pose);

/* Returns the distance from eye to at; 1 if they are in one point or too far
 * apart for a number. */
double pose_reach(const struct pose *pose);

#endif
