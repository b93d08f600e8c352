// SPDX-License-Identifier: MIT
/*
 * scene.h - what the files of a scene said: geometry, materials, names
 *
 * The loaders fill it in file units; scene_finish() drops what cannot be
 * rendered, normalises and makes it ready. world.h makes of it what samples
 * read.
 *
 * Units:     file units in double until scene_finish(), normalised float after
 * Ownership: scene_free() frees everything; a zeroed struct is an empty scene
 * Threads:   one thread while loading, then read only
 * Errors:    memory; files named by the text
 */
#ifndef GLIM_SCENE_H
#define GLIM_SCENE_H

#include "base/error.h"
#include "base/warnings.h"
#include "scene/material.h"
#include "kernels/types.h"

/* What a material was made from. */
struct texture_origin {
    uint32_t file; /* number of the MTL file */
    uint64_t line;
};

struct material_origin {
    struct mtl_source source;
    uint32_t file; /* of mtl_paths; NO_INDEX: none */
};

struct scene {
    char *path; /* of the OBJ file */

    /* while loading; freed by scene_finish() */
    double *file_positions; /* 3 a vertex */

    struct vec3 *positions;
    uint32_t position_count;
    struct vec3 *normals; /* unit length, or 0 where the file's is unusable */
    uint32_t normal_count;
    struct vec2 *uvs;
    uint32_t uv_count;

    struct tri *tris;
    uint32_t *tri_faces;   /* number of the face in the file, from 0 */
    uint32_t *tri_objects; /* index into object_names */
    uint32_t tri_count;
    uint32_t dropped_count; /* triangles of the file that are not here */

    char **object_names; /* 0 is "" : before the first o line */
    uint32_t object_count;

    struct material *materials; /* 0 is the default material, "" */
    char **material_names;
    struct material_origin *material_origins;
    uint32_t material_count;
    char **mtl_paths; /* of the files that were read, in order */
    uint32_t mtl_path_count;

    struct texture *textures; /* how they are looked up: no texels yet */
    char **texture_paths;
    struct texture_origin *texture_origins; /* the first statements of them */
    uint32_t texture_count;

    /* stored = (file - center) * scale */
    double center[3];
    double scale;
    double bounds_lo[3], bounds_hi[3]; /* file units; all 0 without triangles */
};

/* Drops triangles with a non-finite vertex or without area (counted in the
 * report), computes bounds, centre and scale, and fills positions from
 * file_positions. */
bool scene_finish(struct scene *scene, struct warnings *report,
                  struct error *err);

/* Of vertices, normals, texture coordinates and triangles. */
uint64_t scene_geometry_bytes(const struct scene *scene);

/* The object of this name, or NO_INDEX. */
uint32_t scene_find_object(const struct scene *scene, const char *name);

/* True if both have the same triangles at the same places, whatever their
 * materials, normals and texture coordinates. */
bool scene_has_same_shape(const struct scene *a, const struct scene *b);

void scene_free(struct scene *scene);

#endif
