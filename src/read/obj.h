// SPDX-License-Identifier: MIT
/*
 * obj.h - reads Wavefront OBJ text
 *
 * Units:     file units
 * Ownership: fills a scene that the caller frees, also after an error
 * Threads:   one, which starts others for long texts
 * Errors:    malformed number, no OBJ statement at all, memory
 */
#ifndef GLIM_OBJ_H
#define GLIM_OBJ_H

#include "scene/scene.h"

/* Adds vertices, triangles, objects and materials (through mtl.h) of OBJ text,
 * which need not end in NUL, to a zeroed scene. `path` is used for messages and
 * to find MTL files. Without any, the materials are grey, or those of an MTL
 * file that was saved for them (mesh_finish.h). Faces with a bad index are
 * dropped and reported. */
bool obj_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err);

#endif
