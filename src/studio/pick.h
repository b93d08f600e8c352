// SPDX-License-Identifier: MIT
/*
 * pick.h - the surface that a picture shows at a point
 *
 * The ray goes through the middle of the lens, with the render's camera and its
 * triangle test, so a pick is what the render shows there. A surface with a
 * coverage of one half or more counts as solid: picks are not random.
 *
 * Units:     pixels, (0, 0) is the top left corner of the picture; file units
 * Ownership: the scene stays the caller's
 * Threads:   any, while the scene is only read
 */
#ifndef GLIM_PICK_H
#define GLIM_PICK_H

#include "scene/world.h"
#include "terminal/cells.h"

struct pick {
    uint32_t tri;
    uint32_t face;     /* its number in the file, from 0 */
    uint32_t object;   /* of scene.object_names */
    uint32_t material; /* of the world's */
    double distance;   /* from the eye */
    double position[3];
};

/* Finds the surface at a point of the picture. Returns false, with *pick
 * unchanged, if there is only the sky. Tests every triangle: 17 ms for a
 * million. */
bool pick_at(const struct scene *scene, const struct host_world *host,
             const struct view *view, double x_px, double y_px,
             struct pick *pick);

/* The bounding box of an object's triangles, in file units. */
void pick_bounds(const struct scene *scene, uint32_t object, double lo[3],
                 double hi[3]);

/* Finds the point of the picture in the middle of a cell. The picture has
 * width_px x height_px pixels and is shown at `fit`. Returns false outside of
 * it. */
bool pick_point_of_cell(const struct cells_rect *fit, int width_px,
                        int height_px, int col, int row, double *x_px,
                        double *y_px);

#endif
