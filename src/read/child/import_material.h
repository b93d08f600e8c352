// SPDX-License-Identifier: MIT
/*
 * import_material.h - materials of libassimp as MTL text, and its cameras and
 * lights
 *
 * Units:     file units, radians; intensities as in scene/lamp.h
 * Threads:   one
 * Errors:    memory, as false
 */
#ifndef GLIM_IMPORT_MATERIAL_H
#define GLIM_IMPORT_MATERIAL_H

#include <stdbool.h>
#include <stdio.h>

#include "base/geometry.h"
#include "base/name_table.h"
#include "read/child/assimp_api.h"
#include "read/child/import_stream.h"

/* ---- cameras and lights ---- */

#if HAS_ASSIMP

/* What is known of the program that wrote the file. libassimp hands numbers on
 * whose meaning depends on it. */
struct import_source {
    bool is_fbx, is_collada;
    bool is_blender; /* one of the two, by Blender's exporter */
    double units_per_meter;
};

struct import_source import_source_of(const struct aiScene *scene);

/* Returns the matrix of a node to its parent. */
struct affine import_matrix(const struct aiNode *node);

/* Fills a record. `matrix` is that of the node that places the camera. */
void import_camera_fill(const struct aiCamera *camera,
                        const struct affine *matrix, struct import_camera *to);

/* Fills a record. `center` is the middle of the scene. Returns false for kinds
 * that glim does not have: area lights and ambient light. */
bool import_lamp_fill(const struct aiLight *light, const struct affine *matrix,
                      const struct import_source *source,
                      const double center[3], struct import_lamp *to);

#endif

/* ---- materials ---- */

#if HAS_ASSIMP

struct import_materials {
    const struct assimp_api *api;
    const struct aiScene *scene; /* with embedded images */
    const char *path;            /* of the scene's file */
    const struct import_source *source;
    FILE *to;
    uint32_t *clamped_count; /* materials with an impossible roughness */
};

/* Writes the statements of a material. Its name is made unique with
 * `names`. */
bool import_material_write(const struct import_materials *m,
                           const struct aiMaterial *material,
                           struct name_table *names);

#endif

#endif
