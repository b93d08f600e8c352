// SPDX-License-Identifier: MIT
/*
 * projection.h - from points of the scene to pixels: the camera's rays
 * backwards
 *
 * Units:     normalised scene units; pixels, (0, 0) is the top left corner
 * Threads:   any
 * Errors:    none; what is not before the eye has no place
 */
#ifndef GLIM_PROJECTION_H
#define GLIM_PROJECTION_H

#include <stdbool.h>

#include "kernels/types.h"

/* A part of a picture, in its pixels, that is shown with other pixels. */
struct projection_part {
    int x, y, width, height;
    int shown_width, shown_height;
};

/* The camera that sees the same part in the shown pixels, of which (0, 0) is
 * the part's corner. */
struct camera projection_camera(const struct camera *camera,
                                const struct projection_part *part);

struct projected {
    double x, y;  /* pixels */
    double depth; /* along the camera's forward */
};

/* False for what is not before the eye. */
bool projection_point(const struct camera *camera, struct vec3 p,
                      struct projected *to);

/* The part of the line from a to b that is before the eye; false: none. */
bool projection_line(const struct camera *camera, struct vec3 a, struct vec3 b,
                     struct projected to[2]);

#endif
