// SPDX-License-Identifier: MIT
/*
 * mtl.h - reads Wavefront MTL text and maps it to glim's materials
 *
 * Units:     MATERIALS in the man page has the unit of each statement
 * Ownership: adds materials, names and textures to the scene
 * Threads:   one thread
 * Errors:    malformed number, memory; a missing file is the caller's warning
 */
#ifndef GLIM_MTL_H
#define GLIM_MTL_H

#include "scene/scene.h"

/* Adds the materials of the text. A text of the scene's own MTL file may define
 * those of an earlier one anew. */
bool mtl_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err);

/* Adds material 0 if the scene has no material. Returns false when memory is
 * out. */
bool mtl_add_default(struct scene *scene, struct error *err);

/* Returns the index of the material of this name, or NO_INDEX. */
uint32_t mtl_find(const struct scene *scene, const char *name);

#endif
