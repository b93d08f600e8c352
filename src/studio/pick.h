// SPDX-License-Identifier: MIT
/*
 * pick.h - what of a scene is seen at a point of its picture
 *
 * Through the middle of the lens, with the render's camera and its triangle
 * test: what is picked is what the render shows there. A half-transparent
 * surface counts as solid from one half on, for a pick is no chance.
 *
 * Units:     pixels, (0, 0) is the top left corner of the picture; file units
 * Ownership: the scene stays the caller's
 * Threads:   any, while the scene is only read
 */
#ifndef GLIM_PICK_H
#define GLIM_PICK_H

#include "scene/scene.h"
#include "terminal/cells.h"

struct pick {
    uint32_t tri;
    uint32_t face;     /* its number in the file, from 0 */
    uint32_t object;   /* of scene.object_names */
    uint32_t material; /* of scene.materials */
    double distance;   /* from the eye */
    double position[3];
};

/* False, with *pick unchanged, if there is only the sky. Looks at every
 * triangle: 17 ms for a million. */
bool pick_at(const struct scene *scene, const struct view *view, double x_px,
             double y_px, struct pick *pick);

/* The box around an object's triangles, in file units. */
void pick_bounds(const struct scene *scene, uint32_t object, double lo[3],
                 double hi[3]);

/* The point of a picture of width_px x height_px pixels, shown at `fit`, that
 * is in the middle of a cell. False outside of the picture. */
bool pick_point_of_cell(const struct fit *fit, int width_px, int height_px,
                        int col, int row, double *x_px, double *y_px);

#endif
