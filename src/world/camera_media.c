// SPDX-License-Identifier: MIT
#include "world/camera_media.h"

#include <stdlib.h>

#include "kernels/medium.h"
#include "kernels/hit.h"
#include "kernels/instance.h"

/* Faces on the way that are remembered, the nearest ones. */
#define FACES_MAX 256

struct face {
    double t;
    uint32_t tri, material;
    bool is_exit;
};

struct faces {
    struct face at[FACES_MAX];
    int count;
};

/* A direction along which hardly any mesh has edges. */
static const double direction[3] = {0.3574067443365932, 0.8628562094610168,
                                    0.3574067443365933};

static bool is_solid(const struct material *m)
{
    struct bsdf b = {.kind = m->kind,
                     .transmission = m->transmission,
                     .is_thin = m->is_thin};

    return bsdf_is_solid(&b);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void between(struct vec3 a, struct vec3 b, double out[3])
{
    out[0] = (double)b.x - (double)a.x;
    out[1] = (double)b.y - (double)a.y;
    out[2] = (double)b.z - (double)a.z;
}

/* Intersects the ray from the eye with a triangle (Möller and Trumbore 1997,
 * "Fast, minimum storage ray/triangle intersection"). */
static bool meets(const struct vec3 p[3], struct vec3 eye, struct face *f)
{
    double a[3], b[3], to[3], h[3], q[3];
    double determinant, u, v;

    between(p[0], p[1], a);
    between(p[0], p[2], b);
    between(p[0], eye, to);
    cross(direction, b, h);
    determinant = dot(a, h);
    if (!(determinant < 0 || determinant > 0))
        return false;
    u = dot(to, h) / determinant;
    cross(to, a, q);
    v = dot(direction, q) / determinant;
    f->t = dot(b, q) / determinant;
    f->is_exit = determinant < 0;
    return u >= 0 && v >= 0 && u + v <= 1 && f->t > 0;
}

static bool is_nearer(const struct face *a, const struct face *b)
{
    return a->t < b->t || (!(b->t < a->t) && a->tri < b->tri);
}

/* Inserts a face by its distance. */
static void insert(struct faces *f, struct face new)
{
    int i = f->count;

    if (i == FACES_MAX && !is_nearer(&new, &f->at[--i]))
        return;
    if (f->count < FACES_MAX)
        f->count++;
    for (; i > 0 && is_nearer(&new, &f->at[i - 1]); i--)
        f->at[i] = f->at[i - 1];
    f->at[i] = new;
}

/* Tests the triangles of a mesh in a place, or with NO_INDEX those outside of
 * meshes. */
static void find_faces(const struct world *w, const bool *solid,
                       struct vec3 eye, uint32_t instance, uint32_t first,
                       uint32_t count, struct faces *f)
{
    for (uint32_t i = first; i < first + count; i++) {
        struct face face = {.tri = i, .material = tri_material(w, i, instance)};
        struct vec3 p[3];
        struct tri t;

        if (!solid[face.material])
            continue;
        t = tri_at(w, i, instance);
        for (int k = 0; k < 3; k++)
            p[k] = position_at(w, t.v[k], instance);
        if (meets(p, eye, &face)) {
            if (instance != NO_INDEX && w->instances[instance].is_mirror != 0)
                face.is_exit = !face.is_exit;
            insert(f, face);
        }
    }
}

/* Tests all triangles of solids. Few of many instances are solids. */
static void find_all_faces(const struct world *w, const bool *solid,
                           struct vec3 eye, struct faces *f)
{
    find_faces(w, solid, eye, NO_INDEX, 0, plain_tri_count(w), f);
    for (uint32_t i = 0; i < w->settings.instance_count; i++)
        if (solid[w->instances[i].material])
            find_faces(w, solid, eye, i, w->instances[i].first_tri,
                       w->instances[i].tri_count, f);
}

/* A body that the ray leaves without having entered it is around the eye, the
 * innermost first. */
static struct media bodies_of(const struct faces *f)
{
    struct media entered = {0}, around = {0}, all = {0};

    for (int i = 0; i < f->count; i++) {
        const struct face *face = &f->at[i];
        uint32_t before = entered.count;

        if (!face->is_exit) {
            media_enter(&entered, face->material);
            continue;
        }
        media_leave(&entered, face->material);
        if (entered.count == before)
            media_enter(&around, face->material);
    }
    for (uint32_t i = around.count; i > 0; i--)
        media_enter(&all, around.at[i - 1]);
    return all;
}

struct media camera_media(const struct world *w, struct vec3 eye)
{
    struct media none = {0};
    struct faces *faces = calloc(1, sizeof *faces);
    bool *solid = calloc(w->settings.material_count + 1, sizeof *solid);
    bool has_solids = false;

    for (uint32_t i = 0; solid != NULL && i < w->settings.material_count; i++) {
        solid[i] = is_solid(&w->materials[i]);
        has_solids = has_solids || solid[i];
    }
    if (faces != NULL && has_solids) {
        find_all_faces(w, solid, eye, faces);
        none = bodies_of(faces);
    }
    free(faces);
    free(solid);
    return none;
}
