// SPDX-License-Identifier: MIT
#include "world/textures.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/thread_pool.h"
#include "image/image_read.h"
#include "scene/material.h"
#include "kernels/texture.h"

/* Limit of all texels together, since texture.first has 32 bits. */
#define TEXELS_MAX UINT64_C(0xffffffff)

static bool has_alpha(const struct image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height;

    for (size_t i = 0; i < count; i++) {
        if (image->rgba[4 * i + 3] < 255)
            return true;
    }
    return false;
}

/* What the fourth byte of a texel is. Opacity is often stored in the alpha
 * channel of a white or coloured picture; other numbers are grey. */
enum fourth { FOURTH_ALPHA, FOURTH_GREY, FOURTH_OPACITY };

static enum fourth fourth_of(const struct scene *scene, uint32_t texture)
{
    const struct texture *t = &scene->textures[texture];

    if (t->channel == CHANNEL_GREY)
        return FOURTH_GREY;
    if (t->is_data == 0 || t->channel != CHANNEL_DEFAULT)
        return FOURTH_ALPHA;
    return scene->texture_origins[texture].is_opacity ? FOURTH_OPACITY
                                                      : FOURTH_GREY;
}

/* Returns true if two textures have the same texels. */
static bool is_same_image(const struct scene *scene, uint32_t a, uint32_t b)
{
    return scene->texture_origins[a].image == scene->texture_origins[b].image &&
           fourth_of(scene, a) == fourth_of(scene, b);
}

/* Returns the fourth byte of a texel: alpha or the mean of the channels. */
static uint32_t number_of(const uint8_t *texel, bool by_alpha)
{
    if (by_alpha)
        return texel[3];
    return ((uint32_t)texel[0] + texel[1] + texel[2] + 1) / 3;
}

/* Finds out whether numbers of the texels in the world are below 1. */
static void find_alpha(const struct host_world *host, struct texture *t)
{
    const uint32_t *texels = host->texels + t->first;
    size_t count = (size_t)t->width * t->height;
    uint32_t mask = UINT32_C(255) << texture_shift(*t);
    uint32_t least = mask;

    for (size_t i = 0; i < count; i++)
        least &= texels[i];
    t->has_alpha = (t->flags & TEXTURE_OPAQUE) == 0 && least != mask;
}

static bool append(struct host_world *host, const struct image *image,
                   const struct scene *scene, uint32_t index, struct error *err)
{
    struct texture *texture = &host->textures[index];
    enum fourth fourth = fourth_of(scene, index);
    size_t count = (size_t)image->width * (size_t)image->height;
    size_t total = host->texel_count + count;
    bool by_alpha = fourth == FOURTH_ALPHA ||
                    (fourth == FOURTH_OPACITY && has_alpha(image));
    uint32_t *texels;

    texels = total > SIZE_MAX / sizeof *texels
                 ? NULL
                 : realloc(host->texels, total * sizeof *texels);
    if (texels == NULL)
        return fail(err, "%s: out of memory for the textures: %zu MB",
                    scene->path, total * sizeof *texels >> 20);
    host->texels = texels;
    texels += host->texel_count;
    texture->first = (uint32_t)host->texel_count;
    texture->width = (uint32_t)image->width;
    texture->height = (uint32_t)image->height;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = image->rgba + 4 * i;
        uint32_t alpha = number_of(p, by_alpha);

        texels[i] = (uint32_t)p[0] | (uint32_t)p[1] << 8 |
                    (uint32_t)p[2] << 16 | alpha << 24;
    }
    host->texel_count = total;
    find_alpha(host, texture);
    world_renew(host, WORLD_TEXELS);
    return true;
}

/* Uses the texels of an earlier texture of the same file, which differs only in
 * options. Returns false if there is none. */
static bool shares_texels(struct host_world *host, const struct scene *scene,
                          uint32_t index)
{
    struct texture *t = &host->textures[index];

    for (uint32_t i = 0; i < host->texture_count; i++) {
        const struct texture *other = &host->textures[i];

        if (other->width == 0 || !is_same_image(scene, i, index))
            continue;
        t->first = other->first;
        t->width = other->width;
        t->height = other->height;
        t->has_alpha = other->has_alpha;
        if (t->channel != other->channel || t->flags != other->flags)
            find_alpha(host, t);
        return true;
    }
    return false;
}

/* State of reading the image of one texture. */
struct reading {
    uint32_t texture;
    const char *path;
    const struct reading *original; /* an earlier reading of the same texels */
    struct image_file file;
    bool is_open, is_decoded;
    struct image image;
    struct error error; /* reason if the image could not be read */
};

static struct reading reading_of(const struct scene *scene, uint32_t texture)
{
    return (struct reading){.texture = texture,
                            .path = scene->texture_paths[texture]};
}

uint64_t textures_bytes(const struct host_world *host)
{
    uint64_t sky_pixels =
        (uint64_t)host->sky_width * (uint64_t)host->sky_height;

    return host->texel_count * sizeof *host->texels +
           sky_pixels * (sizeof *host->sky_texels + sizeof(float));
}

/* Opens the image, which is a file or a part of the scene's file. */
static void open_image(const struct scene *scene, struct reading *r,
                       uint64_t held_bytes)
{
    for (size_t i = 0; i < scene->image_count; i++)
        if (strcmp(scene->images[i].name, r->path) == 0) {
            r->is_open = image_open_bytes(
                &r->file,
                &(struct file_bytes){r->path, scene->images[i].bytes,
                                     scene->images[i].size_bytes},
                IMAGE_8BIT, held_bytes, &r->error);
            return;
        }
    r->is_open =
        image_open(&r->file, r->path, IMAGE_8BIT, held_bytes, &r->error);
}

static void decode_image(void *context, uint32_t item, int worker)
{
    struct reading *r = (struct reading *)context + item;
    uint64_t ignored;

    (void)worker;
    if (r->is_open)
        r->is_decoded = image_decode(&r->file, &r->image, &ignored, &r->error);
}

/* Writes the place of the first statement of a texture and a colon: the scene's
 * file if a reader made the statement, and nothing for an image whose name has
 * its place. */
static void write_place(struct error *place, const struct scene *scene,
                        uint32_t texture)
{
    struct texture_origin o = scene->texture_origins[texture];

    if (o.file == NO_INDEX)
        *place->text = '\0';
    else if (o.line == 0)
        fail(place, "%s: ", scene->path);
    else
        fail(place, "%s:%" PRIu64 ": ", scene->mtl_paths[o.file], o.line);
}

/* Warns that an image is missing. */
static void report_missing(const struct scene *scene, const struct reading *r,
                           struct warnings *report, const char *why)
{
    struct error place;

    write_place(&place, scene, r->texture);
    warnings_add_named(report, "unusable textures", r->path,
                       "%s%s: the texture is not used", place.text, why);
}

/* Copies the decoded image into the world. A texture whose image could not be
 * read stays without texels. */
static bool copy_image(struct host_world *host, const struct scene *scene,
                       const struct reading *r, struct warnings *report,
                       struct error *err)
{
    const struct reading *source = r->original != NULL ? r->original : r;
    const struct image *image = &source->image;

    if (shares_texels(host, scene, r->texture))
        return true;
    if (!source->is_decoded)
        report_missing(scene, r, report, source->error.text);
    else if ((uint64_t)image->width * (uint64_t)image->height >
             TEXELS_MAX - host->texel_count)
        report_missing(scene, r, report,
                       "found more than 4e9 texels in all textures");
    else
        return append(host, image, scene, r->texture, err);
    return true;
}

/* ---- loading with several threads ---- */

/* Images decoded at once per thread. Two keep the threads busy although images
 * differ in size. */
#define IMAGES_EACH 2

static const struct reading *find_original(const struct scene *scene,
                                           const struct reading *readings,
                                           uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (is_same_image(scene, readings[i].texture, readings[index].texture))
            return &readings[i];
    return NULL;
}

/* Opens the images of the first textures: at least one, and as many as fit into
 * memory together. Returns their number. An image that does not fit beside the
 * others comes first the next time, so that its refusal depends only on what
 * the scene holds by then, not on the number of threads. */
static uint32_t open_images(struct host_world *host, const struct scene *scene,
                            const uint32_t *textures, uint32_t count,
                            struct reading *readings)
{
    uint64_t held_bytes = textures_bytes(host);

    for (uint32_t i = 0; i < count; i++) {
        struct reading *r = &readings[i];

        *r = reading_of(scene, textures[i]);
        r->original = find_original(scene, readings, i);
        if (r->original != NULL || shares_texels(host, scene, r->texture))
            continue;
        open_image(scene, r, held_bytes);
        if (r->file.is_beyond && i > 0)
            return i;
        if (r->is_open)
            held_bytes += r->file.memory_bytes;
    }
    return count;
}

/* Copies the decoded images into the world, in order, and frees them. */
static bool copy_images(struct host_world *host, const struct scene *scene,
                        struct reading *readings, uint32_t count,
                        struct warnings *report, struct error *err)
{
    bool ok = true;

    for (uint32_t i = 0; i < count; i++)
        ok = ok && copy_image(host, scene, &readings[i], report, err);
    for (uint32_t i = 0; i < count; i++)
        image_free(&readings[i].image);
    return ok;
}

static bool load_all(struct host_world *host, const struct scene *scene,
                     const uint32_t *textures, uint32_t count,
                     struct warnings *report, struct error *err)
{
    struct pool *pool = count > 1 ? world_pool(host) : NULL;
    uint32_t at_once =
        pool ? IMAGES_EACH * (uint32_t)pool_thread_count(pool) : 1;
    struct reading *readings = alloc_array(at_once, sizeof *readings);
    bool ok = readings != NULL ||
              fail(err, "%s: out of memory for the textures", scene->path);

    for (uint32_t i = 0, n; ok && i < count; i += n) {
        uint32_t wanted = count - i < at_once ? count - i : at_once;

        n = open_images(host, scene, textures + i, wanted, readings);
        pool_each(pool, n, decode_image, readings);
        ok = copy_images(host, scene, readings, n, report, err);
    }
    free(readings);
    pool_destroy(pool);
    return ok;
}

/* ---- materials ---- */

static bool is_lost(const struct host_world *host, uint32_t texture)
{
    return texture < host->texture_count && host->texture_is_tried[texture] &&
           host->textures[texture].width == 0;
}

struct material_values textures_found(const struct host_world *host,
                                      const struct material_values *source)
{
    struct material_values s = *source;

    if (is_lost(host, material_values_map(&s, MTL_MAP_COLOR)) &&
        mtl_color_is_black(&s.base_color)) /* black that stood beside the map */
        s.base_color =
            (struct mtl_color){{MATERIAL_GREY, MATERIAL_GREY, MATERIAL_GREY},
                               MTL_IMPLIED};
    for (int i = 0; i < MTL_MAPS; i++)
        if (i != MTL_MAP_OPACITY && is_lost(host, s.maps[i]))
            s.maps[i] = NO_INDEX;
    return s;
}

/* Texels of an image that are looked at, evenly spread. */
#define NORMAL_TEXELS 4096

/* Returns true if the texels are unit vectors, most of them along blue. Black
 * and white texels are paddings. Compressed images miss the unit by a tenth;
 * heights are grey, so they have as much red as blue. */
static bool is_normal_map(const struct host_world *host,
                          const struct texture *t)
{
    uint64_t count = (uint64_t)t->width * t->height;
    uint64_t step = count / NORMAL_TEXELS + 1;
    double seen = 0, units = 0, blue = 0, red = 0;

    for (uint64_t i = 0; i < count; i += step) {
        uint32_t texel = host->texels[t->first + i] & 0xffffff;
        double x = (texel & 255) / 127.5 - 1,
               y = (texel >> 8 & 255) / 127.5 - 1;
        double z = (texel >> 16) / 127.5 - 1;

        if (texel == 0 || texel == 0xffffff)
            continue;
        seen++;
        units += fabs(sqrt(x * x + y * y + z * z) - 1) < 0.1;
        blue += z;
        red += x;
    }
    return seen > 0 && units >= 0.8 * seen && blue >= 0.5 * seen &&
           blue - red >= 0.25 * seen;
}

/* Uses a normal map that is named as a map of heights for what it is. Blender
 * and others write normal maps as map_Bump. */
static void resolve_bump_map(const struct host_world *host,
                             const struct scene *scene, struct material *m,
                             struct warnings *report)
{
    uint32_t map = m->bump_texture;
    struct error place;

    if (map == NO_INDEX || !is_normal_map(host, &host->textures[map]))
        return;
    m->bump_texture = NO_INDEX;
    if (m->normal_texture == NO_INDEX) {
        m->normal_texture = map;
        m->normal_strength = m->normal_depth = m->bump_scale;
    }
    write_place(&place, scene, map);
    warnings_add(report, "normal maps in map_Bump",
                 "%sfound a map of normals, expected heights: used as norm",
                 place.text);
}

bool textures_are_tried(const struct host_world *host, const struct material *m)
{
    uint32_t maps[MATERIAL_MAPS];

    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        if (maps[i] != NO_INDEX && (maps[i] >= host->texture_count ||
                                    !host->texture_is_tried[maps[i]]))
            return false;
    return true;
}

bool textures_load_for(struct host_world *host, const struct scene *scene,
                       const struct material_values *source, struct material *m,
                       struct warnings *report, struct error *err)
{
    struct material_values found;
    uint32_t maps[MATERIAL_MAPS];

    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++) {
        struct reading r;
        bool ok;

        if (maps[i] == NO_INDEX || host->texture_is_tried[maps[i]])
            continue;
        host->texture_is_tried[maps[i]] = true;
        r = reading_of(scene, maps[i]);
        if (!shares_texels(host, scene, r.texture))
            open_image(scene, &r, textures_bytes(host));
        decode_image(&r, 0, 0);
        ok = copy_image(host, scene, &r, report, err);
        image_free(&r.image);
        if (!ok)
            return false;
    }
    found = textures_found(host, source);
    if (!material_values_equal(&found, source))
        *m = world_material(scene, &found);
    if (is_lost(host, m->opacity_texture))
        m->opacity_texture = NO_INDEX;
    resolve_bump_map(host, scene, m, report);
    return true;
}

/* Lists the textures of the used materials that were not tried yet, in the
 * order of the materials. Returns their number. */
static uint32_t list_textures(struct host_world *host, uint32_t *textures)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < host->material_count; i++) {
        uint32_t maps[MATERIAL_MAPS];

        material_maps(&host->materials[i], maps);
        for (int k = 0; host->material_is_used[i] && k < MATERIAL_MAPS; k++)
            if (maps[k] != NO_INDEX && !host->texture_is_tried[maps[k]]) {
                host->texture_is_tried[maps[k]] = true;
                textures[count++] = maps[k];
            }
    }
    return count;
}

bool textures_add(struct host_world *host, const struct scene *scene)
{
    uint32_t count = scene->texture_count;
    struct texture *textures = alloc_array(count, sizeof *textures);
    bool *is_tried = alloc_array(count, sizeof *is_tried);
    bool ok = textures != NULL && is_tried != NULL;

    for (uint32_t i = 0; ok && i < count; i++) {
        bool is_old = i < host->texture_count;

        textures[i] = is_old ? host->textures[i] : scene->textures[i];
        is_tried[i] = is_old && host->texture_is_tried[i];
    }
    if (ok) {
        free(host->textures);
        host->textures = textures;
        free(host->texture_is_tried);
        host->texture_is_tried = is_tried;
        host->texture_count = count;
        world_renew(host, WORLD_TEXTURES);
    } else {
        free(textures);
        free(is_tried);
    }
    return ok;
}

bool textures_load(struct host_world *host, const struct scene *scene,
                   struct warnings *report, struct error *err)
{
    uint32_t *textures = alloc_array(scene->texture_count, sizeof *textures);
    bool ok = (textures != NULL && textures_add(host, scene)) ||
              fail(err, "%s: out of memory for the textures", scene->path);

    ok = ok && load_all(host, scene, textures, list_textures(host, textures),
                        report, err);
    for (uint32_t i = 0; ok && i < host->material_count; i++)
        if (host->material_is_used[i]) /* missing images are known by now */
            ok = textures_load_for(host, scene, &host->sources[i],
                                   &host->materials[i], report, err);
    free(textures);
    return ok;
}
