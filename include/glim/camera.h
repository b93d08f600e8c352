// SPDX-License-Identifier: MIT
/*
 * camera.h - moves and turns the camera of a view
 *
 * Units:     file units of the scene, radians
 * Ownership: the view stays the caller's
 * Threads:   any; no state but the caller's
 * Errors:    none; a camera that looks along `up` still has a right and an up
 */
#ifndef GLIM_CAMERA_H
#define GLIM_CAMERA_H

#include "glim/view.h"

/* Moves eye and at by so much along the camera's own axes. */
void camera_move(struct view *view, double right, double up, double forward);

/* Turns the look to the right about the view's up axis and up towards it, as
 * far as just before the poles. The distance from eye to at stays. */
void camera_turn(struct view *view, double right_rad, double up_rad);

#endif
