// SPDX-License-Identifier: MIT
/*
 * stl.h - reads STL files: triangles of CAD programs and 3D printers
 *
 * Units:     file units
 * Ownership: fills a scene that the caller frees, also after an error
 * Threads:   one thread
 * Errors:    one line with the place: a line of a text, or a byte
 */
#ifndef GLIM_STL_H
#define GLIM_STL_H

#include "scene/scene.h"

/* Returns true for the bytes of an STL file: a text that begins with "solid",
 * or binary data of exactly the size that they name. */
bool stl_matches(const char *bytes, size_t size_bytes);

/* Adds the triangles, whose equal corners become one vertex, an object for each
 * named solid, and the material "clay" to a zeroed scene. Normals of the file
 * are ignored: they are often wrong, and always those of flat faces. z is up.
 */
bool stl_parse(struct scene *scene, const char *bytes, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err);

#endif
