// SPDX-License-Identifier: MIT
#include "read/mesh_finish.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text_stream.h"
#include "read/crease_normals.h"
#include "read/mtl.h"

/* Most copies of a vertex that are searched for one of a colour: the corners at
 * the hub of a fan may have any number of colours. */
#define COPIES_MAX 16

/* Warm grey with a mean of 0.6, as modelling clay; white surfaces wash out and
 * grey ones look like concrete. */
static const struct vec3 clay = {0.66f, 0.6f, 0.54f};

static bool out_of_memory(const struct scene *scene, struct error *err)
{
    return fail(err, "%s: out of memory for the scene", scene->path);
}

bool mesh_begin(struct scene *scene, const char *path, struct error *err)
{
    scene->path = strdup(path);
    scene->object_names = alloc_array(1, sizeof *scene->object_names);
    if (scene->object_names != NULL)
        scene->object_names[0] = strdup("");
    if (scene->path == NULL || scene->object_names == NULL ||
        scene->object_names[0] == NULL)
        return fail(err, "%s: out of memory for the scene", path);
    scene->object_count = 1;
    scene->is_model = true;
    return true;
}

struct vec3 mesh_clay(void)
{
    return clay;
}

/* ---- colours of faces ---- */

/* Vertices while they are doubled: each begins a list of its copies. */
struct copies {
    struct scene *scene;
    uint32_t *next; /* NO_INDEX after the last copy */
    bool *is_used;  /* the vertex has a colour */
    size_t next_capacity, used_capacity, position_capacity, color_capacity;
};

static bool grow(struct copies *c, size_t needed)
{
    struct scene *s = c->scene;
    void *next = c->next, *used = c->is_used;
    void *positions = s->file_positions, *colors = s->colors;

    if (!grow_array(&next, &c->next_capacity, needed, sizeof *c->next))
        return false;
    c->next = next;
    if (!grow_array(&used, &c->used_capacity, needed, sizeof *c->is_used))
        return false;
    c->is_used = used;
    if (!grow_array(&positions, &c->position_capacity, needed,
                    3 * sizeof *s->file_positions))
        return false;
    s->file_positions = positions;
    if (!grow_array(&colors, &c->color_capacity, needed, sizeof *s->colors))
        return false;
    s->colors = colors;
    return true;
}

static bool is_same_color(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Replaces *v by its copy of this colour, which is added if there is none. */
static bool color_vertex(struct copies *c, uint32_t *v, struct vec3 color)
{
    struct scene *s = c->scene;
    uint32_t last = *v, n = s->position_count;

    if (!c->is_used[*v]) {
        c->is_used[*v] = true;
        s->colors[*v] = color;
    }
    for (int i = 0; i < COPIES_MAX; i++, last = c->next[last]) {
        if (is_same_color(s->colors[last], color)) {
            *v = last;
            return true;
        }
        if (c->next[last] == NO_INDEX)
            break;
    }
    if (n == NO_INDEX - 1 || !grow(c, (size_t)n + 1))
        return false;
    memcpy(s->file_positions + 3 * (size_t)n,
           s->file_positions + 3 * (size_t)*v, 3 * sizeof(double));
    s->colors[n] = color;
    c->is_used[n] = true;
    c->next[n] = c->next[*v];
    c->next[*v] = n;
    *v = n;
    s->position_count++;
    return true;
}

static bool color_faces(struct scene *s, const struct vec3 *face_colors)
{
    struct copies c = {.scene = s};
    bool ok;

    /* an array without room beyond its items is grown by copying */
    c.position_capacity = s->position_count;
    ok = grow(&c, (size_t)s->position_count + 1);
    for (uint32_t i = 0; ok && i < s->position_count; i++) {
        c.next[i] = NO_INDEX;
        c.is_used[i] = false;
        s->colors[i] = clay;
    }
    for (uint32_t i = 0; ok && i < s->tri_count; i++)
        for (int k = 0; ok && k < 3; k++)
            ok = color_vertex(&c, &s->tris[i].v[k],
                              face_colors[s->tri_faces[i]]);
    s->color_count = ok ? s->position_count : 0;
    free(c.next);
    free(c.is_used);
    return ok;
}

/* ---- the material ---- */

/* Returns the path of the MTL file beside the scene, for free(); NULL when
 * memory is out. */
static char *material_path(const char *path)
{
    size_t length = strlen(path);

    if (length > 3 && strcasecmp(path + length - 3, ".gz") == 0)
        length -= 3;
    return format_text("%.*s.mtl", (int)length, path);
}

/* Writes the name of an image. */
static void write_image(FILE *to, struct word name, const char *stem)
{
    static const char mark[] = "<this>";
    const char *p = name.start, *end = p + name.length, *found;

    while ((found = memmem(p, (size_t)(end - p), mark, strlen(mark))) != NULL) {
        fprintf(to, "%.*s%s", (int)(found - p), p, stem);
        p = found + strlen(mark);
    }
    fprintf(to, "%.*s\n", (int)(end - p), p);
}

/* Writes clay, or white if colours multiply it. */
static void write_clay(FILE *to, bool is_white)
{
    fprintf(to, "Kd %g %g %g\nKd_roughness 0.5\n",
            is_white ? 1.0 : (double)clay.x, is_white ? 1.0 : (double)clay.y,
            is_white ? 1.0 : (double)clay.z);
}

static void write_materials(FILE *to, const struct scene *s,
                            const struct mesh_textures *t, const char *stem)
{
    bool has_colors = s->color_count > 0;

    for (uint32_t i = 0; i < t->count; i++) {
        if (i == 0)
            fputs("newmtl clay\n", to);
        else
            fprintf(to, "newmtl clay-%" PRIu32 "\n", i + 1);
        write_clay(to, has_colors || t->names[i].length > 0);
        if (t->names[i].length == 0)
            continue;
        fputs("map_Kd ", to);
        write_image(to, t->names[i], stem);
    }
    if (t->count == 0 || t->has_plain) {
        fprintf(to, "newmtl clay%s\n", t->count == 0 ? "" : "-plain");
        write_clay(to, has_colors);
    }
}

/* Returns the text that defines the materials, for free(). */
static char *clay_text(const struct scene *s, const struct mesh_textures *t)
{
    char *stem = path_stem_of_input(path_name(s->path));
    char *text = NULL;
    size_t size_bytes;
    struct text_stream stream;

    if (stem != NULL && text_stream_open(&stream)) {
        write_materials(stream.to, s, t, stem);
        text = text_stream_close(&stream, &size_bytes);
    }
    free(stem);
    return text;
}

bool mesh_mtl_begin(struct scene *scene, const char *text,
                    struct warnings *report, struct error *err)
{
    char *path = material_path(scene->path);
    bool ok;

    scene->has_own_mtl = true;
    ok = path != NULL ? mtl_parse(scene, text, strlen(text), path, report, err)
                      : out_of_memory(scene, err);
    free(path);
    return ok;
}

bool mesh_mtl_read(struct scene *scene, struct warnings *report,
                   struct error *err)
{
    const char *path = scene->mtl_paths[0];
    char *text;
    size_t size_bytes;
    bool ok;

    if (strcmp(scene->path, "-") == 0 || access(path, F_OK) != 0)
        return true;
    if (!file_read(path, &text, &size_bytes, err))
        return false;
    ok = mtl_parse(scene, text, size_bytes, path, report, err);
    free(text);
    return ok;
}

static bool add_clay(struct scene *scene, const struct mesh_textures *textures,
                     struct warnings *report, struct error *err)
{
    char *text = clay_text(scene, textures);
    bool ok = text != NULL ? mesh_mtl_begin(scene, text, report, err) &&
                                 mesh_mtl_read(scene, report, err)
                           : out_of_memory(scene, err);

    free(text);
    return ok;
}

bool mesh_add_normals(struct scene *scene, struct error *err)
{
    struct pool *pool;
    bool ok;

    if (scene->normal_count > 0)
        return true;
    pool = scene_pool(scene, scene->tri_count);
    ok = crease_normals(scene, pool) || out_of_memory(scene, err);
    pool_destroy(pool);
    return ok;
}

bool mesh_finish(struct scene *scene, const struct vec3 *face_colors,
                 const struct mesh_textures *textures, struct warnings *report,
                 struct error *err)
{
    if (!mesh_add_normals(scene, err))
        return false;
    if (face_colors != NULL && !color_faces(scene, face_colors))
        return out_of_memory(scene, err);
    return add_clay(scene, textures, report, err);
}
