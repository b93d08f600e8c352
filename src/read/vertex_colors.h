// SPDX-License-Identifier: MIT
/*
 * vertex_colors.h - colours of the vertices of a scene file
 *
 * Red, green and blue are sRGB. In OBJ files they are from 0 to 1, or to 255 if
 * one of the file is above 1, and vertices without a colour are white.
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

/* Sets the colour of vertex `index`, which the scene has. */
bool vertex_colors_set(struct scene *scene, size_t *capacity, uint32_t index,
                       const double rgb[3]);

/* Gives the other vertices a colour, and decodes all. */
bool vertex_colors_finish(struct scene *scene, size_t *capacity);

/* Returns the colour with 0 for numbers that are none and for those below 0. */
struct vec3 vertex_color_encoded(const double rgb[3]);

/* Returns 255 if a number is above 1, else 1. */
float vertex_colors_white(const struct vec3 *colors, size_t count);

/* Decodes sRGB colours, of which `white` is the largest number. */
void vertex_colors_decode(struct vec3 *colors, size_t count, float white);

#endif
