// SPDX-License-Identifier: MIT
/*
 * gltf_material.h - the materials of a glTF document
 *
 * Ownership: everything belongs to the scene
 * Threads:   one for each scene
 * Errors:    memory; the place in the document
 */
#ifndef GLIM_GLTF_MATERIAL_H
#define GLIM_GLTF_MATERIAL_H

#include "read/gltf/gltf_document.h"
#include "scene/scene.h"

/* Adds all materials of the document to a scene that has the default only.
 * Material i of the document is material i + 1 of the scene; the default of
 * primitives without a material, if there are any, is the last. Their names are
 * unique, and their statements are those of MTL file 0. */
bool gltf_materials_read(const struct gltf_document *document,
                         struct scene *scene, struct warnings *report,
                         struct error *err);

/* Tells what to set for solid bodies of glass that Blender wrote without their
 * volume, after edits were read: glTF makes thin shells of them. */
void gltf_materials_hint(const struct gltf_document *document,
                         const struct scene *scene, struct warnings *report);

/* Sets *does if the alpha of the document's material counts: its alphaMode is
 * MASK or BLEND. */
bool gltf_material_has_alpha(const struct gltf_document *document,
                             uint32_t material, bool *does, struct error *err);

#endif
