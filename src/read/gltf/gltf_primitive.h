// SPDX-License-Identifier: MIT
/*
 * gltf_primitive.h - the triangles of one primitive of a mesh
 *
 * Ownership: gltf_primitive_free(); a zeroed struct is empty
 * Threads:   one for each scene, and those of the pool
 * Errors:    accessors of the wrong type or length, indices out of range
 */
#ifndef GLIM_GLTF_PRIMITIVE_H
#define GLIM_GLTF_PRIMITIVE_H

#include "base/geometry.h"
#include "read/gltf/gltf_accessor.h"
#include "scene/scene.h"

/* JOINTS_0, JOINTS_1 and their weights. */
#define GLTF_JOINT_SETS 2

/* A morph target of a weight that is not 0. */
struct gltf_target {
    struct gltf_accessor positions, normals, tangents;
    bool has_positions, has_normals, has_tangents;
    double weight;
};

struct gltf_primitive {
    uint32_t mode; /* 4 triangles, 5 strip, 6 fan; others draw no faces */
    uint32_t material;
    uint32_t vertex_count, tri_count;
    struct gltf_accessor positions, normals, tangents, colors, indices;
    struct gltf_accessor uvs[2];
    bool has_normals, has_colors, has_indices;
    bool has_tangents;  /* beside normals */
    bool has_alphas;    /* the colours have a fourth number */
    bool has_uv_set[2]; /* each set */
    bool has_uvs;       /* one of them */
    struct gltf_accessor joints[GLTF_JOINT_SETS], weights[GLTF_JOINT_SETS];
    uint32_t joint_set_count;
    struct gltf_target *targets;
    uint32_t target_count;
};

/* What bends the vertices of a mesh and selects its materials. */
struct gltf_shape {
    const struct affine *joints; /* matrices from the mesh to the scene */
    uint32_t joint_count;
    uint32_t variant;      /* of materials; NO_INDEX: none */
    const double *weights; /* of morph targets */
    uint32_t weight_count;
};

/* Opens the primitive and its targets. Its triangle count is 0 if it has no
 * faces, which is a warning. */
bool gltf_primitive_open(const struct gltf_value *value,
                         const struct gltf_shape *shape,
                         struct gltf_primitive *p, struct warnings *report,
                         struct error *err);

/* Adds vertices and triangles to the scene, whose arrays have room for them.
 * Faces are counted on from *face_count. */
bool gltf_primitive_add(const struct gltf_value *value,
                        const struct gltf_primitive *p,
                        const struct gltf_shape *shape, struct scene *scene,
                        struct pool *pool, struct error *err);

void gltf_primitive_free(struct gltf_primitive *p);

#endif
