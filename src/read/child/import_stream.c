// SPDX-License-Identifier: MIT
#include "read/child/import_stream.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "base/print.h"
#include "read/face_tris.h"
#include "read/mesh_finish.h"
#include "read/scene_lists.h"
#include "kernels/vec.h"

struct stream {
    struct scene *scene;
    const char *path;
    struct error *err;
    struct import_head head;
    const char *p;
    size_t left_bytes;
};

static bool out_of_memory(const struct stream *s)
{
    return fail(s->err, "%s: out of memory for the scene", s->path);
}

static bool fail_stream(const struct stream *s, const char *what)
{
    return fail(s->err, "%s: found %s in what libassimp read", s->path, what);
}

static bool take(struct stream *s, void *to, uint64_t size_bytes)
{
    if (size_bytes > s->left_bytes)
        return fail_stream(s, "no end");
    memcpy(to, s->p, size_bytes);
    s->p += size_bytes;
    s->left_bytes -= size_bytes;
    return true;
}

/* Allocates an array and fills it from the stream, whose rest bounds its
 * size. */
static bool take_array(struct stream *s, void *array, uint64_t count,
                       size_t item_bytes)
{
    void *items;

    if (count > s->left_bytes / item_bytes)
        return fail_stream(s, "no end");
    items = alloc_array(count, item_bytes);
    if (items == NULL)
        return out_of_memory(s);
    memcpy(array, &items, sizeof items);
    return take(s, items, count * item_bytes);
}

static void clean_normals(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->normal_count; i++) {
        struct vec3 *n = &scene->normals[i];
        double v[3] = {(double)n->x, (double)n->y, (double)n->z};

        if (!vec3d_normalize(v))
            v[0] = v[1] = v[2] = 0;
        *n = v3((float)v[0], (float)v[1], (float)v[2]);
    }
}

static bool take_colors(struct stream *s)
{
    struct scene *scene = s->scene;
    uint32_t count = s->head.vertex_count;

    if (!take_array(s, &scene->colors, count, sizeof *scene->colors))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 *c = &scene->colors[i];
        const double rgb[3] = {(double)c->x, (double)c->y, (double)c->z};

        *c = vertex_color_encoded(rgb);
    }
    vertex_colors_decode(scene->colors, count, 1);
    scene->color_count = count;
    return true;
}

static bool take_vertices(struct stream *s)
{
    struct scene *scene = s->scene;
    uint32_t count = s->head.vertex_count;

    if (!take_array(s, &scene->file_positions, count, 3 * sizeof(double)))
        return false;
    scene->position_count = count;
    if ((s->head.flags & IMPORT_HAS_NORMALS) != 0) {
        if (!take_array(s, &scene->normals, count, sizeof *scene->normals))
            return false;
        scene->normal_count = count;
        clean_normals(scene);
    }
    if ((s->head.flags & IMPORT_HAS_UVS) != 0) {
        if (!take_array(s, &scene->uvs, count, sizeof *scene->uvs))
            return false;
        scene->uv_count = count;
        for (uint32_t i = 0; i < count; i++)
            scene->uvs[i] =
                (struct vec2){texture_coordinate((double)scene->uvs[i].x),
                              texture_coordinate((double)scene->uvs[i].y)};
    }
    return (s->head.flags & IMPORT_HAS_COLORS) == 0 || take_colors(s);
}

/* Fills triangle i of the scene. Material 0 and object 0 are the scene's
 * own. */
static void put_tri(struct scene *scene, uint32_t i, const struct import_tri *t)
{
    struct tri *to = &scene->tris[i];

    for (int k = 0; k < 3; k++) {
        to->v[k] = t->v[k];
        to->vn[k] = scene->normal_count > 0 ? t->v[k] : NO_INDEX;
        to->vt[k] = scene->uv_count > 0 ? t->v[k] : NO_INDEX;
    }
    to->material = t->material + 1;
    scene->tri_objects[i] = t->object + 1;
    scene->tri_faces[i] = i;
}

static bool take_tris(struct stream *s)
{
    struct scene *scene = s->scene;
    uint32_t count = s->head.tri_count;

    if (count > s->left_bytes / sizeof(struct import_tri))
        return fail_stream(s, "no end");
    scene->tris = alloc_array(count, sizeof *scene->tris);
    scene->tri_faces = alloc_array(count, sizeof *scene->tri_faces);
    scene->tri_objects = alloc_array(count, sizeof *scene->tri_objects);
    if (scene->tris == NULL || scene->tri_faces == NULL ||
        scene->tri_objects == NULL)
        return out_of_memory(s);
    for (uint32_t i = 0; i < count; i++) {
        struct import_tri t;

        take(s, &t, sizeof t);
        for (int k = 0; k < 3; k++)
            if (t.v[k] >= s->head.vertex_count)
                return fail_stream(s, "a triangle without its vertices");
        if (t.material >= s->head.material_count ||
            t.object >= s->head.object_count)
            return fail_stream(s, "a triangle without material or object");
        put_tri(scene, i, &t);
    }
    scene->tri_count = count;
    return true;
}

static bool take_names(struct stream *s)
{
    struct scene *scene = s->scene;
    uint32_t count = s->head.object_count;
    const char *name = s->p;
    uint64_t left = s->head.name_bytes;
    char **names;

    if (left > s->left_bytes || count > left || count == NO_INDEX)
        return fail_stream(s, "no end");
    names = realloc(scene->object_names, (count + 1ull) * sizeof *names);
    if (names == NULL)
        return out_of_memory(s);
    scene->object_names = names;
    for (uint32_t i = 0; i < count; i++) {
        size_t length = strnlen(name, left);

        if (length == left)
            return fail_stream(s, "no end");
        scene->object_names[scene->object_count] = strdup(name);
        if (scene->object_names[scene->object_count] == NULL)
            return out_of_memory(s);
        scene->object_count++;
        name += length + 1;
        left -= length + 1;
    }
    s->p += s->head.name_bytes;
    s->left_bytes -= s->head.name_bytes;
    return true;
}

static bool are_finite(const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return false;
    return true;
}

/* Adds a camera; leaves out one that sees nothing. */
static bool add_camera(struct scene *scene, const struct import_camera *c)
{
    struct scene_camera to = {.pose = {.fovy_deg = angle_deg(c->yfov)}};
    struct error ignored;

    for (int i = 0; i < 3; i++) {
        to.pose.eye[i] = c->eye[i];
        to.pose.at[i] = c->eye[i] + c->forward[i];
        to.pose.up[i] = c->up[i];
    }
    if (!pose_check(&to.pose, "", &ignored))
        return true;
    to.name = strdup(c->name);
    if (to.name == NULL)
        return false;
    scene->cameras[scene->camera_count++] = to;
    return true;
}

static bool take_cameras(struct stream *s)
{
    uint32_t count = s->head.camera_count;
    struct import_camera c;

    if (count > s->left_bytes / sizeof c)
        return fail_stream(s, "no end");
    s->scene->cameras = alloc_array(count, sizeof *s->scene->cameras);
    if (s->scene->cameras == NULL)
        return out_of_memory(s);
    for (uint32_t i = 0; i < count; i++) {
        take(s, &c, sizeof c);
        c.name[sizeof c.name - 1] = '\0';
        if (!add_camera(s->scene, &c))
            return out_of_memory(s);
    }
    return true;
}

static double angle_of_cone(double angle)
{
    return fmin(fmax(angle_deg(angle), 0), 90);
}

/* Adds a lamp; leaves out one that gives no light. */
static bool add_lamp(struct scene *scene, const struct import_lamp *from)
{
    struct lamp lamp;
    double back[3];

    if (!are_finite(from->position, 3) || !are_finite(from->forward, 3) ||
        !are_finite(from->rgb, 3) || !are_finite(&from->inner, 1) ||
        !are_finite(&from->outer, 1))
        return true;
    lamp_init(&lamp, (enum lamp_kind)from->kind);
    for (int i = 0; i < 3; i++) {
        lamp.position[i] = from->position[i];
        lamp.at[i] = from->position[i] + from->forward[i];
        lamp.rgb[i] = fmin(fmax(from->rgb[i], 0), FLT_MAX);
        back[i] = -from->forward[i];
    }
    if (from->kind == LAMP_SPOT) {
        lamp.outer_deg = angle_of_cone(from->outer);
        lamp.inner_deg = fmin(angle_of_cone(from->inner), lamp.outer_deg);
    }
    if (vec3d_dot(back, back) > 0)
        lamp_set_direction(&lamp, back);
    else if (from->kind != LAMP_POINT)
        return true;
    return lamps_add(&scene->lamps, &lamp);
}

static bool take_lamps(struct stream *s)
{
    struct import_lamp lamp;

    for (uint32_t i = 0; i < s->head.lamp_count; i++) {
        if (!take(s, &lamp, sizeof lamp))
            return false;
        if (lamp.kind >= LAMP_KINDS)
            return fail_stream(s, "a light of no kind");
        if (!add_lamp(s->scene, &lamp))
            return out_of_memory(s);
    }
    return true;
}

static bool take_images(struct stream *s)
{
    uint32_t count = s->head.image_count;
    struct scene *scene = s->scene;
    uint64_t size_bytes = 0;

    if (count > s->left_bytes / sizeof size_bytes)
        return fail_stream(s, "no end");
    scene->images = alloc_array(count, sizeof *scene->images);
    if (scene->images == NULL)
        return out_of_memory(s);
    for (uint32_t i = 0; i < count; i++) {
        struct scene_image *image = &scene->images[i];

        scene->image_count++;
        if (!take(s, &size_bytes, sizeof size_bytes) ||
            !take_array(s, &image->bytes, size_bytes, 1))
            return false;
        image->size_bytes = size_bytes;
        image->name = format_text("%s#image%u", s->path, i);
        if (image->name == NULL)
            return out_of_memory(s);
    }
    return true;
}

static bool take_materials(struct stream *s, struct warnings *report)
{
    uint64_t length = s->head.material_bytes;
    char *text;
    bool ok;

    if (length != s->left_bytes)
        return fail_stream(s, "another end");
    text = format_text("%.*s", length > INT_MAX ? INT_MAX : (int)length, s->p);
    if (text == NULL)
        return out_of_memory(s);
    ok = mesh_mtl_begin(s->scene, text, report, s->err) &&
         (s->scene->material_count == s->head.material_count + 1 ||
          fail_stream(s, "other materials")) &&
         mesh_mtl_read(s->scene, report, s->err);
    free(text);
    return ok;
}

bool import_stream_read(struct scene *scene, const char *bytes,
                        size_t size_bytes, const char *path,
                        struct warnings *report, struct error *err)
{
    struct stream s = {.scene = scene,
                       .path = path,
                       .err = err,
                       .p = bytes,
                       .left_bytes = size_bytes};

    if (!mesh_begin(scene, path, err) || !take(&s, &s.head, sizeof s.head))
        return false;
    if (memcmp(s.head.magic, IMPORT_MAGIC, sizeof s.head.magic) != 0)
        return fail_stream(&s, "another version");
    if (s.head.vertex_count == 0)
        return fail_stream(&s, "no vertices");
    if (s.head.skipped_count > 0)
        warnings_add(report, "lights of other kinds",
                     "%s: found %u light%s of no place, or of an area, whose "
                     "size is not in the file or not read by libassimp: left "
                     "out",
                     path, s.head.skipped_count,
                     print_plural(s.head.skipped_count));
    if (s.head.clamped_count > 0)
        warnings_add(report, "roughness out of range",
                     "%s: found %u material%s whose roughness libassimp "
                     "computes, expected 0 to 1: as wide as its highlight",
                     path, s.head.clamped_count,
                     print_plural(s.head.clamped_count));
    return take_vertices(&s) && take_tris(&s) && take_names(&s) &&
           take_cameras(&s) && take_lamps(&s) && take_images(&s) &&
           mesh_add_normals(scene, err) && take_materials(&s, report);
}
