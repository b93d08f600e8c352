// SPDX-License-Identifier: MIT
/*
 * instanced.h - scenes with instances, made of OBJ text
 *
 * Each object whose name begins with "mesh" becomes a mesh, in the order of the
 * file. Its vertices and normals follow those of the object before.
 *
 * Ownership: scene_free() frees the scene
 * Errors:    a failure ends the test
 */
#ifndef TESTS_INSTANCED_H
#define TESTS_INSTANCED_H

#include <math.h>
#include <string.h>

#include "read/mtl.h"
#include "read/obj.h"
#include "tests/unit/check.h"
#include "kernels/vec.h"

/* Widens a range of indices by one of them. */
static inline void instanced_widen(uint32_t i, uint32_t *first, uint32_t *count)
{
    if (i == NO_INDEX)
        return;
    if (*count == 0)
        *first = i;
    assert_true(i >= *first);
    *count = i - *first + 1 > *count ? i - *first + 1 : *count;
}

/* Makes a mesh of the triangles of an object, as a reader would. */
static inline void instanced_mesh(struct scene *s, uint32_t object)
{
    struct scene_mesh mesh = {.tri_count = 0};
    struct error err;

    for (uint32_t i = 0; i < s->tri_count; i++) {
        if (s->tri_objects[i] != object)
            continue;
        instanced_widen(i, &mesh.first_tri, &mesh.tri_count);
        for (int k = 0; k < 3; k++) {
            instanced_widen(s->tris[i].v[k], &mesh.first_position,
                            &mesh.position_count);
            instanced_widen(s->tris[i].vn[k], &mesh.first_normal,
                            &mesh.normal_count);
        }
    }
    assert_true(scene_begin_mesh(s, &err));
    scene_end_mesh(s);
    s->instances.meshes[s->instances.mesh_count - 1] = mesh;
}

/* Parses materials and faces, and makes the meshes. */
static inline void instanced_parse(struct scene *s, const char *materials,
                                   const char *faces)
{
    struct warnings report = {0};
    struct error err;

    check_or_say(mtl_add_default(s, &err) &&
                     mtl_parse(s, materials, strlen(materials), "test.mtl",
                               &report, &err) &&
                     obj_parse(s, faces, strlen(faces), "test.obj", &report,
                               &err),
                 err.text);
    warnings_free(&report);
    for (uint32_t i = 0; i < s->object_count; i++)
        if (strncmp(s->object_names[i], "mesh", 4) == 0)
            instanced_mesh(s, i);
}

static inline void instanced_place(struct scene *s, uint32_t mesh,
                                   const struct affine *matrix)
{
    struct error err;

    assert_true(scene_add_instance(s, mesh, matrix, 0, &err));
}

/* Returns a random matrix: a rotation or any other, which may mirror, of about
 * this size, and a translation of up to 1 on each axis. */
static inline struct affine random_affine(uint64_t *seed, double size,
                                          bool is_rotation)
{
    struct affine a;
    double axis[3], next[3];

    for (int i = 0; i < 12; i++)
        a.m[i / 4][i % 4] =
            (2 * check_random(seed) - 1) * (i % 4 == 3 ? 1 : size);
    if (!is_rotation)
        return a;
    for (int k = 0; k < 3; k++) {
        axis[k] = a.m[0][k];
        next[k] = a.m[1][k];
    }
    vec3d_normalize(axis);
    vec3d_cross(axis, next, a.m[1]);
    vec3d_normalize(a.m[1]);
    vec3d_cross(axis, a.m[1], a.m[2]);
    a.m[1][3] = 2 * check_random(seed) - 1;
    a.m[2][3] = 2 * check_random(seed) - 1;
    for (int k = 0; k < 3; k++) {
        a.m[0][k] = axis[k] * size;
        a.m[1][k] *= size;
        a.m[2][k] *= size;
    }
    return a;
}

#endif
