// SPDX-License-Identifier: MIT
/*
 * projection.h - projects points of the scene to pixels
 *
 * Units:     normalised scene units; pixels, (0, 0) is the top left corner
 * Threads:   any
 */
#ifndef GLIM_PROJECTION_H
#define GLIM_PROJECTION_H

#include <stdbool.h>

#include "kernels/types.h"

/* A rectangle of a picture, in pixels, that is shown at another resolution. */
struct projection_part {
    int x, y, width, height;
    int shown_width, shown_height;
};

/* Returns the camera of the shown pixels: same view, and pixel (0, 0) is the
 * corner of the part. */
struct camera projection_camera(const struct camera *camera,
                                const struct projection_part *part);

struct projected {
    double x, y;  /* pixels */
    double depth; /* distance along the camera's forward axis */
};

/* Projects a point. Returns false if it is not in front of the eye. */
bool projection_point(const struct camera *camera, struct vec3 p,
                      struct projected *to);

/* Projects the ends of the part of a line segment that is in front of the eye.
 * Returns false if there is no such part. */
bool projection_line(const struct camera *camera, struct vec3 a, struct vec3 b,
                     struct projected to[2]);

#endif
