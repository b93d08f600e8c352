// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "read/gltf/gltf_buffer.h"

/* Values of samplers. */
enum { FILTER_NEAREST = 9728, WRAP_CLAMP = 33071, WRAP_MIRROR = 33648 };

/* Greatest factor and offset of coordinates; beyond them a float has no texels
 * left. */
#define TRANSFORM_MAX 1e6

static bool out_of_memory(const struct gltf_textures *t, struct error *err)
{
    return fail(err, "%s: out of memory for the textures", t->document->path);
}

bool gltf_textures_begin(struct gltf_textures *t,
                         const struct gltf_document *document,
                         struct scene *scene, struct warnings *report,
                         struct error *err)
{
    size_t count = gltf_entry_count(document, "images");

    *t = (struct gltf_textures){
        .document = document,
        .scene = scene,
        .report = report,
        .paths = alloc_array(count, sizeof *t->paths),
        .is_tried = alloc_array(count, sizeof *t->is_tried),
        .view_paths = alloc_array(document->view_count, sizeof *t->view_paths),
        .image_count = count,
    };
    return (texture_table_init(&t->table, scene) && t->paths != NULL &&
            t->is_tried != NULL && t->view_paths != NULL) ||
           out_of_memory(t, err);
}

void gltf_textures_end(struct gltf_textures *t)
{
    for (size_t i = 0; t->paths != NULL && i < t->image_count; i++)
        free(t->paths[i]);
    free(t->paths);
    free(t->is_tried);
    free(t->view_paths);
    texture_table_free(&t->table);
}

/* ---- images ---- */

/* Lists bytes as an image of the scene. *data gives up what it owns. */
static bool add_image(struct gltf_textures *t, size_t image,
                      struct gltf_bytes *data, struct error *err)
{
    struct scene_image made = {.name = format_text("%s#image%zu",
                                                   t->document->path, image),
                               .size_bytes = data->size_bytes};
    size_t count = t->scene->image_count, capacity = count;
    void *images = t->scene->images;

    made.bytes = data->owned;
    if (made.bytes == NULL) {
        made.bytes = alloc_array(data->size_bytes + 1, 1);
        if (made.bytes != NULL)
            memcpy(made.bytes, data->bytes, data->size_bytes);
    }
    data->owned = NULL; /* the scene owns it now */
    t->paths[image] = made.name == NULL ? NULL : strdup(made.name);
    if (made.bytes == NULL || t->paths[image] == NULL ||
        !grow_array(&images, &capacity, count + 1, sizeof made)) {
        free(made.name);
        free(made.bytes);
        return out_of_memory(t, err);
    }
    t->scene->images = images;
    t->scene->images[t->scene->image_count++] = made;
    return true;
}

/* Lists a view as an image. Images of one view are one. */
static bool add_view(struct gltf_textures *t, const struct gltf_value *v,
                     size_t image, uint32_t view, struct error *err)
{
    struct gltf_bytes data = t->document->views[view].data;
    const char *path = t->view_paths[view];

    data.owned = NULL;
    if (path != NULL) {
        t->paths[image] = strdup(path);
        return t->paths[image] != NULL || out_of_memory(t, err);
    }
    if (!gltf_take(v, data.size_bytes, 1, "bytes of an image", err) ||
        !add_image(t, image, &data, err))
        return false;
    t->view_paths[view] = t->paths[image];
    return true;
}

/* Finds the file that a URI names. A missing one is a warning. */
static bool find_file(struct gltf_textures *t, const struct gltf_value *v,
                      const char *uri, size_t image)
{
    struct error why;

    if (!gltf_uri_find(v, uri, &t->paths[image], &why))
        warnings_add(t->report, "unusable textures",
                     "%s: the texture is not used", why.text);
    return true;
}

static bool read_image(struct gltf_textures *t, size_t image, struct error *err)
{
    struct gltf_bytes data = {NULL, 0, NULL};
    struct gltf_value v;
    const char *uri = NULL;
    uint32_t view;
    bool ok;

    if (!gltf_entry(t->document, "images", image, &v, err) ||
        !gltf_string(&v, "uri", &uri, err) ||
        !gltf_index(&v, "bufferView", "bufferViews", &view, err))
        return false;
    if (uri != NULL && !gltf_uri_is_data(uri))
        return find_file(t, &v, uri, image);
    if (uri == NULL && view == NO_INDEX)
        return gltf_fail(&v, err,
                         "found an image without data, expected a uri or a "
                         "bufferView");
    if (uri == NULL)
        return add_view(t, &v, image, view, err);
    ok = gltf_uri_read(&v, uri, &data, err) && add_image(t, image, &data, err);
    free(data.owned);
    return ok;
}

/* ---- samplers and transforms ---- */

static bool read_sampler(const struct gltf_value *texture, uint32_t *flags,
                         struct error *err)
{
    uint64_t filter = 0, wrap_s = 0, wrap_t = 0;
    struct gltf_value v;
    uint32_t sampler;

    if (!gltf_index(texture, "sampler", "samplers", &sampler, err))
        return false;
    if (sampler == NO_INDEX)
        return true;
    if (!gltf_entry(texture->document, "samplers", sampler, &v, err) ||
        !gltf_integer(&v, "magFilter", UINT32_MAX, &filter, err) ||
        !gltf_integer(&v, "wrapS", UINT32_MAX, &wrap_s, err) ||
        !gltf_integer(&v, "wrapT", UINT32_MAX, &wrap_t, err))
        return false;
    *flags |= filter == FILTER_NEAREST ? TEXTURE_NEAREST : 0;
    *flags |= wrap_s == WRAP_CLAMP    ? TEXTURE_CLAMP_U
              : wrap_s == WRAP_MIRROR ? TEXTURE_MIRROR_U
                                      : 0;
    *flags |= wrap_t == WRAP_CLAMP    ? TEXTURE_CLAMP_V
              : wrap_t == WRAP_MIRROR ? TEXTURE_MIRROR_V
                                      : 0;
    return true;
}

static bool expect_small(const struct gltf_value *v, const double numbers[2],
                         struct error *err)
{
    return (fabs(numbers[0]) <= TRANSFORM_MAX &&
            fabs(numbers[1]) <= TRANSFORM_MAX) ||
           gltf_fail(v, err, "found %g %g, expected numbers up to %g",
                     numbers[0], numbers[1], TRANSFORM_MAX);
}

/* Reads KHR_texture_transform. It scales coordinates, turns them by
 * u' = c u + s v, v' = c v - s u, and moves them. There v is 0 at the top: with
 * 1 - v for v this is a turn to the left, and the offset changes. */
static bool read_transform(const struct gltf_value *info, struct texture *t,
                           double *angle_deg, uint64_t *set, struct error *err)
{
    double scale[2] = {1, 1}, offset[2] = {0, 0}, angle = 0;
    struct gltf_value v;

    if (!gltf_extension(info, "KHR_texture_transform", &v, err))
        return false;
    if (v.json == NULL)
        return true;
    if (!gltf_numbers(&v, "scale", 2, scale, err) ||
        !gltf_numbers(&v, "offset", 2, offset, err) ||
        !gltf_number(&v, "rotation", -TRANSFORM_MAX, TRANSFORM_MAX, &angle,
                     err) ||
        !gltf_integer(&v, "texCoord", UINT32_MAX, set, err) ||
        !expect_small(&v, scale, err) || !expect_small(&v, offset, err))
        return false;
    t->scale = (struct vec2){(float)scale[0], (float)scale[1]};
    t->offset = (struct vec2){(float)(offset[0] + sin(angle) * scale[1]),
                              (float)(1 - cos(angle) * scale[1] - offset[1])};
    *angle_deg = angle * (180 / M_PI);
    return true;
}

/* ---- textures ---- */

/* Finds the image of a texture that glim can read; NO_INDEX if there is
 * none. */
static bool find_image(const struct gltf_value *texture, uint32_t *image,
                       struct error *err)
{
    struct gltf_value webp;

    *image = NO_INDEX;
    if (!gltf_extension(texture, "EXT_texture_webp", &webp, err) ||
        !gltf_index(texture, "source", "images", image, err))
        return false;
    return *image != NO_INDEX || webp.json == NULL ||
           gltf_index(&webp, "source", "images", image, err);
}

/* Returns true if an extension has the only image of a texture. */
static bool is_only_basisu(const json_t *texture)
{
    const json_t *extensions = json_object_get(texture, "extensions");

    return json_object_get(extensions, GLTF_BASISU) != NULL &&
           json_object_get(texture, "source") == NULL &&
           json_object_get(extensions, "EXT_texture_webp") == NULL;
}

bool gltf_textures_are_readable(const struct gltf_document *document)
{
    const json_t *texture;
    size_t i;

    json_array_foreach (json_object_get(document->root, "textures"), i,
                        texture) {
        if (is_only_basisu(texture))
            return false;
    }
    return true;
}

/* Reads an entry of "textures" and its image. *path is NULL if there is none
 * that can be read. */
static bool read_entry(struct gltf_textures *t, uint32_t index,
                       struct texture *to, const char **path, struct error *err)
{
    struct gltf_value v;
    uint32_t image;

    *path = NULL;
    if (!gltf_entry(t->document, "textures", index, &v, err) ||
        !read_sampler(&v, &to->flags, err) || !find_image(&v, &image, err))
        return false;
    if (image == NO_INDEX) {
        warnings_add(t->report, "unusable textures",
                     "%s: /textures/%u: found no image that glim reads%s: the "
                     "texture is not used",
                     t->document->path, index,
                     is_only_basisu(v.json) ? ", expected " GLTF_BASISU_EXPECTED
                                            : "");
        return true;
    }
    if (!t->is_tried[image]) {
        t->is_tried[image] = true;
        if (!read_image(t, image, err))
            return false;
    }
    *path = t->paths[image];
    return true;
}

bool gltf_texture_read(struct gltf_textures *t, const struct gltf_value *object,
                       struct gltf_texture_use use, uint32_t *texture,
                       struct gltf_value *info, struct error *err)
{
    struct texture to = texture_default();
    struct texture_origin origin = {.file = NO_INDEX};
    uint64_t set = 0;
    const char *path;
    uint32_t index;

    *texture = NO_INDEX;
    if (!gltf_object(object, use.key, info, err))
        return false;
    if (info->json == NULL)
        return true;
    if (!gltf_index(info, "index", "textures", &index, err) ||
        !gltf_integer(info, "texCoord", UINT32_MAX, &set, err) ||
        !read_transform(info, &to, &origin.rotation_deg, &set, err))
        return false;
    if (index == NO_INDEX)
        return gltf_fail(info, err,
                         "found no index, expected the number of a texture");
    to.flags = use.flags;
    to.is_data = use.is_data;
    to.channel = use.channel;
    if (!read_entry(t, index, &to, &path, err))
        return false;
    if (path == NULL)
        return true;
    if (set > 1)
        warnings_add(t->report, "texture coordinates beyond the second",
                     "%s: found a texture of TEXCOORD_%u, expected 0 or 1: "
                     "looked up by the first",
                     t->document->path, (unsigned)set);
    to.flags |= set == 1 ? TEXTURE_SECOND_UVS : 0;
    texture_rotate(&to, origin.rotation_deg);
    *texture = texture_table_add(&t->table, path, &to, &origin);
    return *texture != NO_INDEX || out_of_memory(t, err);
}
