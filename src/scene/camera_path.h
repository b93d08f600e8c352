// SPDX-License-Identifier: MIT
/*
 * camera_path.h - poses of a moving camera: around a point, and along poses
 *
 * Units:     as pose.h; degrees
 * Threads:   any
 */
#ifndef GLIM_CAMERA_PATH_H
#define GLIM_CAMERA_PATH_H

#include "scene/pose.h"

/* Poses that camera_path_at() passes through, at most. */
#define CAMERA_PATH_MAX 16

/* Turns the eye around the axis through `at` along up, counter-clockwise seen
 * from above. Whole turns and quarters are exact. */
void pose_turn(struct pose *pose, double angle_deg);

/* Returns the pose at place u, from 0 to count - 1, of a smooth path through
 * the keys, of which there are at least two: pose i is at place i, unchanged.
 * The horizon stays level between keys with the same up. */
struct pose camera_path_at(const struct pose *keys, int count, double u);

#endif
