// SPDX-License-Identifier: MIT
/*
 * scene_lists.h - adds materials and textures to the lists of a scene
 *
 * The caller keeps the capacity of each list, which is that of its parallel
 * arrays; at first it is the list's count.
 *
 * Ownership: names and paths are copied for the scene
 * Threads:   one thread
 * Errors:    false when memory is out
 */
#ifndef GLIM_SCENE_LISTS_H
#define GLIM_SCENE_LISTS_H

#include "scene/scene.h"

bool scene_add_material(struct scene *scene, size_t *capacity, const char *name,
                        const struct material *material,
                        const struct material_origin *origin);

bool scene_add_texture(struct scene *scene, size_t *capacity, const char *path,
                       const struct texture *texture,
                       const struct texture_origin *origin);

#endif
