// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/instances.h"
#include "kernels/instance.h"

/* Fewest triangles that are worth the start of threads, about 0.1 ms. */
#define POOL_TRIS_MIN 50000

/* Triangles and vertices that a thread takes at once. */
#define BLOCK_TRIS     16384u
#define BLOCK_VERTICES 16384u

/* Returns true if the triangle has an area, computed in double. */
static bool has_area(const double a[3], const double b[3], const double c[3])
{
    double most = 0;
    double scale = 1;
    double e[3], f[3];
    int exponent;

    for (int k = 0; k < 3; k++) {
        most = fabs(a[k]) > most ? fabs(a[k]) : most;
        most = fabs(b[k]) > most ? fabs(b[k]) : most;
        most = fabs(c[k]) > most ? fabs(c[k]) : most;
    }
    /* Scaling by a power of two is exact, and keeps the products finite. */
    if (!(most > 1e-50 && most < 1e50)) {
        frexp(most, &exponent);
        scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    }
    for (int k = 0; k < 3; k++) {
        e[k] = b[k] * scale - a[k] * scale;
        f[k] = c[k] * scale - a[k] * scale;
    }
    return e[1] * f[2] != e[2] * f[1] || e[2] * f[0] != e[0] * f[2] ||
           e[0] * f[1] != e[1] * f[0];
}

struct pool *scene_pool(const struct scene *scene, uint32_t tri_count)
{
    struct error ignored;

    return scene->thread_count > 1 && tri_count >= POOL_TRIS_MIN
               ? pool_create(scene->thread_count, &ignored)
               : NULL;
}

static bool is_finite(const double p[3])
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

static bool file_tri_is_usable(const struct scene *scene, struct tri *t)
{
    const double *p[3];

    for (int k = 0; k < 3; k++) {
        p[k] = scene->file_positions + 3 * (size_t)t->v[k];
        if (!is_finite(p[k]))
            return false;
    }
    return has_area(p[0], p[1], p[2]);
}

static bool is_before(struct vec3 a, struct vec3 b)
{
    if (a.x != b.x)
        return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

/* Rotates a triangle to begin with the corner that is first by coordinates.
 * Copies of a face then have the same distance from a ray, whatever their first
 * corner and winding, and the first in the file is the hit. */
static void turn_tri(const struct scene *scene, struct tri *t)
{
    const struct tri old = *t;
    uint32_t first = 0;

    for (uint32_t k = 1; k < 3; k++)
        if (is_before(scene->positions[old.v[k]],
                      scene->positions[old.v[first]]))
            first = k;
    for (uint32_t k = 0; first > 0 && k < 3; k++) {
        t->v[k] = old.v[(first + k) % 3];
        t->vn[k] = old.vn[(first + k) % 3];
        t->vt[k] = old.vt[(first + k) % 3];
    }
}

/* Turns the triangle and sets its geometric normal. Returns false if the
 * normalised triangle has no area or no unit normal. */
static bool tri_gets_normal(const struct scene *scene, struct tri *t)
{
    const struct vec3 *v[3];
    double p[3][3];

    turn_tri(scene, t);
    for (int k = 0; k < 3; k++) {
        v[k] = &scene->positions[t->v[k]];
        p[k][0] = (double)v[k]->x;
        p[k][1] = (double)v[k]->y;
        p[k][2] = (double)v[k]->z;
    }
    return has_area(p[0], p[1], p[2]) &&
           triangle_normal(*v[0], *v[1], *v[2], &t->ng);
}

/* Test of all triangles. */
struct tri_test {
    struct scene *scene;
    bool (*is_usable)(const struct scene *, struct tri *);
    bool *results; /* of triangles */
};

static void test_block(void *context, uint32_t block, int worker)
{
    const struct tri_test *t = context;
    uint32_t count = t->scene->tri_count;
    uint32_t begin = block * BLOCK_TRIS;

    (void)worker;
    for (uint32_t i = begin; i < count && i < begin + BLOCK_TRIS; i++)
        t->results[i] = t->is_usable(t->scene, &t->scene->tris[i]);
}

static void keep_tris(struct scene *scene, const bool *is_usable,
                      struct warnings *report)
{
    uint32_t kept = 0;

    for (uint32_t i = 0; i < scene->tri_count; i++) {
        if (!is_usable[i]) {
            warnings_add(report, "triangles without area",
                         "%s: found a triangle without area in face %" PRIu32
                         " of the file: triangle dropped",
                         scene->path, scene->tri_faces[i] + 1);
            continue;
        }
        if (kept < i) {
            scene->tris[kept] = scene->tris[i];
            scene->tri_faces[kept] = scene->tri_faces[i];
            scene->tri_objects[kept] = scene->tri_objects[i];
        }
        kept++;
    }
    scene->dropped_count += scene->tri_count - kept;
    scene->tri_count = kept;
}

/* Takes triangles that are dropped out of the ranges of meshes, which are
 * behind all others. */
static void shrink_meshes(struct scene *scene, const bool *is_usable)
{
    uint32_t kept = 0, i = 0;

    for (uint32_t m = 0; m < scene->instances.mesh_count; m++) {
        struct scene_mesh *mesh = &scene->instances.meshes[m];
        uint32_t last = mesh->first_tri + mesh->tri_count;

        for (; i < mesh->first_tri; i++)
            kept += is_usable[i] ? 1 : 0;
        mesh->first_tri = kept;
        for (; i < last; i++)
            kept += is_usable[i] ? 1 : 0;
        mesh->tri_count = kept - mesh->first_tri;
    }
}

static bool drop_tris(struct scene *scene, struct pool *pool,
                      struct warnings *report,
                      bool (*is_usable)(const struct scene *, struct tri *),
                      struct error *err)
{
    struct tri_test test = {scene, is_usable,
                            alloc_array(scene->tri_count, sizeof(bool))};

    if (test.results == NULL)
        return fail(err, "%s: out of memory for %" PRIu32 " triangles",
                    scene->path, scene->tri_count);
    pool_each(pool, scene->tri_count / BLOCK_TRIS + 1, test_block, &test);
    shrink_meshes(scene, test.results);
    keep_tris(scene, test.results, report);
    free(test.results);
    return true;
}

/* Returns the number of triangles outside of meshes. */
static uint32_t plain_count(const struct scene *scene)
{
    return scene->instances.mesh_count > 0
               ? scene->instances.meshes[0].first_tri
               : scene->tri_count;
}

struct bounds {
    double lo[3], hi[3];
};

/* Bounds of some triangles, in blocks. */
struct bounds_job {
    const struct scene *scene;
    uint32_t first, count;
    struct bounds *blocks;
};

static void join_point(struct bounds *b, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        b->lo[k] = p[k] < b->lo[k] ? p[k] : b->lo[k];
        b->hi[k] = p[k] > b->hi[k] ? p[k] : b->hi[k];
    }
}

static void bound_block(void *context, uint32_t block, int worker)
{
    const struct bounds_job *j = context;
    const struct tri *tris = j->scene->tris + j->first;
    uint32_t begin = block * BLOCK_TRIS;
    struct bounds b = {{INFINITY, INFINITY, INFINITY},
                       {-INFINITY, -INFINITY, -INFINITY}};

    (void)worker;
    for (uint32_t i = begin; i < j->count && i < begin + BLOCK_TRIS; i++)
        for (int c = 0; c < 3; c++)
            join_point(&b, j->scene->file_positions + 3 * (size_t)tris[i].v[c]);
    j->blocks[block] = b;
}

/* Computes the bounds of the vertices that triangles use: 0 without any. */
static bool tri_bounds(const struct scene *scene, uint32_t first,
                       uint32_t count, struct pool *pool, double lo[3],
                       double hi[3])
{
    uint32_t block_count = count / BLOCK_TRIS + (count % BLOCK_TRIS > 0);
    struct bounds_job job = {scene, first, count,
                             alloc_array(block_count, sizeof *job.blocks)};
    struct bounds all = {{0}, {0}};

    if (job.blocks == NULL)
        return false;
    pool_each(pool, block_count, bound_block, &job);
    if (count > 0)
        all = job.blocks[0];
    for (uint32_t i = 1; i < block_count; i++) {
        join_point(&all, job.blocks[i].lo);
        join_point(&all, job.blocks[i].hi);
    }
    memcpy(lo, all.lo, sizeof all.lo);
    memcpy(hi, all.hi, sizeof all.hi);
    free(job.blocks);
    return true;
}

/* Computes the centre, and the scale that brings the largest extent into [1,
 * 2). Halves are subtracted because full extents may overflow. */
static void find_scale(const double lo[3], const double hi[3], double center[3],
                       double *scale)
{
    double most = 0;
    int exponent;

    for (int k = 0; k < 3; k++) {
        center[k] = lo[k] / 2 + hi[k] / 2;
        most = fmax(most, hi[k] / 2 - lo[k] / 2);
    }
    *scale = 1;
    if (most > 0) {
        frexp(most, &exponent);
        *scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    }
}

static bool find_bounds(struct scene *scene, struct pool *pool,
                        struct error *err)
{
    uint32_t plain = plain_count(scene);
    bool ok =
        scene->smokes.count > 0 ||
        tri_bounds(scene, 0, plain, pool, scene->bounds_lo, scene->bounds_hi);

    for (uint32_t i = 0; ok && i < scene->instances.mesh_count; i++) {
        struct scene_mesh *m = &scene->instances.meshes[i];

        ok = tri_bounds(scene, m->first_tri, m->tri_count, pool, m->lo, m->hi);
        find_scale(m->lo, m->hi, m->center, &m->scale);
    }
    if (!ok)
        return fail(err, "%s: out of memory for its bounds", scene->path);
    instances_join_bounds(scene, plain > 0);
    find_scale(scene->bounds_lo, scene->bounds_hi, scene->center,
               &scene->scale);
    return true;
}

/* Vertices that no triangle uses may be anywhere. */
static float normalized(double x, double center, double scale)
{
    float y = (float)((x - center) * scale);

    return isfinite(y) ? y : 0;
}

/* Vertices from one index on that have the same centre and scale. */
struct vertex_range {
    struct scene *scene;
    uint32_t first, count;
    const double *center;
    double scale;
};

static void normalize_block(void *context, uint32_t block, int worker)
{
    const struct vertex_range *r = context;
    uint32_t begin = block * BLOCK_VERTICES;

    (void)worker;
    for (uint32_t k = begin; k < r->count && k < begin + BLOCK_VERTICES; k++) {
        size_t i = (size_t)r->first + k;
        const double *p = r->scene->file_positions + 3 * i;

        r->scene->positions[i] = (struct vec3){
            normalized(p[0], r->center[0], r->scale),
            normalized(p[1], r->center[1], r->scale),
            normalized(p[2], r->center[2], r->scale),
        };
    }
}

static void normalize_range(struct vertex_range r, struct pool *pool)
{
    pool_each(pool, r.count / BLOCK_VERTICES + 1, normalize_block, &r);
}

static bool fill_positions(struct scene *scene, struct pool *pool,
                           struct error *err)
{
    free(scene->positions);
    scene->positions =
        alloc_array(scene->position_count, sizeof *scene->positions);
    if (scene->positions == NULL)
        return fail(err, "%s: out of memory for %" PRIu32 " vertices",
                    scene->path, scene->position_count);
    normalize_range((struct vertex_range){scene, 0, scene->position_count,
                                          scene->center, scene->scale},
                    pool);
    for (uint32_t i = 0; i < scene->instances.mesh_count; i++) {
        const struct scene_mesh *m = &scene->instances.meshes[i];

        normalize_range((struct vertex_range){scene, m->first_position,
                                              m->position_count, m->center,
                                              m->scale},
                        pool);
    }
    free(scene->file_positions);
    scene->file_positions = NULL;
    return true;
}

uint32_t scene_find_object(const struct scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (strcmp(scene->object_names[i], name) == 0)
            return i;
    return NO_INDEX;
}

uint32_t scene_tri_total(const struct scene *s)
{
    const struct instance *last = s->placed + s->placed_count - 1;

    return s->placed_count > 0 ? last->first_tri + last->tri_count
                               : s->tri_count;
}

struct world scene_shape(const struct scene *s)
{
    return (struct world){.positions = s->positions,
                          .tris = s->tris,
                          .instances = s->placed,
                          .settings.tri_count = s->tri_count,
                          .settings.instance_count = s->placed_count};
}

uint32_t scene_tri_object(const struct scene *s, uint32_t tri)
{
    struct world w = scene_shape(s);
    uint32_t instance = instance_of(&w, tri);

    return instance == NO_INDEX ? s->tri_objects[tri]
                                : s->placed_objects[instance];
}

bool scene_next_run(const struct scene *s, uint32_t object, struct tri_run *run)
{
    struct world w = scene_shape(s);
    uint32_t plain = plain_tri_count(&w), i = run->first + run->count;
    bool any = object == NO_INDEX;

    while (i < plain && !any && s->tri_objects[i] != object)
        i++;
    run->first = i;
    while (i < plain && (any || s->tri_objects[i] == object))
        i++;
    run->count = i - run->first;
    while (run->count == 0 && run->placed < s->placed_count) {
        uint32_t k = run->placed++;

        if (any || s->placed_objects[k] == object) {
            run->first = s->placed[k].first_tri;
            run->count = s->placed[k].tri_count;
        }
    }
    return run->count > 0;
}

struct vec3 scene_point(const struct scene *s, const double p[3])
{
    return (struct vec3){(float)((p[0] - s->center[0]) * s->scale),
                         (float)((p[1] - s->center[1]) * s->scale),
                         (float)((p[2] - s->center[2]) * s->scale)};
}

void scene_file_point(const struct scene *s, struct vec3 p, double point[3])
{
    point[0] = (double)p.x / s->scale + s->center[0];
    point[1] = (double)p.y / s->scale + s->center[1];
    point[2] = (double)p.z / s->scale + s->center[2];
}

uint32_t scene_tri_index(const struct scene *s, uint32_t tri)
{
    struct world w = scene_shape(s);
    uint32_t instance = instance_of(&w, tri);

    return instance == NO_INDEX ? tri
                                : s->placed[instance].mesh_tri +
                                      (tri - s->placed[instance].first_tri);
}

uint64_t scene_geometry_bytes(const struct scene *s)
{
    return s->position_count * (uint64_t)sizeof *s->positions +
           s->normal_count * (uint64_t)sizeof *s->normals +
           s->uv_count * (uint64_t)sizeof *s->uvs +
           (s->uvs2 != NULL ? s->uv_count : 0) * (uint64_t)sizeof *s->uvs2 +
           s->color_count * (uint64_t)sizeof *s->colors +
           (s->alphas != NULL ? s->position_count : 0) *
               (uint64_t)sizeof *s->alphas +
           (s->tangents != NULL ? s->normal_count : 0) *
               (uint64_t)sizeof *s->tangents +
           s->tri_count * (uint64_t)(sizeof *s->tris + sizeof *s->tri_faces +
                                     sizeof *s->tri_objects);
}

static bool finish(struct scene *scene, struct pool *pool,
                   struct warnings *report, struct error *err)
{
    return drop_tris(scene, pool, report, file_tri_is_usable, err) &&
           find_bounds(scene, pool, err) && fill_positions(scene, pool, err) &&
           drop_tris(scene, pool, report, tri_gets_normal, err) &&
           instances_build(scene, report, err);
}

bool scene_finish(struct scene *scene, struct warnings *report,
                  struct error *err)
{
    struct pool *pool = scene_pool(scene, scene->tri_count);
    bool ok =
        scene_flatten(scene, pool, err) && finish(scene, pool, report, err);

    pool_destroy(pool);
    return ok;
}

static bool is_same_place(const struct scene *a, const struct scene *b)
{
    return a->scale == b->scale &&
           memcmp(a->center, b->center, sizeof a->center) == 0 &&
           a->position_count == b->position_count &&
           memcmp(a->positions, b->positions,
                  a->position_count * sizeof *a->positions) == 0;
}

bool scene_has_same_shape(const struct scene *a, const struct scene *b)
{
    if (a->tri_count != b->tri_count || !is_same_place(a, b) ||
        a->placed_count != b->placed_count)
        return false;
    for (uint32_t i = 0; i < a->placed_count; i++) {
        struct instance other = b->placed[i];

        other.material = a->placed[i].material;
        if (memcmp(&a->placed[i], &other, sizeof other) != 0)
            return false;
    }
    for (uint32_t i = 0; i < a->tri_count; i++) {
        if (memcmp(a->tris[i].v, b->tris[i].v, sizeof a->tris[i].v) != 0)
            return false;
    }
    return true;
}

static void free_strings(char **strings, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        free(strings[i]);
    free(strings);
}

void scene_free(struct scene *scene)
{
    free(scene->path);
    free(scene->file_positions);
    scene_instances_free(&scene->instances);
    free(scene->positions);
    free(scene->normals);
    free(scene->uvs);
    for (size_t i = 0; i < scene->image_count; i++) {
        free(scene->images[i].name);
        free(scene->images[i].bytes);
    }
    free(scene->images);
    free(scene->uvs2);
    free(scene->colors);
    free(scene->alphas);
    free(scene->tangents);
    free(scene->tris);
    free(scene->tri_faces);
    free(scene->tri_objects);
    lamps_free(&scene->lamps);
    smokes_free(&scene->smokes);
    free(scene->placed);
    free(scene->placed_objects);
    free_strings(scene->object_names, scene->object_count);
    for (uint32_t i = 0; i < scene->camera_count; i++)
        free(scene->cameras[i].name);
    free(scene->cameras);
    free(scene->materials);
    free(scene->material_origins);
    free_strings(scene->material_names, scene->material_count);
    free_strings(scene->mtl_paths, scene->mtl_path_count);
    free_strings(scene->data_paths, scene->data_path_count);
    free(scene->textures);
    free(scene->texture_origins);
    free_strings(scene->texture_paths, scene->texture_count);
    memset(scene, 0, sizeof *scene);
}
