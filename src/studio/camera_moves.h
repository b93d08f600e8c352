// SPDX-License-Identifier: MIT
/*
 * camera_moves.h - moves and turns the camera of a view, without ever rolling
 * it
 *
 * Units:     file units of the scene, radians
 * Ownership: the view stays the caller's
 * Threads:   any; no state but the caller's
 * Errors:    none; a camera that looks along `up` still has a right and an up
 */
#ifndef GLIM_CAMERA_MOVES_H
#define GLIM_CAMERA_MOVES_H

#include <stdbool.h>

#include "scene/view.h"

/* Moves eye and at by so much along the camera's own axes. */
void camera_move(struct view *view, double right, double up, double forward);

/* Moves on a ball around a point, to the right about the view's up axis and up
 * towards it: the point stays where it is seen. The poles are as those of
 * camera_turn(). */
void camera_orbit(struct view *view, const double around[3], double right_rad,
                  double up_rad);

/* Moves back or forward and sideways until a box just fits into the picture,
 * with a margin, but not into the ball around it; looks in the same direction,
 * at the depth of its centre. */
void camera_frame(struct view *view, const double lo[3], const double hi[3]);

/* False if no point of a box can be in the picture, wherever in it. */
bool camera_sees_box(const struct view *view, const double lo[3],
                     const double hi[3]);

/* How far a point is from the eye along the look: where a lens focuses on it.
 * Negative behind the eye. */
double camera_depth(const struct view *view, const double point[3]);

/* Makes what is seen `factor` times as wide in the middle of the picture, from
 * FOVY_MIN_DEG to FOVY_MAX_DEG. */
void camera_widen(struct view *view, double factor);

#define FOVY_MIN_DEG 0.1
#define FOVY_MAX_DEG 170.0

/* Part of the picture's width and height that camera_frame() fills. */
#define CAMERA_FILL 0.9

/* Turns the look to the right about the view's up axis and up towards it, as
 * far as just before the poles. The distance from eye to at stays. */
void camera_turn(struct view *view, double right_rad, double up_rad);

#endif
