// SPDX-License-Identifier: MIT
/*
 * world_materials.h - gives a world other materials, and its objects
 *
 * Builds the arrays that change beside those that are there and swaps once, so
 * that no array that was lent changes in its place. Only what depends on a
 * change is built: the lights if one of them changes, the triangles if an
 * object gets another material.
 *
 * Ownership: the world owns all; sources are copied
 * Threads:   one, while nobody renders the world
 * Errors:    memory: the world is as before, but for textures that were read
 */
#ifndef GLIM_WORLD_MATERIALS_H
#define GLIM_WORLD_MATERIALS_H

#include "scene/world.h"

/* Gives each material these statements, and each object the material that is
 * assigned to it, or with NO_INDEX that of the file. There are `count`
 * materials: the scene's, and new ones after them. */
bool world_set_materials(struct host_world *host, const struct scene *scene,
                         uint32_t count, const struct mtl_source *sources,
                         const uint32_t *assigned, struct error *err);

#endif
