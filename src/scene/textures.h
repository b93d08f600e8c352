// SPDX-License-Identifier: MIT
/*
 * textures.h - reads the images that the materials of a world name
 *
 * Units:     texels, row 0 at the top
 * Ownership: the world owns the texels
 * Threads:   one calls, all that the process may use read
 * Errors:    memory; an image that cannot be read, or that has no room beside
 *            the others (image_open()), is a warning
 */
#ifndef GLIM_TEXTURES_H
#define GLIM_TEXTURES_H

#include "scene/world.h"

/* Copies the scene's textures and reads the images of those that used materials
 * have. Where an image is lost, the material's own colour is used, or grey if
 * it has none. */
bool textures_load(struct host_world *host, const struct scene *scene,
                   struct warnings *report, struct error *err);

/* The same for one material that has come into use, after textures_load(). */
bool textures_load_for(struct host_world *host, const struct scene *scene,
                       struct material *material, struct warnings *report,
                       struct error *err);

/* Bytes of the world's images: texels, and the sky with its table. */
uint64_t textures_bytes(const struct host_world *host);

/* True if all images of the material were looked for. */
bool textures_are_tried(const struct host_world *host,
                        const struct material *material);

#endif
