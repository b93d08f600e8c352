// SPDX-License-Identifier: MIT
/*
 * camera_moves.h - moves and turns a camera, without ever rolling it
 *
 * Units:     file units of the scene, radians; aspect is a picture's width
 *            over its height
 * Ownership: the pose stays the caller's
 * Threads:   any; no state but the caller's
 * Errors:    none; a camera that looks along `up` still has a right and an up
 */
#ifndef GLIM_CAMERA_MOVES_H
#define GLIM_CAMERA_MOVES_H

#include <stdbool.h>

#include "scene/pose.h"

/* Moves eye and at by so much along the camera's own axes. */
void camera_move(struct pose *pose, double right, double up, double forward);

/* Turns the look to the right about the pole and up towards it, as far as just
 * before the poles. The distance from eye to at stays. */
void camera_turn(struct pose *pose, double right_rad, double up_rad);

/* Moves on a ball around a point, to the right about the pole and up towards
 * it: the point stays where it is seen. Stops at the poles as camera_turn()
 * does. */
void camera_orbit(struct pose *pose, const double around[3], double right_rad,
                  double up_rad);

/* Part of the picture's width and height that camera_frame() fills. */
#define CAMERA_FILL 0.9

/* Moves back or forward and sideways until a box just fits into the picture,
 * with a margin, but not into the ball around it; looks in the same direction,
 * at the depth of its centre. */
void camera_frame(struct pose *pose, double aspect, const double lo[3],
                  const double hi[3]);

/* Returns false if no point of a box can be in the picture. */
bool camera_sees_box(const struct pose *pose, double aspect, const double lo[3],
                     const double hi[3]);

/* Returns how far a point is from the eye along the look: where a lens focuses
 * on it. Negative behind the eye. */
double camera_depth(const struct pose *pose, const double point[3]);

#define FOVY_MIN_DEG 0.1
#define FOVY_MAX_DEG 170.0

/* Makes the field of view `factor` times as wide in the middle of the picture,
 * within FOVY_MIN_DEG and FOVY_MAX_DEG. */
void camera_widen(struct pose *pose, double factor);

#endif
