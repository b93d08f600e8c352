// SPDX-License-Identifier: MIT
/*
 * ply.h - reads PLY files: meshes of scanners and of most mesh programs
 *
 * Units:     file units
 * Ownership: fills a scene that the caller frees, also after an error
 * Threads:   one thread
 * Errors:    one line with the place: a line of the header or of ascii data,
 *            or a byte of binary data
 */
#ifndef GLIM_PLY_H
#define GLIM_PLY_H

#include "scene/scene.h"

/* Adds vertices, triangles of faces and tristrips, the object "" and the
 * material "clay" to a zeroed scene. */
bool ply_parse(struct scene *scene, const char *bytes, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err);

#endif
