// SPDX-License-Identifier: MIT
#include "read/texture_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "read/scene_lists.h"

/* Returns a text that identifies a texture by its path and its options, for
 * free(); NULL when memory is out. */
static char *key_of(const char *path, const struct texture *t, bool is_opacity)
{
    return format_text("%a %a %a %a %a %a %u %u %u %d %s", (double)t->scale.x,
                       (double)t->scale.y, (double)t->offset.x,
                       (double)t->offset.y, (double)t->rotation.x,
                       (double)t->rotation.y, t->flags, t->is_data, t->channel,
                       is_opacity, path);
}

/* Returns the number of the texture in the table, or NO_NAME. */
static uint32_t name_texture(struct texture_table *table, const char *path,
                             const struct texture *texture, bool is_opacity)
{
    char *key = key_of(path, texture, is_opacity);
    uint32_t index = key == NULL ? NO_NAME : name_table_add(&table->names, key);

    free(key);
    return index;
}

/* Returns the number of the image: that of the file, which may have several
 * paths, or of a path without a file. NO_NAME when memory is out. */
static uint32_t number_image(struct texture_table *table, const char *path)
{
    struct file_identity file = file_identify(path);
    char *key = file.exists ? format_text("%ju %ju", (uintmax_t)file.device,
                                          (uintmax_t)file.inode)
                            : strdup(path);
    uint32_t number =
        key == NULL ? NO_NAME : name_table_add(&table->images, key);

    free(key);
    return number;
}

bool texture_table_init(struct texture_table *table, struct scene *scene)
{
    *table = (struct texture_table){.scene = scene,
                                    .capacity = scene->texture_count};
    for (uint32_t i = 0; i < scene->texture_count; i++)
        if (name_texture(table, scene->texture_paths[i], &scene->textures[i],
                         scene->texture_origins[i].is_opacity) == NO_NAME ||
            (scene->texture_origins[i].image =
                 number_image(table, scene->texture_paths[i])) == NO_NAME)
            return false;
    return true;
}

uint32_t texture_table_add(struct texture_table *table, const char *path,
                           const struct texture *texture,
                           const struct texture_origin *origin)
{
    uint32_t index = name_texture(table, path, texture, origin->is_opacity);
    struct texture_origin numbered = *origin;

    if (index == NO_NAME)
        return NO_INDEX;
    if (index < table->scene->texture_count)
        return index;
    numbered.image = number_image(table, path);
    if (numbered.image == NO_NAME ||
        !scene_add_texture(table->scene, &table->capacity, path, texture,
                           &numbered))
        return NO_INDEX;
    return index;
}

void texture_table_free(struct texture_table *table)
{
    name_table_free(&table->names);
    name_table_free(&table->images);
}

struct texture texture_default(void)
{
    return (struct texture){.scale = {1, 1}, .rotation = {1, 0}};
}

void texture_rotate(struct texture *t, double angle_deg)
{
    double angle = fmod(angle_deg, 360) * (M_PI / 180);

    if (!isfinite(angle) || angle == 0)
        return;
    t->rotation = (struct vec2){(float)cos(angle), (float)sin(angle)};
    t->flags |= TEXTURE_ROTATED;
}
