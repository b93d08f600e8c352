// SPDX-License-Identifier: MIT
#include "scene/instances.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "scene/scene.h"
#include "kernels/instance.h"
#include "kernels/traverse_leaf.h"

/* ---- meshes and instances ---- */

/* Triangles of copies up to which meshes are copied. Time of a sample with
 * instances over that with copies, bytes of copies and their part of the tree,
 * and seconds to start (spheres of 960 triangles on a floor under a white sky,
 * one thread of a busy machine):
 *
 *     triangles  samples   copies   start with copies, with instances
 *        1e4      1.38       1 MB    .06  .08
 *        1e5      1.25      11 MB    .14  .11
 *      2.4e5      1.15      29 MB    .19  .12
 *        1e6      1.09     114 MB    .52  .17
 *        1e7       .72    1144 MB   4.0   .39
 *
 * With 10 and 100 times as many triangles in a mesh, 1.06 for 1e6 and .84 for
 * 1e7. */
#define COPIED_TRIS 250000

/* Condition number up to which a matrix has an inverse that is good enough for
 * boxes in floats: with it a box grows by 2^-8 of the mesh at most. */
#define CONDITION_MAX 65536

/* ---- transformed meshes ---- */

/* Vertices that a thread takes at once. */
#define BLOCK_VERTICES 16384u

struct job {
    const struct affine *matrix;
    double rows[3][3]; /* of the matrix for normals */
    double *positions;
    struct vec3 *normals;
    struct tangent *tangents; /* NULL: none */
    bool is_mirror;
    uint32_t position_count, normal_count;
};

static struct vec3 moved_normal(const double rows[3][3], struct vec3 n)
{
    const double from[3] = {(double)n.x, (double)n.y, (double)n.z};
    double to[3];

    for (int i = 0; i < 3; i++)
        to[i] = vec3d_dot(rows[i], from);
    if (!vec3d_normalize(to))
        return (struct vec3){0, 0, 0};
    return (struct vec3){(float)to[0], (float)to[1], (float)to[2]};
}

/* Vectors along a surface move with it. */
static void move_tangent(const struct job *j, struct tangent *t)
{
    const double from[3] = {(double)t->d.x, (double)t->d.y, (double)t->d.z};
    double to[3];

    for (int i = 0; i < 3; i++)
        to[i] = vec3d_dot(j->matrix->m[i], from);
    t->d = vec3d_normalize(to)
               ? (struct vec3){(float)to[0], (float)to[1], (float)to[2]}
               : (struct vec3){0, 0, 0};
    t->sign = j->is_mirror ? -t->sign : t->sign;
}

static void move_block(void *context, uint32_t block, int worker)
{
    const struct job *j = context;
    uint32_t begin = block * BLOCK_VERTICES;

    (void)worker;
    for (size_t i = begin;
         i < u32_min(begin + BLOCK_VERTICES, j->position_count); i++) {
        double *p = j->positions + 3 * i;
        const double from[3] = {p[0], p[1], p[2]};

        affine_point(j->matrix, from, p);
    }
    for (size_t i = begin; i < u32_min(begin + BLOCK_VERTICES, j->normal_count);
         i++)
        j->normals[i] = moved_normal(j->rows, j->normals[i]);
    for (size_t i = begin; j->tangents != NULL &&
                           i < u32_min(begin + BLOCK_VERTICES, j->normal_count);
         i++)
        move_tangent(j, &j->tangents[i]);
}

/* Moves as many vertices and normals as the mesh has, from these indices on.
 * Returns true if the matrix mirrors. */
static bool mesh_transform(struct scene *scene, const struct affine *matrix,
                           const struct scene_mesh *mesh,
                           uint32_t first_position, uint32_t first_normal,
                           struct pool *pool)
{
    struct job job = {.matrix = matrix,
                      .position_count = mesh->position_count,
                      .normal_count = mesh->normal_count};
    uint32_t most = mesh->position_count > mesh->normal_count
                        ? mesh->position_count
                        : mesh->normal_count;

    job.is_mirror = affine_normals(matrix, job.rows);
    if (mesh->position_count > 0)
        job.positions = scene->file_positions + 3 * (size_t)first_position;
    if (mesh->normal_count > 0)
        job.normals = scene->normals + first_normal;
    if (mesh->normal_count > 0 && scene->tangents != NULL)
        job.tangents = scene->tangents + first_normal;
    pool_each(pool, most / BLOCK_VERTICES + (most % BLOCK_VERTICES > 0),
              move_block, &job);
    return job.is_mirror;
}

/* Exchanges two corners, and so the sides of the face. */
static void tri_turn_over(struct tri *t)
{
    uint32_t *corners[] = {t->v, t->vn, t->vt};

    for (int i = 0; i < 3; i++) {
        uint32_t second = corners[i][1];

        corners[i][1] = corners[i][2];
        corners[i][2] = second;
    }
}

/* ---- lists ---- */

static bool out_of_memory(const struct scene *scene, struct error *err)
{
    return fail(err, "%s: out of memory for its instances", scene->path);
}

bool scene_begin_mesh(struct scene *scene, struct error *err)
{
    struct scene_instances *s = &scene->instances;
    void *meshes = s->meshes;

    if (s->mesh_count == 0)
        s->copied_tris = COPIED_TRIS;
    if (!grow_array(&meshes, &s->mesh_capacity, (size_t)s->mesh_count + 1,
                    sizeof *s->meshes))
        return out_of_memory(scene, err);
    s->meshes = meshes;
    s->meshes[s->mesh_count] = (struct scene_mesh){
        .first_tri = scene->tri_count,
        .first_position = scene->position_count,
        .first_normal = scene->normal_count,
    };
    return true;
}

uint32_t scene_end_mesh(struct scene *scene)
{
    struct scene_instances *s = &scene->instances;
    struct scene_mesh *mesh = &s->meshes[s->mesh_count];

    mesh->tri_count = scene->tri_count - mesh->first_tri;
    mesh->position_count = scene->position_count - mesh->first_position;
    mesh->normal_count = scene->normal_count - mesh->first_normal;
    return s->mesh_count++;
}

bool scene_add_instance(struct scene *scene, uint32_t mesh,
                        const struct affine *matrix, uint32_t object,
                        struct error *err)
{
    struct scene_instances *s = &scene->instances;
    void *items = s->items;

    if (s->count == NO_INDEX - 1 ||
        !grow_array(&items, &s->capacity, (size_t)s->count + 1,
                    sizeof *s->items))
        return out_of_memory(scene, err);
    s->items = items;
    s->items[s->count++] = (struct scene_instance){*matrix, mesh, object};
    return true;
}

void scene_instances_free(struct scene_instances *s)
{
    free(s->meshes);
    free(s->items);
    *s = (struct scene_instances){.meshes = NULL};
}

/* ---- copies of meshes ---- */

/* Counts of what a scene has with all copies. */
struct totals {
    uint64_t tris, positions, normals;
};

/* What becomes of a mesh. */
struct plan {
    uint64_t use_count;
    bool is_kept;       /* some instances stay, and use the mesh itself */
    uint32_t copy_left; /* copies that are not made yet */
    uint32_t index;     /* of the mesh among those that are kept */
};

/* A scene's arrays while they are made anew, and how much of them is used. */
struct flattening {
    struct scene *scene;
    struct pool *pool;
    struct tri *tris;
    uint32_t *faces, *objects;
    uint32_t tri_count;
    uint32_t position_count, normal_count;
};

/* Copies the vertices and normals of a mesh to the end of the scene's. */
static void copy_vertices(struct flattening *f, const struct scene_mesh *mesh)
{
    struct scene *s = f->scene;

    memcpy(s->file_positions + 3 * (size_t)f->position_count,
           s->file_positions + 3 * (size_t)mesh->first_position,
           mesh->position_count * 3 * sizeof *s->file_positions);
    if (s->color_count > 0)
        memcpy(s->colors + f->position_count, s->colors + mesh->first_position,
               mesh->position_count * sizeof *s->colors);
    if (s->alphas != NULL)
        memcpy(s->alphas + f->position_count, s->alphas + mesh->first_position,
               mesh->position_count * sizeof *s->alphas);
    if (s->tangents != NULL)
        memcpy(s->tangents + f->normal_count, s->tangents + mesh->first_normal,
               mesh->normal_count * sizeof *s->tangents);
    if (mesh->normal_count > 0)
        memcpy(s->normals + f->normal_count, s->normals + mesh->first_normal,
               mesh->normal_count * sizeof *s->normals);
}

/* Appends the triangles of a mesh as those of an object, with vertices and
 * normals from these indices on. */
static void append_tris(struct flattening *f, const struct scene_mesh *mesh,
                        uint32_t object, uint32_t first_position,
                        uint32_t first_normal, bool is_mirror)
{
    for (uint32_t i = 0; i < mesh->tri_count; i++) {
        struct tri t = f->scene->tris[mesh->first_tri + i];

        for (int k = 0; k < 3; k++) {
            t.v[k] += first_position - mesh->first_position;
            if (t.vn[k] != NO_INDEX)
                t.vn[k] += first_normal - mesh->first_normal;
        }
        if (is_mirror)
            tri_turn_over(&t);
        f->faces[f->tri_count] = f->scene->tri_faces[mesh->first_tri + i];
        f->objects[f->tri_count] = object;
        f->tris[f->tri_count++] = t;
    }
}

/* Adds the triangles of an instance. The last copy of a mesh that is not kept
 * takes the mesh's own vertices. */
static void flatten_instance(struct flattening *f,
                             const struct scene_instance *instance,
                             struct plan *plan)
{
    const struct scene_mesh *mesh = &f->scene->instances.meshes[instance->mesh];
    uint32_t first_position = mesh->first_position;
    uint32_t first_normal = mesh->first_normal;
    bool is_mirror;

    if (--plan->copy_left > 0 || plan->is_kept) {
        first_position = f->position_count;
        first_normal = f->normal_count;
        copy_vertices(f, mesh);
        f->position_count += mesh->position_count;
        f->normal_count += mesh->normal_count;
    }
    is_mirror = mesh_transform(f->scene, &instance->matrix, mesh,
                               first_position, first_normal, f->pool);
    append_tris(f, mesh, instance->object, first_position, first_normal,
                is_mirror);
}

/* Appends the triangles outside of meshes. */
static void append_others(struct flattening *f)
{
    const struct scene *s = f->scene;
    const struct scene_mesh *mesh = s->instances.meshes;
    const struct scene_mesh *end = mesh + s->instances.mesh_count;

    for (uint32_t i = 0; i < s->tri_count; i++) {
        while (mesh < end && i >= mesh->first_tri + mesh->tri_count)
            mesh++;
        if (mesh < end && i >= mesh->first_tri)
            continue;
        f->tris[f->tri_count] = s->tris[i];
        f->faces[f->tri_count] = s->tri_faces[i];
        f->objects[f->tri_count++] = s->tri_objects[i];
    }
}

/* Appends the triangles of the meshes that are kept, and renumbers these. */
static void append_kept(struct flattening *f, struct plan *plans)
{
    struct scene_instances *s = &f->scene->instances;
    uint32_t kept = 0;

    for (uint32_t i = 0; i < s->mesh_count; i++) {
        struct scene_mesh mesh = s->meshes[i];

        if (!plans[i].is_kept)
            continue;
        append_tris(f, &mesh, 0, mesh.first_position, mesh.first_normal, false);
        mesh.first_tri = f->tri_count - mesh.tri_count;
        plans[i].index = kept;
        s->meshes[kept++] = mesh;
    }
    s->mesh_count = kept;
    for (uint32_t i = 0; i < s->count; i++)
        s->items[i].mesh = plans[s->items[i].mesh].index;
}

/* ---- plans ---- */

/* Returns the largest sum of magnitudes in a row. */
static double row_norm(double m[3][3])
{
    double most = 0;

    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(m[i][0]) + fabs(m[i][1]) + fabs(m[i][2]));
    return most;
}

/* Returns true if the matrix has an inverse that rays can use. */
static bool is_regular(const struct affine *a)
{
    double rows[3][3], linear[3][3];
    double most = 0, determinant;

    for (int i = 0; i < 9; i++)
        most = fmax(most, fabs(a->m[i / 3][i % 3]));
    if (!(most > 1e-100 && most < 1e100))
        return false;
    affine_normals(a, rows);
    for (int i = 0; i < 3; i++)
        memcpy(linear[i], a->m[i], sizeof linear[i]);
    determinant = fabs(vec3d_dot(linear[0], rows[0]));
    /* the transposed inverse is rows / determinant; a factor of 3 bounds the
     * difference between its norm and that of the inverse */
    return 3 * row_norm(linear) * row_norm(rows) <= CONDITION_MAX * determinant;
}

/* Returns true if the triangles of a mesh share a material. */
static bool may_be_kept(const struct scene *scene,
                        const struct scene_mesh *mesh)
{
    const struct tri *tris = scene->tris + mesh->first_tri;

    for (uint32_t i = 1; i < mesh->tri_count; i++)
        if (tris[i].material != tris[0].material)
            return false;
    return mesh->tri_count > 0;
}

/* Triangles of the copies that a mesh saves, and its index. */
struct saving {
    uint64_t tris;
    uint32_t mesh;
};

static int compare_savings(const void *a, const void *b)
{
    const struct saving *x = a, *y = b;

    if (x->tris != y->tris)
        return x->tris < y->tris ? -1 : 1;
    return x->mesh < y->mesh ? -1 : 1;
}

/* Keeps the meshes that save most. */
static void choose_kept(const struct scene *scene, struct plan *plans,
                        struct saving *savings)
{
    const struct scene_instances *s = &scene->instances;
    uint64_t copied = 0;
    uint32_t count = 0;

    for (uint32_t i = 0; i < s->mesh_count; i++)
        if (plans[i].use_count > 1 && may_be_kept(scene, &s->meshes[i]))
            savings[count++] = (struct saving){(plans[i].use_count - 1) *
                                                   s->meshes[i].tri_count,
                                               i};
    qsort(savings, count, sizeof *savings, compare_savings);
    for (uint32_t i = 0; i < count; i++) {
        copied += savings[i].tris;
        plans[savings[i].mesh].is_kept = copied > s->copied_tris;
    }
}

static bool is_copied(const struct plan *plans,
                      const struct scene_instance *instance)
{
    return !plans[instance->mesh].is_kept || !is_regular(&instance->matrix);
}

/* Counts what the scene has with all copies. */
static struct totals count_all(const struct scene *scene, struct plan *plans)
{
    const struct scene_instances *s = &scene->instances;
    struct totals all = {scene->tri_count, scene->position_count,
                         scene->normal_count};

    for (uint32_t i = 0; i < s->mesh_count; i++)
        if (!plans[i].is_kept)
            all.tris -= s->meshes[i].tri_count;
    for (uint32_t i = 0; i < s->count; i++) {
        const struct scene_mesh *mesh = &s->meshes[s->items[i].mesh];
        struct plan *plan = &plans[s->items[i].mesh];

        if (!is_copied(plans, &s->items[i]))
            continue;
        all.tris += mesh->tri_count;
        if (plan->copy_left++ == 0 && !plan->is_kept)
            continue;
        all.positions += mesh->position_count;
        all.normals += mesh->normal_count;
    }
    return all;
}

/* ---- flattening ---- */

static bool grow_to(void **array, uint64_t count, size_t size_bytes)
{
    void *p = count < NO_INDEX
                  ? realloc(*array, (size_t)(count + 1) * size_bytes)
                  : NULL;

    if (p != NULL)
        *array = p;
    return p != NULL;
}

/* Takes the memory of the copies, also that of finishing them and of their
 * tree. */
static bool take_copies(struct scene *s, const struct totals *all)
{
    uint64_t vertex_bytes =
        3 * sizeof *s->file_positions + sizeof *s->colors + sizeof *s->alphas;
    uint64_t normal_bytes = sizeof *s->normals + sizeof *s->tangents;
    uint64_t tri_bytes =
        sizeof *s->tris + sizeof *s->tri_faces + sizeof *s->tri_objects;
    uint64_t tris = all->tris > s->tri_count ? all->tris - s->tri_count : 0;

    return memory_budget_take(&s->memory, all->positions - s->position_count,
                              SCENE_FINISH * vertex_bytes) &&
           memory_budget_take(&s->memory, all->normals - s->normal_count,
                              SCENE_FINISH * normal_bytes) &&
           memory_budget_take(&s->memory, tris, SCENE_FINISH * tri_bytes);
}

/* Makes room for all copies. */
static bool grow_all(struct flattening *f, const struct totals *all)
{
    struct scene *s = f->scene;
    void *positions = s->file_positions, *normals = s->normals;
    void *colors = s->colors, *alphas = s->alphas, *tangents = s->tangents;
    bool ok =
        grow_to(&positions, all->positions, 3 * sizeof *s->file_positions) &&
        (s->color_count == 0 ||
         grow_to(&colors, all->positions, sizeof *s->colors)) &&
        (s->alphas == NULL ||
         grow_to(&alphas, all->positions, sizeof *s->alphas)) &&
        (s->tangents == NULL ||
         grow_to(&tangents, all->normals, sizeof *s->tangents)) &&
        grow_to(&normals, all->normals, sizeof *s->normals);

    s->file_positions = positions;
    s->normals = normals;
    s->colors = colors;
    s->alphas = alphas;
    s->tangents = tangents;
    if (!ok || all->tris >= NO_INDEX)
        return false;
    f->tris = alloc_array((size_t)all->tris, sizeof *f->tris);
    f->faces = alloc_array((size_t)all->tris, sizeof *f->faces);
    f->objects = alloc_array((size_t)all->tris, sizeof *f->objects);
    return f->tris != NULL && f->faces != NULL && f->objects != NULL;
}

static void give_arrays(struct flattening *f)
{
    struct scene *s = f->scene;

    free(s->tris);
    free(s->tri_faces);
    free(s->tri_objects);
    s->tris = f->tris;
    s->tri_faces = f->faces;
    s->tri_objects = f->objects;
    s->tri_count = f->tri_count;
    s->position_count = f->position_count;
    s->normal_count = f->normal_count;
    if (s->color_count > 0)
        s->color_count = f->position_count;
}

/* Makes the copies, with the plans made. */
static bool copy_meshes(struct scene *scene, struct plan *plans,
                        struct pool *pool, struct error *err)
{
    struct scene_instances *s = &scene->instances;
    struct flattening f = {.scene = scene,
                           .pool = pool,
                           .position_count = scene->position_count,
                           .normal_count = scene->normal_count};
    struct totals all = count_all(scene, plans);
    uint32_t count = s->count;

    if (!take_copies(scene, &all) || !grow_all(&f, &all)) {
        free(f.tris);
        free(f.faces);
        free(f.objects);
        return fail(err, "%s: out of memory for %llu triangles of instances",
                    scene->path, (unsigned long long)all.tris);
    }
    append_others(&f);
    s->count = 0;
    for (uint32_t i = 0; i < count; i++)
        if (is_copied(plans, &s->items[i]))
            flatten_instance(&f, &s->items[i], &plans[s->items[i].mesh]);
        else
            s->items[s->count++] = s->items[i];
    append_kept(&f, plans);
    give_arrays(&f);
    return true;
}

/* Returns true if each mesh has one instance, in the order of the meshes, and
 * all triangles are theirs. */
static bool is_used_in_order(const struct scene *scene)
{
    const struct scene_instances *s = &scene->instances;
    uint32_t tri_count = 0;

    for (uint32_t i = 0; i < s->mesh_count && i < s->count; i++) {
        if (s->items[i].mesh != i)
            return false;
        tri_count += s->meshes[i].tri_count;
    }
    return s->count == s->mesh_count && tri_count == scene->tri_count;
}

/* Makes the meshes of such a scene its triangles, without a copy. */
static void take_meshes(struct scene *scene, struct pool *pool)
{
    struct scene_instances *s = &scene->instances;

    for (uint32_t i = 0; i < s->count; i++) {
        const struct scene_mesh *mesh = &s->meshes[i];
        bool is_mirror =
            mesh_transform(scene, &s->items[i].matrix, mesh,
                           mesh->first_position, mesh->first_normal, pool);

        for (uint32_t t = 0; t < mesh->tri_count; t++) {
            scene->tri_objects[mesh->first_tri + t] = s->items[i].object;
            if (is_mirror)
                tri_turn_over(&scene->tris[mesh->first_tri + t]);
        }
    }
    s->count = 0;
    s->mesh_count = 0;
}

/* Makes copies of the meshes that shall have some. */
static bool flatten(struct scene *scene, struct pool *pool, struct error *err)
{
    struct scene_instances *s = &scene->instances;
    struct plan *plans = alloc_array(s->mesh_count, sizeof *plans);
    struct saving *savings = alloc_array(s->mesh_count, sizeof *savings);
    bool ok = plans != NULL && savings != NULL;

    for (uint32_t i = 0; ok && i < s->count; i++)
        plans[s->items[i].mesh].use_count++;
    if (ok) {
        choose_kept(scene, plans, savings);
        ok = copy_meshes(scene, plans, pool, err);
    } else {
        out_of_memory(scene, err);
    }
    free(plans);
    free(savings);
    return ok;
}

bool scene_flatten(struct scene *scene, struct pool *pool, struct error *err)
{
    if (scene->instances.mesh_count == 0)
        return true;
    if (!is_used_in_order(scene))
        return flatten(scene, pool, err);
    take_meshes(scene, pool);
    return true;
}

/* ---- arrays for kernels ---- */

/* Least and largest number of a matrix from a normalised mesh to the normalised
 * world. Larger ones are of meshes that are flat along an axis; smaller ones
 * cannot be seen. */
#define NUMBER_MIN 0x1p-60
#define NUMBER_MAX 0x1p40

/* ---- bounds ---- */

static void join_point(struct scene *scene, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        scene->bounds_lo[k] = fmin(scene->bounds_lo[k], p[k]);
        scene->bounds_hi[k] = fmax(scene->bounds_hi[k], p[k]);
    }
}

/* Joins the bounds with those of all vertices of an instance. */
static void join_vertices(struct scene *scene, uint32_t instance,
                          bool *has_bounds)
{
    const struct scene_instance *at = &scene->instances.items[instance];
    const struct scene_mesh *mesh = &scene->instances.meshes[at->mesh];

    for (uint32_t c = 0; c < 3 * mesh->tri_count; c++) {
        const struct tri *t = &scene->tris[mesh->first_tri + c / 3];
        double p[3];

        affine_point(&at->matrix,
                     scene->file_positions + 3 * (size_t)t->v[c % 3], p);
        for (int k = 0; k < 3 && !*has_bounds; k++)
            scene->bounds_lo[k] = scene->bounds_hi[k] = p[k];
        *has_bounds = true;
        join_point(scene, p);
    }
}

/* Finds the ends of the moved box of an instance's mesh along 0 x, 1 y, 2 z, 3
 * to 5 their opposites. */
static void find_ends(const struct scene_instances *s, uint32_t instance,
                      double ends[6])
{
    const struct scene_instance *at = &s->items[instance];
    const struct scene_mesh *mesh = &s->meshes[at->mesh];

    for (int k = 0; k < 6; k++)
        ends[k] = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double p[3], to[3];

        for (int k = 0; k < 3; k++)
            p[k] = (corner >> k & 1) != 0 ? mesh->hi[k] : mesh->lo[k];
        affine_point(&at->matrix, p, to);
        for (int k = 0; k < 3; k++) {
            ends[k] = fmax(ends[k], to[k]);
            ends[k + 3] = fmax(ends[k + 3], -to[k]);
        }
    }
}

/* The instances whose boxes reach farthest come first, as then most others are
 * within the bounds, also where they stand in a row. */
void instances_join_bounds(struct scene *scene, bool has_bounds)
{
    const struct scene_instances *s = &scene->instances;
    uint32_t farthest[6] = {0};
    double most[6], ends[6];

    for (uint32_t i = 0; i < s->count; i++) {
        find_ends(s, i, ends);
        for (int k = 0; k < 6; k++) {
            if (i > 0 && !(ends[k] > most[k]))
                continue;
            most[k] = ends[k];
            farthest[k] = i;
        }
    }
    for (int k = 0; k < 6 && s->count > 0; k++)
        join_vertices(scene, farthest[k], &has_bounds);
    for (uint32_t i = 0; i < s->count; i++) {
        bool is_inside = has_bounds;

        find_ends(s, i, ends);
        for (int k = 0; k < 3; k++)
            is_inside = is_inside && ends[k] <= scene->bounds_hi[k] &&
                        -ends[k + 3] >= scene->bounds_lo[k];
        if (!is_inside)
            join_vertices(scene, i, &has_bounds);
    }
}

/* ---- matrices ---- */

/* Sets the matrix from the mesh to the world. Returns false if it has no
 * size. */
static bool set_matrix(const struct scene *scene, const struct scene_mesh *mesh,
                       const struct affine *matrix, struct instance *at)
{
    struct vec3 *rows = at->rows;
    double origin[3], most = 0;

    affine_point(matrix, mesh->center, origin);
    for (int i = 0; i < 3; i++) {
        float *row[] = {&rows[i].x, &rows[i].y, &rows[i].z};

        for (int k = 0; k < 3; k++) {
            double m = matrix->m[i][k] * scene->scale / mesh->scale;

            most = fmax(most, fabs(m));
            *row[k] = (float)m;
        }
    }
    at->origin = scene_point(scene, origin);
    return most >= NUMBER_MIN && most <= NUMBER_MAX;
}

/* Sets the inverse, and the largest sum of magnitudes in a row of the
 * difference between inverse times matrix and identity. */
static void set_inverse(struct instance *at)
{
    struct affine a;
    double rows[3][3], determinant, error = 0;
    bool is_mirror;

    for (int i = 0; i < 3; i++) {
        a.m[i][0] = (double)at->rows[i].x;
        a.m[i][1] = (double)at->rows[i].y;
        a.m[i][2] = (double)at->rows[i].z;
    }
    is_mirror = affine_normals(&a, rows);
    determinant = vec3d_dot(a.m[0], rows[0]);
    for (int i = 0; i < 3; i++)
        at->inverse[i] = v3((float)(rows[0][i] / determinant),
                            (float)(rows[1][i] / determinant),
                            (float)(rows[2][i] / determinant));
    for (int i = 0; i < 3; i++) {
        struct vec3 row = at->inverse[i];
        double sum = 0;

        for (int k = 0; k < 3; k++)
            sum += fabs((double)row.x * a.m[0][k] + (double)row.y * a.m[1][k] +
                        (double)row.z * a.m[2][k] - (i == k));
        error = fmax(error, sum);
    }
    at->inverse_error = (float)(error * (1 + 1e-6));
    at->is_mirror = is_mirror;
}

/* Sets the bound of errors in the world: the padding that other boxes have, and
 * INSTANCE_ERROR of how far corners may be from the origin of the instance and
 * from that of the world. */
static void set_pad(struct instance *at)
{
    const struct vec3 from = v3_abs(at->origin);
    const float origin[3] = {from.x, from.y, from.z};
    double most = 0;

    for (int i = 0; i < 3; i++) {
        struct vec3 row = v3_abs(at->rows[i]);

        most = fmax(most, (double)row.x + (double)row.y + (double)row.z +
                              (double)origin[i]);
    }
    at->pad = (float)((double)BOX_PAD + 1.25 * (double)INSTANCE_ERROR * most);
}

/* ---- the arrays ---- */

/* Fills the instance, without first_tri. Returns false if it has no size or no
 * triangles. */
static bool build(const struct scene *scene, const struct scene_instance *from,
                  struct instance *at)
{
    const struct scene_mesh *mesh = &scene->instances.meshes[from->mesh];

    *at = (struct instance){.tri_count = mesh->tri_count,
                            .mesh_tri = mesh->first_tri,
                            .mesh = from->mesh};
    if (mesh->tri_count == 0 || !set_matrix(scene, mesh, &from->matrix, at))
        return false;
    set_inverse(at);
    set_pad(at);
    at->material = scene->tris[mesh->first_tri].material;
    return isfinite(at->inverse_error) && at->inverse_error < 1.0f;
}

bool instances_build(struct scene *scene, struct warnings *report,
                     struct error *err)
{
    struct scene_instances *s = &scene->instances;
    uint64_t next = s->mesh_count > 0 ? s->meshes[0].first_tri : 0;

    scene->placed = alloc_array(s->count, sizeof *scene->placed);
    scene->placed_objects =
        alloc_array(s->count, sizeof *scene->placed_objects);
    if (scene->placed == NULL || scene->placed_objects == NULL)
        return fail(err, "%s: out of memory for its instances", scene->path);
    for (uint32_t i = 0; i < s->count; i++) {
        struct instance *at = &scene->placed[scene->placed_count];

        if (!build(scene, &s->items[i], at)) {
            warnings_add(report, "instances without size",
                         "%s: found an instance without a size: dropped",
                         scene->path);
            continue;
        }
        at->first_tri = (uint32_t)next;
        next += at->tri_count;
        if (next >= NO_INDEX)
            return fail(err,
                        "%s: found more than %" PRIu32
                        " triangles with those of all instances",
                        scene->path, NO_INDEX - 1);
        scene->placed_objects[scene->placed_count++] = s->items[i].object;
    }
    free(s->items);
    s->items = NULL;
    s->count = 0;
    s->capacity = 0;
    if (scene->placed_count == 0 && s->mesh_count > 0) {
        scene->tri_count = s->meshes[0].first_tri;
        s->mesh_count = 0;
    }
    return true;
}
