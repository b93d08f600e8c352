// SPDX-License-Identifier: MIT
/*
 * vertex_colors.h - colours behind the coordinates of the vertices of an OBJ
 * file
 *
 * Red, green and blue are sRGB, from 0 to 1, or to 255 if one of the file is
 * above 1. Vertices without a colour are white.
 *
 * Units:     linear Rec.709 in the scene
 * Ownership: the array belongs to the scene
 * Threads:   one for each scene
 * Errors:    out of memory, as false
 */
#ifndef GLIM_VERTEX_COLORS_H
#define GLIM_VERTEX_COLORS_H

#include "scene/scene.h"

/* Sets the colour of the scene's last vertex. *capacity counts items of the
 * array; it is 0 at first. */
bool vertex_colors_put(struct scene *scene, size_t *capacity,
                       const double rgb[3]);

/* Gives the other vertices a colour, and decodes all. */
bool vertex_colors_finish(struct scene *scene, size_t *capacity);

#endif
