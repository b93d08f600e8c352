// SPDX-License-Identifier: MIT
/*
 * obj.h - reads Wavefront OBJ text
 *
 * Units:     file units
 * Ownership: fills a scene that the caller frees, also after an error
 * Threads:   one thread
 * Errors:    unreadable file, malformed number, no OBJ statement at all, memory
 */
#ifndef GLIM_OBJ_H
#define GLIM_OBJ_H

#include "scene/scene.h"

/* Adds vertices, triangles, objects and materials (through mtl.h) to a zeroed
 * scene. Faces with a bad index are dropped and reported. */
bool obj_read(struct scene *scene, const char *path, struct warnings *report,
              struct error *err);

/* Reads OBJ text from memory, which need not end in NUL. `path` is used for
 * messages and to find MTL files. */
bool obj_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err);

#endif
