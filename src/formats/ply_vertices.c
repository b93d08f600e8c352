// SPDX-License-Identifier: MIT
#include "formats/ply_vertices.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "formats/vertex_colors.h"
#include "kernels/vec.h"

/* Rows that are read as one. */
#define BLOCK_ROWS 16384u

struct rows {
    const struct ply_data *data;
    const struct ply_table *table;
    struct scene *scene;
    unsigned char *roles; /* of each property, or PLY_ROLES */
    size_t row_bytes;     /* 0: it differs between rows */
    atomic_bool has_normals;
};

/* Reads a row of numbers; lists are skipped. */
static bool read_row(const struct rows *r, struct ply_data *d, double *values)
{
    for (uint32_t i = 0; i < r->table->element->property_count; i++) {
        const struct ply_property *p = &r->table->items[i];
        uint64_t count = 1;

        if (r->roles[i] < PLY_ROLES) {
            if (!ply_data_number(d, p->type, &values[r->roles[i]]))
                return false;
            continue;
        }
        if ((p->count_type != PLY_NONE && !ply_data_count(d, p, &count)) ||
            !ply_data_skip(d, p->type, count))
            return false;
    }
    return true;
}

/* Returns true if the vertex has a normal. */
static bool put_vertex(struct scene *s, uint32_t i, double *values)
{
    bool has_normal = false;

    memcpy(s->file_positions + 3 * (size_t)i, &values[PLY_X],
           3 * sizeof *values);
    if (s->normals != NULL) {
        if (!vec3d_normalize(&values[PLY_NX]))
            memset(&values[PLY_NX], 0, 3 * sizeof *values); /* unusable */
        s->normals[i] = v3((float)values[PLY_NX], (float)values[PLY_NY],
                           (float)values[PLY_NZ]);
        has_normal = !v3_is_zero(s->normals[i]);
    }
    if (s->uvs != NULL)
        s->uvs[i] = v2(texture_coordinate(values[PLY_U]),
                       texture_coordinate(values[PLY_V]));
    if (s->colors != NULL)
        s->colors[i] = vertex_color_encoded(&values[PLY_RED]);
    return has_normal;
}

static bool read_range(struct rows *r, struct ply_data *d, uint32_t begin,
                       uint32_t end)
{
    double values[PLY_ROLES] = {0};
    bool has_normals = false;

    for (uint32_t i = begin; i < end; i++) {
        if (!read_row(r, d, values))
            return false;
        has_normals |= put_vertex(r->scene, i, values);
    }
    if (has_normals)
        atomic_store(&r->has_normals, true);
    return true;
}

/* Cannot fail, since ply_data_expect() has found all rows in the file. */
static void read_block(void *context, uint32_t block, int worker)
{
    struct rows *r = context;
    uint32_t begin = block * BLOCK_ROWS, left = r->table->count - begin;
    struct ply_data d = *r->data;

    (void)worker;
    d.p += begin * r->row_bytes;
    read_range(r, &d, begin, begin + (left < BLOCK_ROWS ? left : BLOCK_ROWS));
}

/* Allocates the arrays that the vertices have. */
static bool allocate(const struct ply_table *t, struct scene *s)
{
    bool has_normals = ply_table_has(t, PLY_NX, 3),
         has_colors = ply_table_has(t, PLY_RED, 3);
    bool has_uvs = ply_table_has(t, PLY_U, 2);

    s->file_positions = alloc_array(t->count, 3 * sizeof *s->file_positions);
    if (has_normals)
        s->normals = alloc_array(t->count, sizeof *s->normals);
    if (has_colors)
        s->colors = alloc_array(t->count, sizeof *s->colors);
    if (has_uvs)
        s->uvs = alloc_array(t->count, sizeof *s->uvs);
    return s->file_positions != NULL && !has_normals == (s->normals == NULL) &&
           !has_colors == (s->colors == NULL) && !has_uvs == (s->uvs == NULL);
}

/* Returns the bytes of a row, or 0 if rows differ. */
static size_t row_bytes(const struct ply_data *d, const struct ply_table *t)
{
    size_t bytes = 0;

    for (uint32_t i = 0; i < t->element->property_count; i++) {
        if (d->is_ascii || t->items[i].count_type != PLY_NONE)
            return 0;
        bytes += ply_type_bytes(t->items[i].type);
    }
    return bytes;
}

static bool read_all(struct rows *r, struct ply_data *d)
{
    uint32_t count = r->table->count;
    struct pool *pool;

    if (r->row_bytes == 0)
        return read_range(r, d, 0, count);
    pool = scene_pool(r->scene, count);
    pool_each(pool, count / BLOCK_ROWS + (count % BLOCK_ROWS > 0), read_block,
              r);
    pool_destroy(pool);
    d->p += count * r->row_bytes;
    return true;
}

bool ply_vertices_read(struct ply_data *d, const struct ply_table *t,
                       struct scene *s)
{
    uint32_t property_count = t->element->property_count;
    struct rows r = {.data = d,
                     .table = t,
                     .scene = s,
                     .roles = alloc_array(property_count, sizeof *r.roles),
                     .row_bytes = row_bytes(d, t)};
    bool ok;

    if (r.roles == NULL || !allocate(t, s)) {
        free(r.roles);
        return fail(d->err, "%s: out of memory for the scene", d->path);
    }
    memset(r.roles, PLY_ROLES, property_count);
    for (int i = 0; i < PLY_ROLES; i++)
        if (t->numbers[i] != NO_INDEX)
            r.roles[t->numbers[i]] = (unsigned char)i;
    ok = read_all(&r, d);
    free(r.roles);
    if (!ok)
        return false;
    s->position_count = t->count;
    s->uv_count = s->uvs != NULL ? t->count : 0;
    s->color_count = s->colors != NULL ? t->count : 0;
    /* normals that are all unusable are none */
    s->normal_count = atomic_load(&r.has_normals) ? t->count : 0;
    if (s->colors != NULL)
        ply_table_decode(t, s->colors);
    return true;
}
