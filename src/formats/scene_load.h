// SPDX-License-Identifier: MIT
/*
 * scene_load.h - loads a scene from its files
 *
 * Units:     those of the OBJ file
 * Ownership: the caller frees the scene with scene_free()
 * Threads:   one thread calls; images are decoded by several
 * Errors:    file and line, what was found and expected
 */
#ifndef GLIM_SCENE_LOAD_H
#define GLIM_SCENE_LOAD_H

#include "scene/scene.h"

/* Loads an OBJ file with its MTL files and textures and finishes the scene.
 * up_is_z turns z-up models to y-up: (x, y, z) becomes (x, z, -y). */
bool scene_load(struct scene *scene, const char *path, bool up_is_z,
                struct warnings *report, struct error *err);

#endif
