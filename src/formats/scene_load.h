// SPDX-License-Identifier: MIT
/*
 * scene_load.h - a scene from its files
 *
 * Units:     file units of the scene
 * Ownership: the scene is the caller's, for scene_free()
 * Threads:   one; images are read by some
 * Errors:    what is wrong in which line of which file
 */
#ifndef GLIM_SCENE_LOAD_H
#define GLIM_SCENE_LOAD_H

#include "scene/scene.h"

/* Loads an OBJ file with its MTL files and textures and finishes the scene.
 * up_is_z turns z-up models to y-up ((x, y, z) becomes (x, z, -y)). */
bool scene_load(struct scene *scene, const char *path, bool up_is_z,
                struct warnings *report, struct error *err);

#endif
