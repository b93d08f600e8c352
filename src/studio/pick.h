// SPDX-License-Identifier: MIT
/*
 * pick.h - finds the surface at a point of the picture
 *
 * The ray goes through the middle of the lens. Camera and triangle test are
 * those of the render, so that the result is the surface seen there. Surfaces
 * with an opacity of at least one half count as opaque, so that picks are not
 * random.
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
    uint32_t face;     /* number in the file, from 0 */
    uint32_t object;   /* index into scene.object_names */
    uint32_t material; /* index into the world's materials */
    double distance;   /* distance from the eye */
    double position[3];
};

/* Finds the surface at a point of the picture. Returns false, with *pick
 * unchanged, if there is only sky. Tests every triangle: 17 ms for a
 * million. */
bool pick_at(const struct scene *scene, const struct host_world *host,
             const struct view *view, double x_px, double y_px,
             struct pick *pick);

/* Computes the bounding box of an object's triangles, in file units. */
void pick_bounds(const struct scene *scene, uint32_t object, double lo[3],
                 double hi[3]);

/* Computes the point of the picture at the centre of a cell. The picture has
 * width_px x height_px pixels and covers the cells of `fit`. Returns false for
 * a cell outside of these. */
bool pick_point_of_cell(const struct cells_rect *fit, int width_px,
                        int height_px, int col, int row, double *x_px,
                        double *y_px);

#endif
