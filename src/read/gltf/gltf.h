// SPDX-License-Identifier: MIT
/*
 * gltf.h - reads glTF 2.0 scenes, .gltf and .glb
 *
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene, and those of its pool
 * Errors:    the place in the JSON, what was found and expected
 */
#ifndef GLIM_GLTF_H
#define GLIM_GLTF_H

#include "read/gltf/gltf_document.h"
#include "scene/scene.h"

/* Adds the contents of a file to a zeroed scene, which the caller frees, also
 * after an error. */
bool gltf_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err);

#endif
