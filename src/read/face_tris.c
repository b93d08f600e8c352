// SPDX-License-Identifier: MIT
#include "read/face_tris.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/print.h"

/* Largest coordinate that is kept: a larger float has too few digits to address
 * texels. */
#define UV_MAX 1e6

float texture_coordinate(double x)
{
    if (!isfinite(x))
        return 0;
    return (float)(fabs(x) > UV_MAX ? x - floor(x) : x);
}

struct place_text file_place_text(struct file_place place)
{
    struct place_text t;

    if (place.line != 0)
        snprintf(t.text, sizeof t.text, ":%" PRIu64, place.line);
    else
        snprintf(t.text, sizeof t.text, ": byte %" PRIu64, place.byte);
    return t;
}

bool face_tris_reserve(struct face_tris *f, size_t needed)
{
    size_t capacity = f->corner_capacity;
    void *corners = f->corners;
    void *points = f->points;

    if (needed <= capacity)
        return true;
    if (needed >= NO_INDEX ||
        !grow_array(&corners, &capacity, needed, sizeof *f->corners))
        return false;
    f->corners = corners;
    if (!grow_array(&points, &f->corner_capacity, needed,
                    3 * sizeof *f->points))
        return false;
    f->points = points;
    return true;
}

static bool is_usable(const struct face_tris *f, struct file_place place)
{
    if (f->corner_count < 3) {
        warnings_add(f->report, "faces with too few corners",
                     "%s%s: found a face with %" PRIu32 " corner%s, "
                     "expected 3 or more: face dropped",
                     f->path, file_place_text(place).text, f->corner_count,
                     print_plural(f->corner_count));
        return false;
    }
    for (size_t i = 0; i < 3 * (size_t)f->corner_count; i++) {
        if (!isfinite(f->points[i])) {
            warnings_add(f->report, "faces with a vertex that is not finite",
                         "%s%s: found a face with a vertex that is not "
                         "finite: face dropped",
                         f->path, file_place_text(place).text);
            return false;
        }
    }
    return true;
}

bool face_tris_reserve_tris(struct face_tris *f, size_t more)
{
    struct scene *scene = f->scene;
    size_t needed = (size_t)scene->tri_count + more;
    size_t tri_capacity = f->tri_capacity;
    size_t face_capacity = f->tri_capacity;
    void *tris = scene->tris;
    void *faces = scene->tri_faces;
    void *objects = scene->tri_objects;

    if (needed <= f->tri_capacity)
        return true;
    if (needed >= NO_INDEX ||
        !grow_array(&tris, &tri_capacity, needed, sizeof *scene->tris))
        return false;
    scene->tris = tris;
    if (!grow_array(&faces, &face_capacity, needed, sizeof *scene->tri_faces))
        return false;
    scene->tri_faces = faces;
    if (!grow_array(&objects, &f->tri_capacity, needed,
                    sizeof *scene->tri_objects))
        return false;
    scene->tri_objects = objects;
    return true;
}

static bool has_normal(const struct scene *scene, uint32_t vn)
{
    return vn != NO_INDEX &&
           (scene->normals[vn].x != 0 || scene->normals[vn].y != 0 ||
            scene->normals[vn].z != 0);
}

/* Adds the triangle of the corners t, for which there is room. It has normals
 * if all three corners have one, and likewise texture vertices. */
static void add_tri(const struct face_tris *f, const struct corner *corners,
                    const uint32_t t[3], uint32_t object, uint32_t material)
{
    struct scene *scene = f->scene;
    uint32_t n = scene->tri_count++;
    struct tri tri = {.material = material};
    bool has_vn = true;
    bool has_vt = true;

    for (int k = 0; k < 3; k++) {
        const struct corner *c = &corners[t[k]];

        tri.v[k] = c->v;
        tri.vn[k] = c->vn;
        tri.vt[k] = c->vt;
        has_vn &= has_normal(scene, c->vn);
        has_vt &= c->vt != NO_INDEX;
    }
    for (int k = 0; k < 3; k++) {
        tri.vn[k] = has_vn ? tri.vn[k] : NO_INDEX;
        tri.vt[k] = has_vt ? tri.vt[k] : NO_INDEX;
    }
    scene->tris[n] = tri;
    scene->tri_faces[n] = f->face_count;
    scene->tri_objects[n] = object;
}

/* The corners of a triangle, of which there is one. */
static const uint32_t single[1][3] = {{0, 1, 2}};

static bool add_tris(struct face_tris *f, uint32_t object, uint32_t material)
{
    const uint32_t(*triangles)[3] = single;
    uint32_t count = 1;

    if (f->corner_count > 3) {
        if (!polygon_triangulate(&f->polygon, f->points, f->corner_count))
            return false;
        triangles = (const uint32_t(*)[3])f->polygon.triangles;
        count = f->polygon.triangle_count;
    }
    if (!face_tris_reserve_tris(f, count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        add_tri(f, f->corners, triangles[i], object, material);
    return true;
}

bool face_tris_add_triangles(struct face_tris *f, const struct corner *corners,
                             uint32_t count, uint32_t object, uint32_t material)
{
    if (!face_tris_reserve_tris(f, count))
        return false;
    for (uint32_t i = 0; i < count; i++, f->face_count++)
        add_tri(f, corners + 3 * (size_t)i, single[0], object, material);
    return true;
}

bool face_tris_add(struct face_tris *f, uint32_t object, uint32_t material,
                   struct file_place place)
{
    if (!is_usable(f, place))
        return true;
    if (!add_tris(f, object, material))
        return false;
    if (f->corner_count > 3 && f->polygon.crosses_itself)
        warnings_add(f->report, "polygons that cross themselves",
                     "%s%s: found a polygon that crosses itself: its triangles "
                     "are approximate",
                     f->path, file_place_text(place).text);
    return true;
}

void face_tris_free(struct face_tris *f)
{
    free(f->corners);
    free(f->points);
    polygon_free(&f->polygon);
    memset(f, 0, sizeof *f);
}
