// SPDX-License-Identifier: MIT
/*
 * scene_materials.h - gives a finished scene other materials, and its objects
 *
 * Builds what changes beside what is there and swaps once, so that no array
 * that was lent to a world changes in its place: whoever keeps copies of arrays
 * by their addresses sees what is new. Geometry stays. Only what depends on a
 * change is built: the lights if one of them changes, the triangles if an
 * object gets another material.
 *
 * Ownership: the scene owns all; names and sources are copied
 * Threads:   one, while nobody renders the scene
 * Errors:    memory: the scene is as before, but for textures that were read
 */
#ifndef GLIM_SCENE_MATERIALS_H
#define GLIM_SCENE_MATERIALS_H

#include "scene/scene.h"

struct style {
    uint32_t material_count; /* at least the scene's: the others are new */
    char *const *names;
    const struct mtl_source *sources;
    const uint32_t *assigned; /* a material for each object; NO_INDEX: as in the
                                 file */
};

/* True if the scene has this style. */
bool scene_is_styled(const struct scene *scene, const struct style *style);

bool scene_restyle(struct scene *scene, const struct style *style,
                   struct error *err);

#endif
