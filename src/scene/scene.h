// SPDX-License-Identifier: MIT
/*
 * scene.h - the contents of a scene's files: geometry, materials, names
 *
 * The loaders fill it in file units. scene_finish() drops unusable triangles
 * and normalises the vertices. world.h makes the arrays for the kernels from
 * it.
 *
 * Units:     file units in double until scene_finish(), normalised float after
 * Ownership: scene_free() frees everything; a zeroed struct is an empty scene
 * Threads:   one thread while loading, then read only
 * Errors:    memory; the message names the file
 */
#ifndef GLIM_SCENE_H
#define GLIM_SCENE_H

#include "base/error.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "base/warnings.h"
#include "scene/instances.h"
#include "scene/lamp.h"
#include "scene/material.h"
#include "scene/pose.h"
#include "scene/smoke.h"
#include "kernels/types.h"

/* Place of the first statement that names a texture. */
struct texture_origin {
    uint32_t file; /* index into mtl_paths; NO_INDEX for those of glTF */
    uint64_t line; /* 0 if the reader of the scene's file made the statement */
    double rotation_deg; /* as the statement has it */
    uint32_t image;      /* equal in textures of one image, however spelled */
    bool is_opacity;     /* its numbers are the image's alpha, if it has some */
};

/* Statements that a material was made from. */
struct material_origin {
    struct material_values source;
    uint32_t file; /* index into mtl_paths; NO_INDEX for the default */
};

/* What is read of a file that holds several scenes or poses. Entries are named
 * by their number, from 1, or by their name; NULL: the file's default. */
struct scene_choice {
    const char *scene;
    const char *animation; /* NULL: the first one */
    const char *variant;   /* of materials */
    bool has_time;         /* else the pose is that at rest */
    double time_s;         /* of the animation */
};

/* Camera of the scene file, in file units. */
struct scene_camera {
    char *name; /* "" if it has none */
    struct pose pose;
};

/* An image file that a scene file contains. */
struct scene_image {
    char *name; /* as texture_paths has it: "model.glb#image3" */
    void *bytes;
    size_t size_bytes;
};

/* Memory of a scene that is open, in sizes of the arrays that a reader fills:
 * growing and finishing them needs as much again, and the tree too. */
#define SCENE_FINISH 4

struct scene {
    char *path; /* path of the scene file */

    int thread_count; /* of the threads that may load it; 0 means one */
    struct scene_choice choice; /* the caller's, set before reading */
    bool has_choices;           /* its format has scenes and animations */
    const char *program; /* reads formats of others (import.h); may be NULL */
    bool up_is_z; /* axis of the file, as its format and its writer have it */

    /* only while loading; the arrays are freed by scene_finish() */
    struct memory_budget memory;      /* of what the file may still take */
    double *file_positions;           /* 3 coordinates for each vertex */
    struct scene_instances instances; /* its meshes stay: the kept ones */

    struct vec3 *positions;
    uint32_t position_count;
    struct vec3 *normals; /* unit length; 0 if the file's is unusable */
    uint32_t normal_count;
    struct vec2 *uvs;
    uint32_t uv_count;
    struct vec2 *uvs2;   /* second set, parallel to uvs; NULL: there is none */
    struct vec3 *colors; /* linear, of each vertex; NULL: the file has none */
    uint32_t color_count;
    float *alphas; /* of each vertex, factors of opacity; NULL: all are 1 */
    struct tangent *tangents; /* beside normals; NULL: the file has none */

    struct tri *tris;
    uint32_t *tri_faces;    /* number of the triangle's face, from 0 */
    uint32_t *tri_objects;  /* index into object_names */
    uint32_t tri_count;     /* each mesh once, behind all others */
    uint32_t dropped_count; /* triangles of the file that were dropped */

    /* from scene_finish() on; see kernels/instance.h */
    struct instance *placed;
    uint32_t *placed_objects; /* index into object_names */
    uint32_t placed_count;

    char **object_names; /* 0 is "": faces before the first o line */
    uint32_t object_count;

    struct scene_camera *cameras; /* a view without a camera has the first */
    uint32_t camera_count;
    struct lamps lamps;         /* a view without lamps has these */
    enum light_unit light_unit; /* as which the lamps were read */
    bool light_unit_is_guessed;
    struct smokes smokes; /* a view without smokes has these */

    struct material *materials; /* 0 is the default, named "" */
    char **material_names;
    struct material_origin *material_origins;
    uint32_t material_count;
    char **mtl_paths; /* paths of the MTL files, in order of reading */
    uint32_t mtl_path_count;
    char **data_paths; /* paths of further files, such as buffers of glTF */
    uint32_t data_path_count;
    bool has_own_mtl; /* the first is glim's, for edits, and may not exist */
    bool is_model;    /* one thing without a scene's light: lit as a studio */

    struct texture *textures; /* lookup parameters, without texels */
    char **texture_paths;
    struct texture_origin *texture_origins; /* their first statements */
    uint32_t texture_count;
    struct scene_image *images; /* that are no files of their own */
    size_t image_count;

    /* normalised = (file - center) * scale */
    double center[3];
    double scale;
    /* file units; without triangles those of smokes, else all 0 */
    double bounds_lo[3], bounds_hi[3];
};

/* Returns a pool of the threads that load the scene, for pool_destroy(), or
 * NULL if one is enough for this number of triangles or no other can start. */
struct pool *scene_pool(const struct scene *scene, uint32_t tri_count);

/* Drops triangles that have no area or a vertex that is not finite, with
 * warnings. Computes bounds, centre and scale, and fills positions from
 * file_positions, which it frees. */
bool scene_finish(struct scene *scene, struct warnings *report,
                  struct error *err);

/* Returns the memory of vertices, normals, texture coordinates and triangles,
 * in bytes. */
uint64_t scene_geometry_bytes(const struct scene *scene);

/* Returns the number of triangles with those of all instances. */
uint32_t scene_tri_total(const struct scene *scene);

/* Returns a world with the triangles and instances of a finished scene only. */
struct world scene_shape(const struct scene *scene);

/* Returns the object of a triangle, by its number. */
uint32_t scene_tri_object(const struct scene *scene, uint32_t tri);

/* Successive triangles of one object, by their numbers. A zeroed struct is
 * before the first ones. */
struct tri_run {
    uint32_t first, count;
    uint32_t placed; /* instances that were passed */
};

/* Goes on to the object's next run, or to that of any object if it is NO_INDEX.
 * Returns false after the last one. */
bool scene_next_run(const struct scene *scene, uint32_t object,
                    struct tri_run *run);

/* Converts a point of the scene from file units to normalised ones, and back.
 */
struct vec3 scene_point(const struct scene *scene, const double p[3]);
void scene_file_point(const struct scene *scene, struct vec3 p,
                      double point[3]);

/* Returns the index of a triangle in `tris`, by its number. */
uint32_t scene_tri_index(const struct scene *scene, uint32_t tri);

/* Returns the index of the object with this name, or NO_INDEX. */
uint32_t scene_find_object(const struct scene *scene, const char *name);

/* Returns true if both have the same triangles at the same places. Materials,
 * normals and texture coordinates may differ. */
bool scene_has_same_shape(const struct scene *a, const struct scene *b);

void scene_free(struct scene *scene);

#endif
