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

struct style {
    uint32_t material_count; /* at least the scene's: the others are new */
    const struct mtl_source *sources;
    const uint32_t *assigned; /* a material for each object; NO_INDEX: as in the
                                 file */
};

/* True if the world has this style. */
bool world_is_styled(const struct host_world *host, const struct scene *scene,
                     const struct style *style);

bool world_restyle(struct host_world *host, const struct scene *scene,
                   const struct style *style, struct error *err);

#endif
