// SPDX-License-Identifier: MIT
/*
 * scene_load.h - loads a scene from its files
 *
 * Units:     those of the OBJ file
 * Ownership: the caller frees scene and world
 * Threads:   one thread calls; images are decoded by several
 * Errors:    file and line, what was found and expected
 */
#ifndef GLIM_SCENE_LOAD_H
#define GLIM_SCENE_LOAD_H

#include "scene/world.h"

/* Loads an OBJ file with its MTL files and finishes the scene.
 * up_is_z turns z-up models to y-up: (x, y, z) becomes (x, z, -y). */
bool scene_load(struct scene *scene, const char *path, bool up_is_z,
                struct warnings *report, struct error *err);

/* Reads the view file of a scene: `view_path`, or if that is NULL STEM.view, or
 * camera.txt beside the scene; none of them need be there. *path is where the
 * view is kept, for free(), also after an error. */
bool view_find(struct view *view, const char *scene_path, const char *view_path,
               char **path, struct warnings *report, struct error *err);

/* Loads the scene, makes its world with the sky of the view, and completes the
 * view: a camera that sees the whole scene in a picture of its size, and a soft
 * sky where there is no light. */
bool scene_open(struct scene *scene, struct host_world *host, struct view *view,
                const char *path, bool up_is_z, struct warnings *report,
                struct error *err);

/* True if scene_open() has added the sky. */
bool view_has_soft_sky(const struct view *view);

/* Finds the material of each object that the view gives one, else NO_INDEX. */
void scene_find_assigned(const struct scene *scene,
                         const struct assigns *assigns, uint32_t *assigned,
                         struct warnings *report);

#endif
