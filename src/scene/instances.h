// SPDX-License-Identifier: MIT
/*
 * instances.h - meshes of a scene, and the instances that place them
 *
 * A reader adds the vertices, normals and triangles of a mesh between
 * scene_begin_mesh() and scene_end_mesh(), in the mesh's own space and with
 * vertices and normals that no other triangle uses. A mesh is seen only where
 * scene_add_instance() places it. Triangles outside of meshes are seen where
 * they are.
 *
 * scene_flatten() replaces instances by copies where these take little memory,
 * since rays through copies take less time. It must copy meshes that shine,
 * because lights are triangles of the scene, and matrices that hardly have an
 * inverse.
 *
 * Units:     file units until instances_build()
 * Ownership: the lists and arrays belong to the scene
 * Threads:   one thread while loading
 * Errors:    memory; more triangles than have numbers
 */
#ifndef GLIM_INSTANCES_H
#define GLIM_INSTANCES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/geometry.h"
#include "base/warnings.h"

/* ---- meshes and instances ---- */

struct pool;
struct scene;

/* Ranges of the scene's arrays. */
struct scene_mesh {
    uint32_t first_tri, tri_count;
    uint32_t first_position, position_count;
    uint32_t first_normal, normal_count;
    /* from scene_finish() on: normalised = (mesh - center) * scale */
    double lo[3], hi[3], center[3], scale;
};

struct scene_instance {
    struct affine matrix;
    uint32_t mesh;
    uint32_t object; /* index into object_names, for all its triangles */
};

struct scene_instances {
    struct scene_mesh *meshes;
    uint32_t mesh_count;
    size_t mesh_capacity;
    struct scene_instance *items;
    uint32_t count;
    size_t capacity;
    /* most triangles that are copied where nothing else asks for copies;
     * scene_begin_mesh() sets it */
    uint64_t copied_tris;
};

/* Begins a mesh: what the reader adds from here on belongs to it. */
bool scene_begin_mesh(struct scene *scene, struct error *err);

/* Ends the mesh and returns its index. */
uint32_t scene_end_mesh(struct scene *scene);

/* Places a mesh. A matrix that mirrors also exchanges the sides of its faces,
 * so that the outside stays outside. */
bool scene_add_instance(struct scene *scene, uint32_t mesh,
                        const struct affine *matrix, uint32_t object,
                        struct error *err);

/* Replaces instances by copies of their meshes, removes meshes that have no
 * other instance, and puts the others behind all other triangles. Called by
 * scene_finish(). The pool may be NULL. */
bool scene_flatten(struct scene *scene, struct pool *pool, struct error *err);

void scene_instances_free(struct scene_instances *instances);

/* ---- arrays for kernels ---- */

struct scene;

/* Joins the bounds of the scene, unless has_bounds is false, with those of all
 * vertices of its instances. */
void instances_join_bounds(struct scene *scene, bool has_bounds);

/* Makes the scene's `placed`, after its meshes were normalised, and frees what
 * it is made of except the meshes. Instances that have no size are dropped. */
bool instances_build(struct scene *scene, struct warnings *report,
                     struct error *err);

#endif
