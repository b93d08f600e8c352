// SPDX-License-Identifier: MIT
/*
 * mesh.h - small worlds made by tests
 *
 * Units:     normalised scene units
 * Ownership: mesh_free() frees the arrays and the tree
 * Threads:   one
 * Errors:    a test ends when memory is out
 */
#ifndef TESTS_MESH_H
#define TESTS_MESH_H

#include <stdlib.h>

#include "tests/unit/check.h"
#include "world/world.h"
#include "kernels/hit.h"

#define MESH_MATERIALS 8

struct mesh {
    struct vec3 *positions;
    struct tri *tris;
    uint32_t tri_count;
    struct material materials[MESH_MATERIALS];
    struct bvh8 tree;
    struct host_world host; /* for backends; it owns this tree */
    struct world world;
};

static inline void mesh_add(struct mesh *m, struct vec3 a, struct vec3 b,
                            struct vec3 c, uint32_t material)
{
    uint32_t n = m->tri_count++;
    struct tri t = {{3 * n, 3 * n + 1, 3 * n + 2},
                    {NO_INDEX, NO_INDEX, NO_INDEX},
                    {NO_INDEX, NO_INDEX, NO_INDEX},
                    material,
                    {0, 0, 0}};

    if ((n & (n - 1)) == 0) { /* room for twice as many */
        uint32_t room = n == 0 ? 1 : 2 * n;

        m->positions = realloc(m->positions, 3 * room * sizeof *m->positions);
        m->tris = realloc(m->tris, room * sizeof *m->tris);
        assert_non_null(m->positions);
        assert_non_null(m->tris);
    }
    m->positions[3 * n] = a;
    m->positions[3 * n + 1] = b;
    m->positions[3 * n + 2] = c;
    m->tris[n] = t;
}

static inline void mesh_add_quad(struct mesh *m, struct vec3 a, struct vec3 b,
                                 struct vec3 c, struct vec3 d,
                                 uint32_t material)
{
    mesh_add(m, a, b, c, material);
    mesh_add(m, a, c, d, material);
}

/* Adds an axis-aligned box that is wound outwards. */
static inline void mesh_add_box(struct mesh *m, struct vec3 lo, struct vec3 hi,
                                uint32_t material)
{
    struct vec3 p[8];

    for (int i = 0; i < 8; i++)
        p[i] =
            v3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    mesh_add_quad(m, p[0], p[2], p[3], p[1], material);
    mesh_add_quad(m, p[4], p[5], p[7], p[6], material);
    mesh_add_quad(m, p[0], p[1], p[5], p[4], material);
    mesh_add_quad(m, p[2], p[6], p[7], p[3], material);
    mesh_add_quad(m, p[0], p[4], p[6], p[2], material);
    mesh_add_quad(m, p[1], p[3], p[7], p[5], material);
}

/* Adds a closed sphere of latitudes and longitudes that is wound outwards. */
static inline void mesh_add_sphere(struct mesh *m, struct vec3 center,
                                   float radius, int rows, int columns,
                                   uint32_t material)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            struct vec3 p[4];

            for (int k = 0; k < 4; k++) {
                int row = i + k / 2;
                int column = (j + k % 2) % columns;
                double theta = 3.141592653589793 * row / rows;
                double phi = 6.283185307179586 * column / columns;
                /* all vertices at a pole have the same bits */
                double s = row == 0 || row == rows ? 0.0 : sin(theta);

                p[k] = v3((float)(center.x + radius * s * cos(phi)),
                          (float)(center.y + radius * cos(theta)),
                          (float)(center.z - radius * s * sin(phi)));
            }
            if (i > 0)
                mesh_add(m, p[0], p[3], p[1], material);
            if (i < rows - 1)
                mesh_add(m, p[0], p[2], p[3], material);
        }
}

static inline struct material mesh_material(uint32_t kind, float color)
{
    struct material m = material_default();

    m.color = v3(color, color, color);
    m.kind = kind;
    m.ior = 1.5f;
    return m;
}

/* Computes normals; call it after the last change of corners. */
static inline void mesh_set_normals(struct mesh *m)
{
    for (struct tri *t = m->tris; t < m->tris + m->tri_count; t++)
        triangle_normal(m->positions[t->v[0]], m->positions[t->v[1]],
                        m->positions[t->v[2]], &t->ng);
}

/* Builds the tree and the world; the camera and the sky stay the caller's. */
static inline void mesh_finish(struct mesh *m)
{
    struct error err;
    struct world *w = &m->world;

    mesh_set_normals(m);
    w->positions = m->positions;
    w->tris = m->tris;
    w->settings.tri_count = m->tri_count;
    w->settings.position_count = 3 * m->tri_count;
    w->settings.material_count = MESH_MATERIALS;
    w->materials = m->materials;
    if (w->settings.max_vertices == 0)
        w->settings.max_vertices = PATH_HARD_STOP;
    assert_true(bvh8_build(&m->tree, w, NULL, &err));
    bvh8_lend(&m->tree, w);
    m->host = (struct host_world){.tree = m->tree, .has_tree = true};
    world_renew(&m->host, WORLD_SHAPE);
}

static inline void mesh_free(struct mesh *m)
{
    bvh8_free(&m->tree);
    free(m->positions);
    free(m->tris);
}

#endif
