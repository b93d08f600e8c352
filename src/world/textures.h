// SPDX-License-Identifier: MIT
/*
 * textures.h - reads the images that the materials of a world name
 *
 * Units:     texels, row 0 at the top
 * Ownership: the world owns the texels
 * Threads:   one thread calls; the world's threads (world_pool()) decode
 * Errors:    memory; an image that cannot be read, or that does not fit into
 *            memory beside the others (image_open()), is a warning
 */
#ifndef GLIM_TEXTURES_H
#define GLIM_TEXTURES_H

#include "world/world.h"

/* Takes those textures of the scene that the world does not have, without
 * texels. Returns false when memory is out. */
bool textures_add(struct host_world *host, const struct scene *scene);

/* Takes the scene's textures and reads the images of those that used materials
 * name. A material whose image cannot be read has its own colour instead, or
 * grey if it has none or black. */
bool textures_load(struct host_world *host, const struct scene *scene,
                   struct warnings *report, struct error *err);

/* Loads the images of one material that came into use after textures_load(), in
 * the same way. `source` has its statements. */
bool textures_load_for(struct host_world *host, const struct scene *scene,
                       const struct material_values *source,
                       struct material *material, struct warnings *report,
                       struct error *err);

/* Returns the statements without the maps whose images could not be read: those
 * of the material that is rendered. */
struct material_values textures_found(const struct host_world *host,
                                      const struct material_values *source);

/* Returns the memory of the world's images in bytes: texels, and the sky image
 * with its table. */
uint64_t textures_bytes(const struct host_world *host);

/* Returns true if loading was tried for all images of the material. */
bool textures_are_tried(const struct host_world *host,
                        const struct material *material);

#endif
