// SPDX-License-Identifier: MIT
/*
 * textures.h - reads the images that a scene's materials name
 *
 * Units:     texels, row 0 at the top
 * Ownership: the scene owns paths and texels
 * Threads:   one calls, all that the process may use read
 * Errors:    memory; an image that cannot be read, or that has no room beside
 *            the others (image_open()), is a warning
 */
#ifndef GLIM_TEXTURES_H
#define GLIM_TEXTURES_H

#include "scene/scene.h"

/* Reads the textures of the materials that have triangles. Where an image is
 * lost, the material's own colour is used, or grey if it has none. */
bool textures_load(struct scene *scene, struct warnings *report,
                   struct error *err);

/* The same for one material that has come into use, after textures_load(). */
bool textures_load_for(struct scene *scene, struct material *material,
                       struct warnings *report, struct error *err);

/* What the images of the scene hold: texels, and the sky with its table. */
uint64_t textures_bytes(const struct scene *scene);

/* True if all images of the material were looked for. */
bool textures_are_tried(const struct scene *scene,
                        const struct material *material);

#endif
