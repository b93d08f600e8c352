// SPDX-License-Identifier: MIT
/*
 * ply.c - the elements of a PLY file
 *
 * The first elements "vertex", "face" and "tristrips" are read, and all others
 * are skipped. Faces may stand before the vertices; they are skipped first and
 * read at the end. Properties are known by their names, in any order and type.
 */
#include "read/ply.h"

#include <inttypes.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/thread_pool.h"
#include "read/mesh_finish.h"
#include "read/ply_file.h"
#include "read/scene_lists.h"
#include "kernels/vec.h"

struct reader {
    struct scene *scene;
    const char *path;
    struct warnings *report;
    struct error *err;
    struct ply_header header;
    struct ply_data data;
    struct ply_table vertices;
    struct face_tris tris;
    struct vec3 *face_colors; /* sRGB, then linear; NULL: none */
    int64_t *indices;         /* list of the present face */
    double *uvs;
    size_t index_capacity, uv_capacity, scene_uv_capacity;
    uint64_t index_count, uv_count;
    double texture; /* number of the texture of the present face */
    struct mesh_textures textures;
    bool has_uvs; /* of vertices */
};

/* ---- triangles and strips ---- */

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

/* Returns true if the rows of the element can be faces of this kind: one list
 * of 32-bit numbers with a count of one byte, in binary. */
static bool ply_triangles_fit(const struct ply_data *d,
                              const struct ply_table *t)
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

static void read_vertex_block(void *context, uint32_t block, int worker)
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

/* Fills the triangles of a scene without any, whose arrays have room for all
 * rows, as face_tris_add() would, and moves `data` behind them. Corners have
 * the texture coordinates of their vertices if has_uvs. Returns false, and
 * leaves the scene without triangles, if a row is no good triangle: the rows
 * are then read one by one. `pool` may be NULL. */
static bool ply_triangles_read(struct ply_data *d, const struct ply_table *t,
                               struct scene *scene, bool has_uvs,
                               uint32_t material, struct pool *pool)
{
    struct job job = {.rows = d->p,
                      .row_count = t->count,
                      .scene = scene,
                      .tri = {.material = material},
                      .has_vn = scene->normal_count > 0,
                      .has_vt = has_uvs,
                      .is_swapped = d->is_swapped};

    pool_each(pool, t->count / BLOCK_ROWS + 1, read_vertex_block, &job);
    if (atomic_load(&job.has_failed))
        return false;
    scene->tri_count = t->count;
    d->p += (size_t)t->count * ROW_BYTES;
    return true;
}

/* ---- vertices ---- */

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

/* Fills positions, normals, texture coordinates and colours of a scene without
 * any, and moves `data` behind the rows, which must have x, y and z. */
static bool ply_vertices_read(struct ply_data *d, const struct ply_table *t,
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

/* ---- elements of vertices ---- */

static bool out_of_memory(const struct reader *r)
{
    return fail(r->err, "%s: out of memory for the scene", r->path);
}

static bool read_vertices(struct reader *r, const struct ply_element *element)
{
    struct ply_table *t = &r->vertices;

    if (!ply_table_init(t, &r->header, element, r->path, r->err))
        return false;
    if (!ply_table_has(t, PLY_X, 3))
        return fail(r->err,
                    "%s:%" PRIu64 ": found vertices without x, y and z, "
                    "expected a number for each",
                    r->path, element->line);
    if (!ply_vertices_read(&r->data, t, r->scene))
        return false;
    r->scene_uv_capacity = r->scene->uv_count;
    r->has_uvs = r->scene->uv_count > 0;
    return true;
}

/* ---- faces ---- */

/* Reads a list of vertices into `indices`. */
static bool read_indices(struct reader *r, const struct ply_property *list)
{
    void *indices = r->indices;

    if (!ply_data_count(&r->data, list, &r->index_count))
        return false;
    if (!grow_array(&indices, &r->index_capacity, (size_t)r->index_count,
                    sizeof *r->indices))
        return out_of_memory(r);
    r->indices = indices;
    return ply_data_integers(&r->data, list->type, r->index_count, r->indices);
}

static bool read_uvs(struct reader *r, const struct ply_property *list)
{
    void *uvs = r->uvs;

    if (!ply_data_count(&r->data, list, &r->uv_count))
        return false;
    if (!grow_array(&uvs, &r->uv_capacity, (size_t)r->uv_count, sizeof *r->uvs))
        return out_of_memory(r);
    r->uvs = uvs;
    for (uint64_t i = 0; i < r->uv_count; i++)
        if (!ply_data_number(&r->data, list->type, &r->uvs[i]))
            return false;
    return true;
}

static bool read_face_row(struct reader *r, const struct ply_table *t,
                          struct vec3 *color)
{
    double rgb[3] = {0, 0, 0}, ignored;

    r->index_count = r->uv_count = 0;
    r->texture = 0;
    for (uint32_t i = 0; i < t->element->property_count; i++) {
        const struct ply_property *p = &t->items[i];
        double *to = &ignored;
        uint64_t count;
        bool ok;

        for (int k = 0; k < 3; k++)
            if (t->numbers[PLY_RED + k] == i)
                to = &rgb[k];
        if (t->numbers[PLY_TEXTURE] == i)
            to = &r->texture;
        if (i == t->lists[PLY_LIST_VERTICES])
            ok = read_indices(r, p);
        else if (i == t->lists[PLY_LIST_UVS])
            ok = read_uvs(r, p);
        else if (p->count_type != PLY_NONE)
            ok = ply_data_count(&r->data, p, &count) &&
                 ply_data_skip(&r->data, p->type, count);
        else
            ok = ply_data_number(&r->data, p->type, to);
        if (!ok)
            return false;
    }
    *color = vertex_color_encoded(rgb);
    return true;
}

static bool fail_index(const struct reader *r, int64_t index)
{
    char found[64], expected[64];

    snprintf(found, sizeof found, "vertex %" PRId64 " in a face", index);
    snprintf(expected, sizeof expected, "0 to %" PRId64,
             (int64_t)r->vertices.count - 1);
    return ply_data_fail(&r->data, found, expected);
}

/* Adds the texture coordinates of the face's corners, if there are as many. */
static bool put_uvs(struct reader *r)
{
    struct scene *s = r->scene;
    void *uvs = s->uvs;
    size_t n = (size_t)r->index_count;

    if (r->uv_count != 2 * n)
        return true;
    if ((size_t)s->uv_count + n >= NO_INDEX ||
        !grow_array(&uvs, &r->scene_uv_capacity, (size_t)s->uv_count + n,
                    sizeof *s->uvs))
        return out_of_memory(r);
    s->uvs = uvs;
    for (size_t i = 0; i < n; i++) {
        r->tris.corners[i].vt = s->uv_count;
        s->uvs[s->uv_count++] = v2(texture_coordinate(r->uvs[2 * i]),
                                   texture_coordinate(r->uvs[2 * i + 1]));
    }
    return true;
}

/* Returns the material of the present face. MeshLab writes texture -1 for a
 * face without one. */
static uint32_t material_of(struct reader *r)
{
    uint32_t count = r->header.texture_count;

    if (count == 0)
        return MESH_MATERIAL;
    if (r->texture >= 0 && r->texture < count)
        return MESH_MATERIAL + (uint32_t)r->texture;
    r->textures.has_plain = true;
    if (r->texture != -1)
        warnings_add(r->report, "faces with a bad texture",
                     "%s%s: found texture %g of a face, expected 0 to %" PRIu32
                     " or -1: it has none",
                     r->path, file_place_text(ply_data_place(&r->data)).text,
                     r->texture, count - 1);
    return MESH_MATERIAL + count;
}

/* Adds the face of some indices. The place is that behind it. */
static bool add_face(struct reader *r, const int64_t *indices, uint64_t count)
{
    struct scene *s = r->scene;
    struct face_tris *f = &r->tris;

    if (!face_tris_reserve(f, (size_t)count))
        return out_of_memory(r);
    for (size_t i = 0; i < count; i++) {
        uint32_t v = (uint32_t)indices[i];

        if (indices[i] < 0 || indices[i] >= r->vertices.count)
            return fail_index(r, indices[i]);
        f->corners[i] = (struct corner){v, r->has_uvs ? v : NO_INDEX,
                                        s->normal_count > 0 ? v : NO_INDEX};
        memcpy(f->points + 3 * i, s->file_positions + 3 * (size_t)v,
               3 * sizeof *f->points);
    }
    f->corner_count = (uint32_t)count;
    if (r->uv_count > 0 && !put_uvs(r))
        return false;
    return face_tris_add(f, 0, material_of(r), ply_data_place(&r->data)) ||
           out_of_memory(r);
}

/* Reads faces that are all triangles at once. Returns false if they are not. */
static bool read_triangles(struct reader *r, const struct ply_table *t)
{
    struct pool *pool;
    bool ok;

    if (r->scene->tri_count > 0 || !ply_triangles_fit(&r->data, t))
        return false;
    pool = scene_pool(r->scene, t->count);
    ok = ply_triangles_read(&r->data, t, r->scene, r->has_uvs, MESH_MATERIAL,
                            pool);
    pool_destroy(pool);
    if (ok)
        r->tris.face_count = t->count;
    return ok;
}

static bool read_face_rows(struct reader *r, const struct ply_table *t)
{
    struct vec3 color;

    if (!face_tris_reserve_tris(&r->tris, t->count))
        return out_of_memory(r);
    if (read_triangles(r, t))
        return true;
    for (uint32_t i = 0; i < t->count; i++) {
        if (!read_face_row(r, t, &color) ||
            !add_face(r, r->indices, r->index_count))
            return false;
        if (r->face_colors != NULL)
            r->face_colors[i] = color;
        r->tris.face_count++;
    }
    if (r->face_colors != NULL)
        ply_table_decode(t, r->face_colors);
    return true;
}

/* Adds the triangles of a strip, whose winding alternates. -1 begins another;
 * triangles with a vertex twice only turn the strip. */
static bool add_strip(struct reader *r)
{
    uint64_t start = 0;

    for (uint64_t i = 0; i < r->index_count; i++) {
        const int64_t *v = r->indices + i;
        bool is_turned = (i - start) % 2 == 1;
        int64_t corners[3];

        if (*v == -1) {
            start = i + 1;
            continue;
        }
        if (i < start + 2)
            continue;
        corners[0] = v[is_turned ? -1 : -2];
        corners[1] = v[is_turned ? -2 : -1];
        corners[2] = v[0];
        if (corners[0] == corners[1] || corners[1] == corners[2] ||
            corners[2] == corners[0])
            continue;
        if (r->tris.face_count == NO_INDEX - 1)
            return out_of_memory(r);
        if (!add_face(r, corners, 3))
            return false;
        r->tris.face_count++;
    }
    return true;
}

static bool read_strip_rows(struct reader *r, const struct ply_table *t)
{
    struct vec3 ignored;

    for (uint32_t i = 0; i < t->count; i++) {
        if (!read_face_row(r, t, &ignored))
            return false;
        r->uv_count = 0;
        if (!add_strip(r))
            return false;
    }
    return true;
}

static bool read_faces(struct reader *r, const struct ply_element *element,
                       bool is_strips)
{
    struct ply_table t;

    if (!ply_table_init(&t, &r->header, element, r->path, r->err))
        return false;
    if (t.count > 0 && t.lists[PLY_LIST_VERTICES] == NO_INDEX)
        return fail(r->err,
                    "%s:%" PRIu64 ": found faces without the list "
                    "vertex_indices",
                    r->path, element->line);
    if (is_strips)
        return read_strip_rows(r, &t);
    if (r->scene->colors == NULL && ply_table_has(&t, PLY_RED, 3)) {
        r->face_colors = alloc_array(t.count, sizeof *r->face_colors);
        if (r->face_colors == NULL)
            return out_of_memory(r);
    }
    return read_face_rows(r, &t);
}

/* ---- the file ---- */

static bool skip_element(struct reader *r, const struct ply_element *e)
{
    const struct ply_property *p;

    if (e->property_count == 0)
        return true;
    p = r->header.properties + e->first_property;
    for (uint64_t i = 0; i < e->count; i++) {
        for (uint32_t k = 0; k < e->property_count; k++) {
            uint64_t count = 1;

            if ((p[k].count_type != PLY_NONE &&
                 !ply_data_count(&r->data, &p[k], &count)) ||
                !ply_data_skip(&r->data, p[k].type, count))
                return false;
        }
    }
    return true;
}

/* Elements that are read, and the data of faces before the vertices. */
enum kind { KIND_VERTICES, KIND_FACES, KIND_STRIPS, KINDS };

struct found {
    const struct ply_element *element; /* NULL: not yet */
    struct ply_data data;
    bool is_read;
};

static enum kind kind_of(const struct ply_element *e)
{
    static const char *const names[KINDS] = {"vertex", "face", "tristrips"};
    int kind = 0;

    while (kind < KINDS && !word_is(e->name, names[kind]))
        kind++;
    return (enum kind)kind;
}

static bool read_found(struct reader *r, struct found *f, enum kind kind)
{
    f->is_read = true;
    return kind == KIND_VERTICES
               ? read_vertices(r, f->element)
               : read_faces(r, f->element, kind == KIND_STRIPS);
}

static bool read_elements(struct reader *r, struct found found[KINDS])
{
    for (uint32_t i = 0; i < r->header.element_count; i++) {
        const struct ply_element *e = &r->header.elements[i];
        enum kind kind = kind_of(e);
        bool is_first = kind != KINDS && found[kind].element == NULL;
        bool ok;

        if (!ply_data_expect(&r->data, &r->header, e))
            return false;
        if (is_first) {
            found[kind].element = e;
            found[kind].data = r->data;
        }
        ok = is_first && (kind == KIND_VERTICES || found[KIND_VERTICES].is_read)
                 ? read_found(r, &found[kind], kind)
                 : skip_element(r, e);
        if (!ok)
            return false;
    }
    return true;
}

/* Reads the faces that stand before the vertices. */
static bool read_earlier_faces(struct reader *r, struct found found[KINDS])
{
    for (int kind = KIND_FACES; kind < KINDS; kind++) {
        if (found[kind].element == NULL || found[kind].is_read)
            continue;
        r->data = found[kind].data;
        if (!read_found(r, &found[kind], (enum kind)kind))
            return false;
    }
    return true;
}

static bool read_body(struct reader *r)
{
    struct found found[KINDS] = {{.element = NULL}};

    if (!read_elements(r, found))
        return false;
    if (found[KIND_VERTICES].element == NULL)
        return fail(r->err,
                    "%s: found no element vertex, expected one with x, y and z",
                    r->path);
    if (!read_earlier_faces(r, found))
        return false;
    if (r->tris.face_count == 0)
        return fail(r->err,
                    "%s: found %" PRIu32
                    " point%s and no face, expected faces: "
                    "glim does not draw clouds of points",
                    r->path, r->vertices.count,
                    print_plural(r->vertices.count));
    r->scene->up_is_z = r->header.is_of_blender;
    r->textures.names = r->header.textures;
    r->textures.count = r->header.texture_count;
    return mesh_finish(r->scene, r->face_colors, &r->textures, r->report,
                       r->err);
}

bool ply_parse(struct scene *scene, const char *bytes, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err)
{
    struct reader r = {
        .scene = scene,
        .path = path,
        .report = report,
        .err = err,
        .tris = {.scene = scene, .path = path, .report = report},
    };
    bool ok = mesh_begin(scene, path, err) &&
              ply_header_parse(&r.header, bytes, size_bytes, path, err);

    if (ok) {
        r.data =
            ply_data_begin(&r.header, bytes, size_bytes, path, report, err);
        ok = read_body(&r);
    }
    ply_header_free(&r.header);
    face_tris_free(&r.tris);
    free(r.face_colors);
    free(r.indices);
    free(r.uvs);
    return ok;
}
