// SPDX-License-Identifier: MIT
#include "glim/textures.h"

#include <stdlib.h>
#include <string.h>

#include "glim/image.h"
#include "glim/material.h"

/* texture.first is 32 bits wide. */
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

/* The number that a texel of data holds: grey, not decoded. What is cut out is
 * often an alpha channel behind a white or coloured picture. */
static uint32_t number_of(const uint8_t *texel, bool by_alpha)
{
    if (by_alpha)
        return texel[3];
    return ((uint32_t)texel[0] + texel[1] + texel[2] + 1) / 3;
}

static bool append(struct scene *scene, const struct image *image,
                   struct texture *texture, struct error *err)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    size_t total = scene->texel_count + count;
    bool by_alpha = !texture->is_data || has_alpha(image);
    uint32_t *texels;

    texels = total > SIZE_MAX / sizeof *texels
                 ? NULL
                 : realloc(scene->texels, total * sizeof *texels);
    if (texels == NULL)
        return fail(err, "%s: out of memory for the textures: %zu MB",
                    scene->path, total * sizeof *texels >> 20);
    scene->texels = texels;
    texels += scene->texel_count;
    texture->first = (uint32_t)scene->texel_count;
    texture->width = (uint32_t)image->width;
    texture->height = (uint32_t)image->height;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = image->rgba + 4 * i;
        uint32_t alpha = number_of(p, by_alpha);

        texels[i] = (uint32_t)p[0] | (uint32_t)p[1] << 8 |
                    (uint32_t)p[2] << 16 | alpha << 24;
        texture->has_holes |= alpha < 128;
    }
    scene->texel_count = total;
    return true;
}

/* The same image with other options is read once. */
static bool shares_texels(struct scene *scene, uint32_t index)
{
    struct texture *t = &scene->textures[index];

    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const struct texture *other = &scene->textures[i];

        if (other->width == 0 || other->is_data != t->is_data ||
            strcmp(scene->texture_paths[i], scene->texture_paths[index]) != 0)
            continue;
        t->first = other->first;
        t->width = other->width;
        t->height = other->height;
        t->has_holes = other->has_holes;
        return true;
    }
    return false;
}

/* An unreadable image leaves the texture without texels. */
static bool load(struct scene *scene, uint32_t index, struct report *report,
                 struct error *err)
{
    const char *path = scene->texture_paths[index];
    struct image image = {0};
    struct error why;
    bool ok = true;

    if (shares_texels(scene, index))
        return true;
    if (!image_read_8bit(&image, path, &why)) {
        report_add_named(report, "lost textures", path,
                         "%s: the texture is not used", why.text);
        return true;
    }
    if ((uint64_t)image.width * (uint64_t)image.height >
        TEXELS_MAX - scene->texel_count)
        report_add_named(report, "lost textures", path,
                         "%s: found more than 4e9 texels in all textures: the "
                         "texture is not used",
                         path);
    else
        ok = append(scene, &image, &scene->textures[index], err);
    image_free(&image);
    return ok;
}

static bool is_black(const struct vec3 *c)
{
    return c->x == 0 && c->y == 0 && c->z == 0;
}

/* A map multiplies its colour, but beside a black or absent one it stands
 * alone, times `alone`. Without its image the map is gone. */
static void settle(const struct scene *scene, uint32_t *texture,
                   struct vec3 *color, float alone, float lost)
{
    bool is_lost = *texture != NO_INDEX && scene->textures[*texture].width == 0;
    float x = is_lost ? lost : alone;

    if (*texture != NO_INDEX && is_black(color))
        *color = (struct vec3){x, x, x};
    if (is_lost)
        *texture = NO_INDEX;
}

/* A map of numbers without its image is gone. */
static void settle_data(const struct scene *scene, uint32_t *texture)
{
    if (*texture != NO_INDEX && scene->textures[*texture].width == 0)
        *texture = NO_INDEX;
}

#define MAPS 8

static void list_maps(const struct material *m, uint32_t maps[MAPS])
{
    const uint32_t all[MAPS] = {m->color_texture,  m->emission_texture,
                                m->coat_texture,   m->alpha_texture,
                                m->metal_texture,  m->opacity_texture,
                                m->normal_texture, m->bump_texture};

    memcpy(maps, all, sizeof all);
}

bool textures_are_tried(const struct scene *scene, const struct material *m)
{
    uint32_t maps[MAPS];

    list_maps(m, maps);
    for (int i = 0; i < MAPS; i++)
        if (maps[i] != NO_INDEX && !scene->texture_is_tried[maps[i]])
            return false;
    return true;
}

bool textures_load_for(struct scene *scene, struct material *m,
                       struct report *report, struct error *err)
{
    uint32_t maps[MAPS];

    list_maps(m, maps);
    for (int i = 0; i < MAPS; i++) {
        if (maps[i] == NO_INDEX || scene->texture_is_tried[maps[i]])
            continue;
        scene->texture_is_tried[maps[i]] = true;
        if (!load(scene, maps[i], report, err))
            return false;
    }
    settle(scene, &m->color_texture, &m->color, 1, MATERIAL_GREY);
    settle(scene, &m->emission_texture, &m->emission, 1, 0);
    settle(scene, &m->coat_texture, &m->coat, MATERIAL_COAT, 0);
    settle_data(scene, &m->alpha_texture);
    settle_data(scene, &m->metal_texture);
    settle_data(scene, &m->opacity_texture);
    settle_data(scene, &m->normal_texture);
    settle_data(scene, &m->bump_texture);
    if (m->kind == MATERIAL_PLASTIC && is_black(&m->coat))
        m->kind = MATERIAL_DIFFUSE;
    return true;
}

bool textures_load(struct scene *scene, struct report *report,
                   struct error *err)
{
    bool *is_used = alloc_array(scene->material_count, sizeof *is_used);
    bool ok = is_used != NULL;

    free(scene->texture_is_tried);
    scene->texture_is_tried =
        alloc_array(scene->texture_count, sizeof *scene->texture_is_tried);
    if (!ok || scene->texture_is_tried == NULL)
        ok = fail(err, "%s: out of memory for the textures", scene->path);
    for (uint32_t i = 0; ok && i < scene->tri_count; i++)
        is_used[scene->tris[i].material] = true;
    for (uint32_t i = 0; ok && i < scene->material_count; i++)
        if (is_used[i])
            ok = textures_load_for(scene, &scene->materials[i], report, err);
    free(is_used);
    return ok;
}
