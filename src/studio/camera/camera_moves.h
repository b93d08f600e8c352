// SPDX-License-Identifier: MIT
/*
 * camera_moves.h - moves and turns a camera without roll
 *
 * Units:     file units of the scene, radians; aspect is a picture's width
 *            over its height
 * Threads:   any
 */
#ifndef GLIM_CAMERA_MOVES_H
#define GLIM_CAMERA_MOVES_H

#include <stdbool.h>

#include "scene/pose_fit.h"

/* Moves eye and at along the camera's axes. */
void camera_move(struct pose *pose, double right, double up, double forward);

/* Turns the viewing direction to the right about the pole and up towards it,
 * but not beyond 0.01 rad from the poles. The distance from eye to at stays. */
void camera_turn(struct pose *pose, double right_rad, double up_rad);

/* Moves the eye on a sphere around a point, to the right about the pole and up
 * towards it. The point keeps its place in the picture. Stops near the poles
 * like camera_turn(). */
void camera_orbit(struct pose *pose, const double around[3], double right_rad,
                  double up_rad);

/* Moves the camera, without turning it, so that a box just fits into the
 * picture (pose_fit_place()). */
void camera_frame(struct pose *pose, double aspect, const double lo[3],
                  const double hi[3]);

/* Returns false if no point of a box can be in the picture. */
bool camera_sees_box(const struct pose *pose, double aspect, const double lo[3],
                     const double hi[3]);

/* Returns the distance of a point from the eye along the viewing direction,
 * which is the focus distance for it. It is negative behind the eye. */
double camera_depth(const struct pose *pose, const double point[3]);

#define FOVY_MIN_DEG 0.1
#define FOVY_MAX_DEG 170.0

/* Multiplies the tangent of half the field of view by `factor`. The result is
 * between FOVY_MIN_DEG and FOVY_MAX_DEG. */
void camera_widen(struct pose *pose, double factor);

#endif
