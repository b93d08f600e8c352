// SPDX-License-Identifier: MIT
/*
 * world_materials.h - changes the materials of a world, and which object has
 * which
 *
 * The changed arrays are built beside the current ones and swapped at the end,
 * so that lent arrays never change in place. Only arrays that depend on a
 * change are built: the lights if an emission changes, the triangles if an
 * object is assigned another material.
 *
 * Ownership: the world owns its arrays; sources are copied
 * Threads:   one, while nobody renders the world
 * Errors:    memory: the world stays as before, except for textures that were
 *            read
 */
#ifndef GLIM_WORLD_MATERIALS_H
#define GLIM_WORLD_MATERIALS_H

#include "world/world.h"

/* Sets the sources of all materials, and for each object the assigned material
 * or NO_INDEX for that of the file. `count` is the number of sources: the
 * scene's materials, then those of edits. */
bool world_set_materials(struct host_world *host, const struct scene *scene,
                         uint32_t count, const struct material_values *sources,
                         const uint32_t *assigned, struct error *err);

#endif
