// SPDX-License-Identifier: MIT
#include "scene/instance_build.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "scene/scene.h"
#include "kernels/instance.h"
#include "kernels/traverse_leaf.h"

/* Least and largest number of a matrix from a normalised mesh to the normalised
 * world. Larger ones are of meshes that are flat along an axis; smaller ones
 * cannot be seen. */
#define NUMBER_LEAST 0x1p-60
#define NUMBER_MOST  0x1p40

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
    return most >= NUMBER_LEAST && most <= NUMBER_MOST;
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

/* ---- the whole ---- */

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
