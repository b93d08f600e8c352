// SPDX-License-Identifier: MIT
#include "formats/ply_triangles.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* Bytes of a row: a count and three numbers. */
#define ROW_BYTES 13

/* Rows that are read as one. */
#define BLOCK_ROWS 16384u

struct job {
    const char *rows;
    uint32_t row_count;
    struct scene *scene;
    struct tri tri; /* its v are filled */
    bool has_vn, has_vt;
    bool is_swapped;
    atomic_bool has_failed;
};

bool ply_triangles_fit(const struct ply_data *d, const struct ply_table *t)
{
    const struct ply_property *list;

    if (d->is_ascii || t->element->property_count != 1)
        return false;
    list = t->items;
    return t->lists[PLY_LIST_VERTICES] == 0 &&
           ply_type_bytes(list->count_type) == 1 &&
           (list->type == PLY_INT32 || list->type == PLY_UINT32) &&
           t->count <= (size_t)(d->end - d->p) / ROW_BYTES;
}

static bool is_finite(const struct scene *s, uint32_t v)
{
    const double *p = s->file_positions + 3 * (size_t)v;

    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

static bool has_normal(const struct scene *s, uint32_t v)
{
    return s->normals[v].x != 0 || s->normals[v].y != 0 || s->normals[v].z != 0;
}

/* Fills a triangle. Returns false if its row is something else. */
static bool fill(const struct job *j, const char *row, struct tri *tri)
{
    const struct scene *s = j->scene;
    bool has_vn = j->has_vn;

    *tri = j->tri;
    if (row[0] != 3)
        return false;
    for (int k = 0; k < 3; k++) {
        uint32_t v;

        memcpy(&v, row + 1 + 4 * k, sizeof v);
        v = j->is_swapped ? __builtin_bswap32(v) : v;
        if (v >= s->position_count || !is_finite(s, v))
            return false;
        has_vn = has_vn && has_normal(s, v);
        tri->v[k] = v;
        tri->vt[k] = j->has_vt ? v : NO_INDEX;
    }
    for (int k = 0; k < 3; k++)
        tri->vn[k] = has_vn ? tri->v[k] : NO_INDEX;
    return true;
}

static void read_block(void *context, uint32_t block, int worker)
{
    struct job *j = context;
    uint32_t begin = block * BLOCK_ROWS;
    bool ok = true;

    (void)worker;
    for (uint32_t i = begin; ok && i < j->row_count && i < begin + BLOCK_ROWS;
         i++) {
        ok = fill(j, j->rows + (size_t)i * ROW_BYTES, &j->scene->tris[i]);
        j->scene->tri_faces[i] = i;
        j->scene->tri_objects[i] = 0;
    }
    if (!ok)
        atomic_store(&j->has_failed, true);
}

bool ply_triangles_read(struct ply_data *d, const struct ply_table *t,
                        struct scene *scene, bool has_uvs, uint32_t material,
                        struct pool *pool)
{
    struct job job = {.rows = d->p,
                      .row_count = t->count,
                      .scene = scene,
                      .tri = {.material = material},
                      .has_vn = scene->normal_count > 0,
                      .has_vt = has_uvs,
                      .is_swapped = d->is_swapped};

    pool_each(pool, t->count / BLOCK_ROWS + 1, read_block, &job);
    if (atomic_load(&job.has_failed))
        return false;
    scene->tri_count = t->count;
    d->p += (size_t)t->count * ROW_BYTES;
    return true;
}
