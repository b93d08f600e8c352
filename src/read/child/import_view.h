// SPDX-License-Identifier: MIT
/*
 * import_view.h - cameras and lights of a file that libassimp has read
 *
 * Units:     file units, radians; intensities as in scene/lamp.h
 * Threads:   one
 */
#ifndef GLIM_IMPORT_VIEW_H
#define GLIM_IMPORT_VIEW_H

#include <stdbool.h>

#include "base/geometry.h"
#include "read/child/assimp_api.h"
#include "read/child/import_stream.h"

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

#endif
