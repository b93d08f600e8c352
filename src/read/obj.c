// SPDX-License-Identifier: MIT
#include "read/obj.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/geometry.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "base/text_stream.h"
#include "read/asset_path.h"
#include "read/face_tris.h"
#include "read/mesh_finish.h"
#include "read/mtl.h"
#include "read/obj_runs.h"
#include "read/scene_lists.h"

/* Bytes searched for a NUL. Text has none; most binary files have one early. */
#define BINARY_CHECK_BYTES 1024

/* Usual bytes of a triangle and its vertices. */
#define TRI_BYTES 32

struct parser {
    struct scene *scene;
    const char *path;
    struct warnings *report;
    struct error *err;
    struct lexer lex;
    uint64_t statement_count, unknown_count;
    size_t capacities[OBJ_LISTS], color_capacity; /* of the vertices */
    struct name_table objects;
    struct name_table
        materials; /* names in usemtl; number 0 is "", before the first */
    uint64_t *material_lines; /* line of the first use of each */
    size_t material_line_capacity;
    struct name_table libraries; /* paths of the MTL files read */
    struct face_tris faces;
    uint32_t object, material;
    uint32_t painted_count; /* vertices with a colour from #MRGB */
    bool has_objects;       /* there was an o statement: g is only a group */
    bool has_infinite;      /* a vertex is not finite */
};

/* ---- faces ---- */

/* Limit for the digits of an index: above every vertex count, and far from
 * overflow. */
#define INDEX_TEXT_MAX INT64_C(1000000000000)

static const char *const corner_names[] = {"vertex", "texture vertex",
                                           "normal"};

static bool no_memory_for_face(const struct parser *p)
{
    return fail(p->err, "%s:%" PRIu64 ": out of memory for the faces", p->path,
                p->lex.line);
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

static bool report_index(const struct parser *p, const char *what,
                         struct word index, uint32_t count)
{
    struct word_text text = word_cut(index);

    if (count == 0)
        warnings_add(
            p->report, "faces with a bad index",
            "%s:%" PRIu64
            ": found %s %s in a face, but none before it: face dropped",
            p->path, p->lex.line, what, text.text);
    else
        warnings_add(p->report, "faces with a bad index",
                     "%s:%" PRIu64 ": found %s %s in a face, expected 1 to "
                     "%" PRIu32 " or -1 to -%" PRIu32 ": face dropped",
                     p->path, p->lex.line, what, text.text, count, count);
    return false;
}

/* Reports an index into a list (normals or texture vertices) that the file does
 * not contain at all. Exporters that strip such a list may leave its indices in
 * the faces, so the face is used without them. */
static bool is_missing_list(const struct parser *p, int k, int64_t index,
                            struct word word, uint32_t count)
{
    if (k == 0 || count > 0 || index < 1)
        return false;
    warnings_add(
        p->report,
        k == 1 ? "corners without their texture vertex"
               : "corners without their normal",
        "%s:%" PRIu64
        ": found %s %s in a face, but none before it: face used without",
        p->path, p->lex.line, corner_names[k], word_cut(word).text);
    return true;
}

static bool report_malformed(const struct parser *p, struct word word)
{
    warnings_add(p->report, "malformed faces",
                 "%s:%" PRIu64
                 ": found %s in a face, expected v, v/vt, v//vn or "
                 "v/vt/vn: face dropped",
                 p->path, p->lex.line, word_quote(word).text);
    return false;
}

/* Reads v, v/vt, v//vn or v/vt/vn. A slash at the end is accepted. */
static bool parse_corner(const struct parser *p, struct word word,
                         struct corner *c)
{
    const uint32_t counts[] = {p->scene->position_count, p->scene->uv_count,
                               p->scene->normal_count};
    const char *at = word.start, *end = at + word.length;
    uint32_t indices[3] = {NO_INDEX, NO_INDEX, NO_INDEX};

    for (int k = 0; k < 3 && at <= end; k++) {
        const char *start = at;
        int64_t index;

        if (parse_index(&at, end, &index)) {
            struct word text = {start, (size_t)(at - start)};

            if (!resolve(index, counts[k], &indices[k]) &&
                !is_missing_list(p, k, index, text, counts[k]))
                return report_index(p, corner_names[k], text, counts[k]);
        } else if (k == 0 || at != start) {
            return report_malformed(p, word);
        }
        if (at == end)
            break;
        if (*at != '/' || k == 2)
            return report_malformed(p, word);
        at++;
    }
    *c = (struct corner){indices[0], indices[1], indices[2]};
    return true;
}

/* Reads the corners up to the end of the line. *is_good becomes false for a
 * face that was reported and has to be dropped. */
static bool read_corners(struct parser *p, bool *is_good)
{
    struct face_tris *f = &p->faces;

    *is_good = true;
    f->corner_count = 0;
    while (!lexer_at_line_end(&p->lex)) {
        uint32_t n = f->corner_count;
        struct corner *c;

        if (!face_tris_reserve(f, (size_t)n + 1))
            return no_memory_for_face(p);
        c = &f->corners[n];
        if (!parse_corner(p, lexer_word(&p->lex), c)) {
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

/* Reads the rest of an f statement and adds its triangles. A face with a bad
 * index is dropped and reported, like those that face_tris_add() drops. */
static bool read_face(struct parser *p)
{
    struct file_place place = {.line = p->lex.line};
    struct face_tris *f = &p->faces;
    bool is_good;

    if (f->face_count == NO_INDEX - 1)
        return fail(p->err, "%s:%" PRIu64 ": found more than 4294967294 faces",
                    p->path, place.line);
    if (!read_corners(p, &is_good))
        return false;
    if (is_good && !face_tris_add(f, p->object, p->material, place))
        return no_memory_for_face(p);
    f->face_count++;
    return true;
}

/* ---- vertices and groups ---- */

static bool out_of_memory(const struct parser *p)
{
    return fail(p->err, "%s:%" PRIu64 ": out of memory for the scene", p->path,
                p->lex.line);
}

/* Reads `least` to `most` numbers; values that are not given stay as they are.
 * The rest of the line is ignored. */
static bool read_numbers(struct parser *p, const char *key, int least, int most,
                         double *values)
{
    for (int i = 0; i < most; i++) {
        if (lexer_number(&p->lex, &values[i]))
            continue;
        if (i >= least && lexer_at_line_end(&p->lex))
            return true;
        return fail(p->err,
                    "%s:%" PRIu64 ": found %s after %s, expected a number",
                    p->path, p->lex.line, word_quote(lexer_word(&p->lex)).text,
                    key);
    }
    return true;
}

/* Makes room for one more element. Indices limit the count. */
static bool grow(struct parser *p, void **array, size_t *capacity,
                 uint32_t count, size_t size_bytes)
{
    if (count == NO_INDEX - 1)
        return fail(p->err,
                    "%s:%" PRIu64 ": found more than 4294967294 vertices",
                    p->path, p->lex.line);
    return grow_array(array, capacity, (size_t)count + 1, size_bytes) ||
           out_of_memory(p);
}

/* Reads what is behind the coordinates: a weight, which is ignored, a colour,
 * or both. */
static bool read_color(struct parser *p)
{
    double numbers[4];
    int count = 0;

    while (count < 4 && !lexer_at_line_end(&p->lex) &&
           lexer_number(&p->lex, &numbers[count]))
        count++;
    return count < 3 ||
           vertex_colors_put(p->scene, &p->color_capacity,
                             numbers + count - 3) ||
           out_of_memory(p);
}

static bool read_position(struct parser *p)
{
    struct scene *scene = p->scene;
    double xyz[3];
    void *array = scene->file_positions;

    if (!read_numbers(p, "v", 3, 3, xyz) ||
        !grow(p, &array, &p->capacities[OBJ_V], scene->position_count,
              sizeof xyz))
        return false;
    scene->file_positions = array;
    memcpy(scene->file_positions + 3 * (size_t)scene->position_count, xyz,
           sizeof xyz);
    scene->position_count++;
    p->has_infinite |= !isfinite(xyz[0] + xyz[1] + xyz[2]);
    return lexer_at_line_end(&p->lex) || read_color(p);
}

static bool read_normal(struct parser *p)
{
    struct scene *scene = p->scene;
    double xyz[3];
    void *array = scene->normals;

    if (!read_numbers(p, "vn", 3, 3, xyz) ||
        !grow(p, &array, &p->capacities[OBJ_VN], scene->normal_count,
              sizeof *scene->normals))
        return false;
    scene->normals = array;
    if (!vec3d_normalize(xyz))
        memset(xyz, 0, sizeof xyz); /* unusable */
    scene->normals[scene->normal_count++] =
        (struct vec3){(float)xyz[0], (float)xyz[1], (float)xyz[2]};
    return true;
}

static bool read_uv(struct parser *p)
{
    struct scene *scene = p->scene;
    double uv[2] = {0, 0};
    void *array = scene->uvs;

    if (!read_numbers(p, "vt", 1, 2, uv) ||
        !grow(p, &array, &p->capacities[OBJ_VT], scene->uv_count,
              sizeof *scene->uvs))
        return false;
    scene->uvs = array;
    scene->uvs[scene->uv_count].x = texture_coordinate(uv[0]);
    scene->uvs[scene->uv_count++].y = texture_coordinate(uv[1]);
    return true;
}

static bool read_object(struct parser *p, bool is_group)
{
    char *name;

    if (is_group && p->has_objects)
        return true;
    p->has_objects |= !is_group;
    name = lexer_rest(&p->lex);
    p->object = name == NULL ? NO_NAME : name_table_add(&p->objects, name);
    free(name);
    return p->object != NO_NAME || out_of_memory(p);
}

static bool read_usemtl(struct parser *p)
{
    uint64_t line = p->lex.line;
    char *name = lexer_rest(&p->lex);
    uint32_t known = p->materials.count;
    void *lines = p->material_lines;

    p->material = name == NULL ? NO_NAME : name_table_add(&p->materials, name);
    free(name);
    if (p->material == NO_NAME ||
        !grow_array(&lines, &p->material_line_capacity, p->materials.count,
                    sizeof *p->material_lines))
        return out_of_memory(p);
    p->material_lines = lines;
    if (p->material == known)
        p->material_lines[known] = line;
    return true;
}

static bool load_library(struct parser *p, const char *name, char *path)
{
    uint32_t known = p->libraries.count;
    uint32_t index = name_table_add(&p->libraries, path);
    struct error why, ignored;
    char *text;
    size_t size_bytes;
    bool ok;

    if (index == NO_NAME)
        return out_of_memory(p);
    if (index < known)
        return true;
    if (!file_read(path, &text, &size_bytes, &why)) {
        /* grey materials are no answer to a lack of memory */
        if (file_measure(path, &size_bytes, &ignored))
            return fail(p->err, "%s", why.text);
        warnings_add_named(p->report, "missing material files", name, "%s",
                           why.text);
        return true;
    }
    if (lexer_is_utf16(text, size_bytes)) {
        warnings_add_named(p->report, "material files in UTF-16", name,
                           "%s: found text in UTF-16, expected UTF-8: its "
                           "materials will be grey",
                           path);
        free(text);
        return true;
    }
    ok = mtl_parse(p->scene, text, size_bytes, path, p->report, p->err);
    free(text);
    return ok;
}

static bool load_library_named(struct parser *p, const char *name)
{
    size_t length = strlen(name);
    char *path;
    bool ok;

    if (length >= PATH_MAX) {
        warnings_add(p->report, "material files with names that are too long",
                     "%s:%" PRIu64 ": found a name of %zu bytes for mtllib, "
                     "expected fewer than %d: its materials will be grey",
                     p->path, p->lex.line, length, PATH_MAX);
        return true;
    }
    if (!asset_path_find(p->path, name, &path))
        return out_of_memory(p);
    if (path == NULL) {
        warnings_add_named(p->report, "missing material files", name,
                           "%s:%" PRIu64 ": found no file '%s' for mtllib: its "
                           "materials are missing",
                           p->path, p->lex.line, name);
        return true;
    }
    ok = load_library(p, name, path);
    free(path);
    return ok;
}

/* Returns the end of the first of several names: after the first .mtl, or at
 * the next blank if there is none. *has_endings becomes false then and saves
 * later searches. */
static char *first_name_end(char *names, bool *has_endings)
{
    char *p = names;

    while (*has_endings && (p = strcasestr(p, ".mtl")) != NULL) {
        p += strlen(".mtl");
        if (*p == ' ' || *p == '\t' || *p == '\0')
            return p;
    }
    *has_endings = false;
    return names + strcspn(names, " \t");
}

static bool load_libraries(struct parser *p, char *names)
{
    bool has_endings = true;

    for (char *name = names; *name != '\0';) {
        char *end = first_name_end(name, &has_endings);
        char *next = end + strspn(end, " \t");

        *end = '\0';
        if (!load_library_named(p, name))
            return false;
        name = next;
    }
    return true;
}

/* Reads mtllib with one name, which may contain blanks, or with several. */
static bool read_mtllib(struct parser *p)
{
    char *rest = lexer_rest(&p->lex);
    char *path;
    bool ok;

    if (rest == NULL || !asset_path_find(p->path, rest, &path)) {
        free(rest);
        return out_of_memory(p);
    }
    ok = path != NULL ? load_library(p, rest, path) : load_libraries(p, rest);
    free(path);
    free(rest);
    return ok;
}

/* ---- colours of ZBrush ---- */

static const char paint_key[] = "#MRGB";

/* Returns true at a comment in which ZBrush writes colours. */
static bool is_paint(const struct lexer *lex)
{
    size_t length = strlen(paint_key);

    return (size_t)(lex->end - lex->p) > length &&
           memcmp(lex->p, paint_key, length) == 0 &&
           lexer_is_blank(lex->p[length]);
}

/* Reads two hexadecimal digits. Returns -1 if they are none. */
static int hex_byte(const char *p)
{
    int value = 0;

    for (int i = 0; i < 2; i++) {
        int digit = p[i] >= '0' && p[i] <= '9' ? p[i] - '0'
                    : (p[i] | 32) >= 'a' && (p[i] | 32) <= 'f'
                        ? (p[i] | 32) - 'a' + 10
                        : -1;

        if (digit < 0)
            return -1;
        value = 16 * value + digit;
    }
    return value;
}

/* Reads MMRRGGBB for each of the next vertices, a mask and a colour, which go
 * on from one comment to the next. ZBrush writes them behind the vertices. */
static bool read_paint(struct parser *p)
{
    struct word word;

    p->lex.p += strlen(paint_key);
    lexer_skip_blanks(&p->lex);
    word = lexer_word(&p->lex);
    for (; word.length >= 8; word.start += 8, word.length -= 8) {
        double rgb[3];

        for (int k = 0; k < 3; k++)
            rgb[k] = hex_byte(word.start + 2 + 2 * k) / 255.0;
        if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0 ||
            p->painted_count == p->scene->position_count)
            break;
        if (!vertex_colors_set(p->scene, &p->color_capacity, p->painted_count++,
                               rgb))
            return out_of_memory(p);
    }
    if (word.length > 0)
        warnings_add(p->report, "colours that are not used",
                     "%s:%" PRIu64 ": found %s in %s, expected 8 hexadecimal "
                     "digits for each vertex before it: not used",
                     p->path, p->lex.line, word_quote(word).text, paint_key);
    return true;
}

/* ---- other statements ---- */

/* Returns true for statements of free-form curves and surfaces. */
static bool is_free_form(struct word key)
{
    static const char *const keys[] = {"cstype", "deg",  "bmat", "step", "curv",
                                       "curv2",  "surf", "parm", "trim", "hole",
                                       "scrv",   "sp",   "end",  "con",  "vp"};

    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (word_is(key, keys[i]))
            return true;
    }
    return false;
}

static bool skip_unknown(struct parser *p, struct word key)
{
    char name[64];
    int length = key.length < 40 ? (int)key.length : 40;

    if (is_free_form(key)) {
        warnings_add(p->report, "statements of free-form surfaces",
                     "%s:%" PRIu64 ": found '%.*s', a free-form curve or "
                     "surface, which glim does not draw",
                     p->path, p->lex.line, length, key.start);
        return true;
    }
    p->statement_count--;
    p->unknown_count++;
    snprintf(name, sizeof name, "%.*s", length, key.start);
    warnings_add_named(p->report, "unknown statements", name,
                       "%s:%" PRIu64 ": found '%s', which glim does not use",
                       p->path, p->lex.line, name);
    return true;
}

static bool read_statement(struct parser *p)
{
    struct word key = lexer_word(&p->lex);

    p->statement_count++;
    if (word_is(key, "v"))
        return read_position(p);
    if (word_is(key, "f"))
        return read_face(p);
    if (word_is(key, "vn"))
        return read_normal(p);
    if (word_is(key, "vt"))
        return read_uv(p);
    if (word_is(key, "o") || word_is(key, "g"))
        return read_object(p, *key.start == 'g');
    if (word_is(key, "usemtl"))
        return read_usemtl(p);
    if (word_is(key, "mtllib"))
        return read_mtllib(p);
    if (word_is(key, "s") || word_is(key, "l") || word_is(key, "p"))
        return true;
    return skip_unknown(p, key);
}

/* Name of the material of faces before the first usemtl without MTL files. */
#define NAMELESS "material"

static bool has_nameless_faces(const struct parser *p)
{
    for (uint32_t i = 0; i < p->scene->tri_count; i++)
        if (p->scene->tris[i].material == 0)
            return true;
    return false;
}

/* Gives a scene without MTL files grey materials that can be edited and saved:
 * those that its faces name. */
static bool add_own_materials(struct parser *p)
{
    char *text;
    size_t size_bytes;
    struct text_stream s;
    bool ok = text_stream_open(&s);

    for (uint32_t i = 1; ok && i < p->materials.count; i++)
        fprintf(s.to, "newmtl %s%s\n", p->materials.items[i],
                lexer_rest_guard(p->materials.items[i]));
    if (ok && has_nameless_faces(p))
        fputs("newmtl " NAMELESS "\n", s.to);
    text = text_stream_close(&s, &size_bytes);
    ok = text != NULL;
    if (!ok)
        out_of_memory(p);
    else if (size_bytes > 0)
        ok = mesh_mtl_begin(p->scene, text, p->report, p->err) &&
             mesh_mtl_read(p->scene, p->report, p->err);
    free(text);
    return ok;
}

/* Returns the material of faces before the first usemtl. In a file without
 * usemtl a single material of the MTL files is meant, as libassimp reads it. */
static uint32_t material_of_none(struct parser *p)
{
    const struct scene *scene = p->scene;
    uint32_t found = scene->material_count - 1;

    if (found == 0 || !has_nameless_faces(p))
        return 0;
    if (scene->has_own_mtl)
        return mtl_find(scene, NAMELESS);
    if (p->materials.count > 1)
        return 0;
    if (found == 1)
        warnings_add(p->report, "faces without usemtl",
                     "%s: found faces without usemtl, and one material: '%s' "
                     "is used",
                     p->path, scene->material_names[1]);
    else
        warnings_add(p->report, "faces without usemtl",
                     "%s: found faces without usemtl, and %" PRIu32
                     " materials: grey is used",
                     p->path, found);
    return found == 1;
}

/* True for a material of add_own_materials() that no file defines. */
static bool is_own_grey(const struct scene *scene, uint32_t material)
{
    const struct material_values none = material_values_empty();

    return scene->has_own_mtl &&
           material_values_equal(&scene->material_origins[material].source,
                                 &none);
}

/* Replaces the numbers of names in usemtl by those of materials. This is done
 * at the end because mtllib may come after usemtl. */
static bool resolve_materials(struct parser *p)
{
    struct scene *scene = p->scene;
    uint32_t *numbers = alloc_array(p->materials.count, sizeof *numbers);
    struct name_table known = {0};
    bool ok = numbers != NULL;

    for (uint32_t i = 0; ok && i < scene->material_count; i++)
        ok = name_table_add(&known, scene->material_names[i]) != NO_NAME;
    if (ok)
        numbers[0] = material_of_none(p);
    for (uint32_t i = 1; ok && i < p->materials.count; i++) {
        const char *name = p->materials.items[i];
        uint32_t found = name_table_find(&known, name);

        numbers[i] = found != NO_NAME ? found : 0;
        if (found != NO_NAME && !is_own_grey(scene, found))
            continue;
        warnings_add_named(p->report, "unknown materials", name,
                           "%s:%" PRIu64
                           ": found no material '%s': grey is used instead",
                           p->path, p->material_lines[i], name);
    }
    for (uint32_t i = 0; ok && i < scene->tri_count; i++)
        scene->tris[i].material = numbers[scene->tris[i].material];
    free(numbers);
    name_table_free(&known);
    return ok || out_of_memory(p);
}

static bool looks_binary(const char *text, size_t size_bytes)
{
    lexer_trim(&text, &size_bytes);
    return memchr(text, '\0',
                  size_bytes < BINARY_CHECK_BYTES ? size_bytes
                                                  : BINARY_CHECK_BYTES) != NULL;
}

/* ---- the lines ---- */

/* Parses lines up to the one that begins at `end` or behind it. */
static bool parse_to(struct parser *p, const char *end)
{
    for (; p->lex.p < end; lexer_next_line(&p->lex)) {
        bool ok = is_paint(&p->lex)
                      ? read_paint(p)
                      : lexer_at_line_end(&p->lex) || read_statement(p);

        if (!ok)
            return false;
    }
    return true;
}

/* Takes the run that the parser has come to, or leaves its lines to it. */
static bool take_run(struct parser *p, const struct obj_block *b,
                     const struct obj_run *run)
{
    bool has_faces = run[1].first_face > run->first_face;

    if (p->lex.p != run->begin || (p->has_infinite && has_faces) ||
        !obj_run_fits(run, &p->faces))
        return true;
    if (!obj_run_take(b, run, &p->faces, p->capacities,
                      (struct obj_run_place){p->object, p->material,
                                             p->lex.line}))
        return out_of_memory(p);
    p->lex.p = run->end;
    p->lex.line += run->line_count;
    p->statement_count += run->line_count;
    return true;
}

/* Parses the lines of blocks. */
static bool parse_blocks(void *context, const struct obj_blocks *blocks)
{
    struct parser *p = context;

    for (uint32_t i = 0; i < blocks->count; i++) {
        const struct obj_block *b = &blocks->items[i];

        for (uint32_t k = 0; k < b->run_count; k++)
            if (!parse_to(p, b->runs[k].begin) || !take_run(p, b, &b->runs[k]))
                return false;
    }
    return parse_to(p, blocks->end);
}

static bool parse_all(struct parser *p)
{
    struct pool *pool =
        scene_pool(p->scene, (uint32_t)((size_t)(p->lex.end - p->lex.p) /
                                        TRI_BYTES % NO_INDEX));
    bool ok;

    ok = obj_runs_read(p->lex.p, p->lex.end, pool, parse_blocks, p);
    pool_destroy(pool);
    return ok;
}

static bool parse_lines(struct parser *p)
{
    if (!parse_all(p))
        return false;
    if (p->statement_count == 0)
        return fail(p->err, "%s: not an OBJ file: found no OBJ statement",
                    p->path);
    /* any text may have a line that begins with an OBJ keyword */
    if (p->scene->position_count == 0 && p->unknown_count > p->statement_count)
        return fail(p->err,
                    "%s: not an OBJ file: found no vertex and %" PRIu64
                    " unknown statements",
                    p->path, p->unknown_count);
    if (!vertex_colors_finish(p->scene, &p->color_capacity))
        return out_of_memory(p);
    return (p->scene->mtl_path_count > 0 || add_own_materials(p)) &&
           resolve_materials(p);
}

static bool begin(struct parser *p)
{
    void *lines = NULL;

    if (p->scene->path == NULL)
        p->scene->path = strdup(p->path);
    if (p->scene->path == NULL)
        return out_of_memory(p);
    if (!mtl_add_default(p->scene, p->err))
        return false;
    if (name_table_add(&p->objects, "") == NO_NAME ||
        name_table_add(&p->materials, "") == NO_NAME ||
        !grow_array(&lines, &p->material_line_capacity, 1,
                    sizeof *p->material_lines))
        return out_of_memory(p);
    p->material_lines = lines;
    return true;
}

bool obj_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err)
{
    struct parser p = {
        .scene = scene,
        .path = path,
        .report = report,
        .err = err,
        .faces = {.scene = scene, .path = path, .report = report},
    };
    bool ok;

    if (lexer_is_utf16(text, size_bytes))
        return fail(err, "%s: found text in UTF-16, expected UTF-8", path);
    if (looks_binary(text, size_bytes))
        return fail(err,
                    "%s: not an OBJ file: found binary data, expected text",
                    path);
    lexer_init(&p.lex, text, size_bytes);
    ok = begin(&p) && parse_lines(&p);
    /* the scene owns the names of its objects now */
    scene->object_names = p.objects.items;
    scene->object_count = p.objects.count;
    p.objects.items = NULL;
    p.objects.count = 0;
    name_table_free(&p.objects);
    name_table_free(&p.materials);
    name_table_free(&p.libraries);
    face_tris_free(&p.faces);
    free(p.material_lines);
    return ok;
}
