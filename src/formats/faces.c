// SPDX-License-Identifier: MIT
#include "formats/faces.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Limit for the digits of an index: above every vertex count, and far from
 * overflow. */
#define INDEX_TEXT_MAX INT64_C(1000000000000)

static const char *const corner_names[] = {"vertex", "texture vertex",
                                           "normal"};

static bool out_of_memory(const struct faces *f, const struct lexer *lex,
                          struct error *err)
{
    return fail(err, "%s:%" PRIu64 ": out of memory for the faces", f->path,
                lex->line);
}

/* Reads digits with an optional '-'. Returns false if there are no digits. */
static bool parse_index(const char **p, const char *end, int64_t *index)
{
    bool is_negative = *p < end && **p == '-';
    const char *first = *p + is_negative;
    const char *q = first;
    int64_t value = 0;

    for (; q < end && *q >= '0' && *q <= '9'; q++) {
        if (value < INDEX_TEXT_MAX)
            value = value * 10 + (*q - '0');
    }
    *p = q;
    *index = is_negative ? -value : value;
    return q > first;
}

/* Turns an index of the file, which counts from 1 or back from the last vertex
 * so far, into one from 0. Returns false if it is out of range. */
static bool resolve(int64_t index, uint32_t count, uint32_t *to)
{
    if (index < 0)
        index += (int64_t)count + 1;
    if (index < 1 || index > count)
        return false;
    *to = (uint32_t)(index - 1);
    return true;
}

static bool report_index(const struct faces *f, const struct lexer *lex,
                         const char *what, struct word index, uint32_t count)
{
    struct word_text text = word_cut(index);

    if (count == 0)
        warnings_add(
            f->report, "faces with a bad index",
            "%s:%" PRIu64
            ": found %s %s in a face, but none before it: face dropped",
            f->path, lex->line, what, text.text);
    else
        warnings_add(f->report, "faces with a bad index",
                     "%s:%" PRIu64 ": found %s %s in a face, expected 1 to "
                     "%" PRIu32 " or -1 to -%" PRIu32 ": face dropped",
                     f->path, lex->line, what, text.text, count, count);
    return false;
}

/* Reports an index into a list (normals or texture vertices) that the file does
 * not contain at all. Exporters that strip such a list may leave its indices in
 * the faces, so the face is used without them. */
static bool is_missing_list(const struct faces *f, const struct lexer *lex,
                            int k, int64_t index, struct word word,
                            uint32_t count)
{
    if (k == 0 || count > 0 || index < 1)
        return false;
    warnings_add(
        f->report,
        k == 1 ? "corners without their texture vertex"
               : "corners without their normal",
        "%s:%" PRIu64
        ": found %s %s in a face, but none before it: face used without",
        f->path, lex->line, corner_names[k], word_cut(word).text);
    return true;
}

static bool report_malformed(const struct faces *f, const struct lexer *lex,
                             struct word word)
{
    warnings_add(f->report, "malformed faces",
                 "%s:%" PRIu64
                 ": found %s in a face, expected v, v/vt, v//vn or "
                 "v/vt/vn: face dropped",
                 f->path, lex->line, word_quote(word).text);
    return false;
}

/* Reads v, v/vt, v//vn or v/vt/vn. A slash at the end is accepted. */
static bool parse_corner(const struct faces *f, const struct lexer *lex,
                         struct word word, struct corner *c)
{
    const uint32_t counts[] = {f->scene->position_count, f->scene->uv_count,
                               f->scene->normal_count};
    const char *p = word.start;
    const char *end = p + word.length;
    uint32_t indices[3] = {NO_INDEX, NO_INDEX, NO_INDEX};

    for (int k = 0; k < 3 && p <= end; k++) {
        const char *start = p;
        int64_t index;

        if (parse_index(&p, end, &index)) {
            struct word text = {start, (size_t)(p - start)};

            if (!resolve(index, counts[k], &indices[k]) &&
                !is_missing_list(f, lex, k, index, text, counts[k]))
                return report_index(f, lex, corner_names[k], text, counts[k]);
        } else if (k == 0 || p != start) {
            return report_malformed(f, lex, word);
        }
        if (p == end)
            break;
        if (*p != '/' || k == 2)
            return report_malformed(f, lex, word);
        p++;
    }
    *c = (struct corner){indices[0], indices[1], indices[2]};
    return true;
}

static bool grow_corners(struct faces *f, size_t needed)
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

/* Reads the corners up to the end of the line. *is_good becomes false for a
 * face that was reported and has to be dropped. */
static bool read_corners(struct faces *f, struct lexer *lex, bool *is_good,
                         struct error *err)
{
    *is_good = true;
    f->corner_count = 0;
    while (!lexer_at_line_end(lex)) {
        uint32_t n = f->corner_count;
        struct corner *c;

        if (!grow_corners(f, (size_t)n + 1))
            return out_of_memory(f, lex, err);
        c = &f->corners[n];
        if (!parse_corner(f, lex, lexer_word(lex), c)) {
            *is_good = false;
            return true;
        }
        memcpy(f->points + 3 * (size_t)n,
               f->scene->file_positions + 3 * (size_t)c->v,
               3 * sizeof *f->points);
        f->corner_count++;
    }
    return true;
}

static bool is_usable(const struct faces *f, uint64_t line)
{
    if (f->corner_count < 3) {
        warnings_add(f->report, "faces with too few corners",
                     "%s:%" PRIu64 ": found a face with %" PRIu32 " corners, "
                     "expected 3 or more: face dropped",
                     f->path, line, f->corner_count);
        return false;
    }
    for (size_t i = 0; i < 3 * (size_t)f->corner_count; i++) {
        if (!isfinite(f->points[i])) {
            warnings_add(f->report, "faces with a vertex that is not finite",
                         "%s:%" PRIu64
                         ": found a face with a vertex that is not "
                         "finite: face dropped",
                         f->path, line);
            return false;
        }
    }
    return true;
}

static bool grow_tris(struct faces *f, size_t more)
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

/* Returns the triangle of the corners t. It has normals if all three corners
 * have one, and likewise texture vertices. */
static struct tri make_tri(const struct faces *f, const uint32_t t[3],
                           uint32_t material)
{
    struct tri tri = {.material = material};
    bool has_vn = true;
    bool has_vt = true;

    for (int k = 0; k < 3; k++) {
        const struct corner *c = &f->corners[t[k]];

        tri.v[k] = c->v;
        tri.vn[k] = c->vn;
        tri.vt[k] = c->vt;
        has_vn &= has_normal(f->scene, c->vn);
        has_vt &= c->vt != NO_INDEX;
    }
    for (int k = 0; k < 3; k++) {
        tri.vn[k] = has_vn ? tri.vn[k] : NO_INDEX;
        tri.vt[k] = has_vt ? tri.vt[k] : NO_INDEX;
    }
    return tri;
}

static bool add_tris(struct faces *f, uint32_t object, uint32_t material)
{
    static const uint32_t single[1][3] = {{0, 1, 2}};
    const uint32_t(*triangles)[3] = single;
    struct scene *scene = f->scene;
    uint32_t count = 1;

    if (f->corner_count > 3) {
        if (!polygon_triangulate(&f->polygon, f->points, f->corner_count))
            return false;
        triangles = (const uint32_t(*)[3])f->polygon.triangles;
        count = f->polygon.triangle_count;
    }
    if (!grow_tris(f, count))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t n = scene->tri_count++;

        scene->tris[n] = make_tri(f, triangles[i], material);
        scene->tri_faces[n] = f->face_count;
        scene->tri_objects[n] = object;
    }
    return true;
}

bool faces_read(struct faces *f, struct lexer *lex, uint32_t object,
                uint32_t material, struct error *err)
{
    uint64_t line = lex->line;
    bool is_good;

    if (f->face_count == NO_INDEX - 1)
        return fail(err, "%s:%" PRIu64 ": found more than 4294967294 faces",
                    f->path, line);
    if (!read_corners(f, lex, &is_good, err))
        return false;
    if (is_good && is_usable(f, line)) {
        if (!add_tris(f, object, material))
            return out_of_memory(f, lex, err);
        if (f->corner_count > 3 && f->polygon.crosses_itself)
            warnings_add(f->report, "polygons that cross themselves",
                         "%s:%" PRIu64 ": found a polygon that crosses itself: "
                         "its triangles are approximate",
                         f->path, line);
    }
    f->face_count++;
    return true;
}

void faces_free(struct faces *f)
{
    free(f->corners);
    free(f->points);
    polygon_free(&f->polygon);
    memset(f, 0, sizeof *f);
}
