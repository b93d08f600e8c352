// SPDX-License-Identifier: MIT
/*
 * pose_fit.h - the nearest place of a camera from which points are in the
 * picture
 *
 * Begin with the direction of a camera, add all points, and place the camera.
 *
 * Units:     points are relative to a centre, in a unit of the caller; aspect
 *            is a picture's width over its height
 * Threads:   any
 */
#ifndef GLIM_POSE_FIT_H
#define GLIM_POSE_FIT_H

#include "scene/pose.h"
#include "scene/scene.h"
#include "scene/view.h"

/* Share of the picture's width or height that the points fill. */
#define CAMERA_FILL 0.9

struct pose_fit {
    struct axes axes;
    double slope_x, slope_y; /* sides of the filled part at distance 1 */
    /* normals of the planes right, left, above and below, which go through the
     * eye, and how far the points are beyond planes through the centre */
    double planes[4][3], most[4];
    double last[4][3]; /* the points that are furthest beyond */
};

void pose_fit_begin(struct pose_fit *fit, const struct pose *pose,
                    double aspect);

/* Returns true if the point needs more room than those before. */
bool pose_fit_add(struct pose_fit *fit, const double point[3]);

/* Adds the corners of a box around the centre, with these halves of its
 * sides. */
void pose_fit_add_box(struct pose_fit *fit, const double half[3]);

/* Moves the camera, without turning it, so that the points just fit between two
 * opposite sides of the picture and are in its middle. The eye stays outside of
 * the sphere of this radius around the centre, since with a wide lens a corner
 * would be too near. `at` becomes a point at the depth of the centre, which is
 * in file units, as `unit`. If all points are in the centre, the distance
 * stays. */
void pose_fit_place(const struct pose_fit *fit, const double center[3],
                    double unit, double radius, struct pose *pose);

/* Places the camera of a view a little above the scene, so that the box around
 * it just fits into the picture. A model, of which two sides are seen, fits
 * itself. fovy, size and up stay. */
void scene_frame(const struct scene *scene, struct view *view);

#endif
