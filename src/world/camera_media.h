// SPDX-License-Identifier: MIT
/*
 * camera_media.h - the bodies in which the eye is
 *
 * Threads:   any
 */
#ifndef GLIM_CAMERA_MEDIA_H
#define GLIM_CAMERA_MEDIA_H

#include "kernels/types.h"

/* Finds the bodies around a point in normalised units, by the faces of solids
 * that a ray from there to infinity meets. Open meshes count as bodies for
 * points on the inner side of the face that the ray meets. Of more than
 * MEDIA_MAX the innermost count. */
struct media camera_media(const struct world *w, struct vec3 eye);

#endif
