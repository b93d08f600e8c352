// SPDX-License-Identifier: MIT
#include "read/scene_lists.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "image/color.h"

/* ---- materials and textures ---- */

/* Makes room for one more material, its name and its origin. */
static bool grow_materials(struct scene *scene, size_t *capacity)
{
    size_t needed = (size_t)scene->material_count + 1;
    size_t material_capacity = *capacity;
    size_t name_capacity = *capacity;
    void *materials = scene->materials;
    void *names = scene->material_names;
    void *origins = scene->material_origins;

    if (needed >= NO_INDEX || !grow_array(&materials, &material_capacity,
                                          needed, sizeof *scene->materials))
        return false;
    scene->materials = materials;
    if (!grow_array(&names, &name_capacity, needed,
                    sizeof *scene->material_names))
        return false;
    scene->material_names = names;
    if (!grow_array(&origins, capacity, needed,
                    sizeof *scene->material_origins))
        return false;
    scene->material_origins = origins;
    return true;
}

bool scene_add_material(struct scene *scene, size_t *capacity, const char *name,
                        const struct material *material,
                        const struct material_origin *origin)
{
    char *copy = strdup(name);

    if (copy == NULL || !grow_materials(scene, capacity)) {
        free(copy);
        return false;
    }
    scene->material_names[scene->material_count] = copy;
    scene->material_origins[scene->material_count] = *origin;
    scene->materials[scene->material_count++] = *material;
    return true;
}

/* Makes room for one more texture, its path and its origin. */
static bool grow_textures(struct scene *scene, size_t *capacity)
{
    size_t needed = (size_t)scene->texture_count + 1;
    size_t texture_capacity = *capacity;
    size_t path_capacity = *capacity;
    void *textures = scene->textures;
    void *paths = scene->texture_paths;
    void *origins = scene->texture_origins;

    if (!grow_array(&textures, &texture_capacity, needed,
                    sizeof *scene->textures))
        return false;
    scene->textures = textures;
    if (!grow_array(&paths, &path_capacity, needed,
                    sizeof *scene->texture_paths))
        return false;
    scene->texture_paths = paths;
    if (!grow_array(&origins, capacity, needed, sizeof *scene->texture_origins))
        return false;
    scene->texture_origins = origins;
    return true;
}

bool scene_add_texture(struct scene *scene, size_t *capacity, const char *path,
                       const struct texture *texture,
                       const struct texture_origin *origin)
{
    char *copy = strdup(path);

    if (copy == NULL || !grow_textures(scene, capacity)) {
        free(copy);
        return false;
    }
    scene->texture_paths[scene->texture_count] = copy;
    scene->texture_origins[scene->texture_count] = *origin;
    scene->textures[scene->texture_count++] = *texture;
    return true;
}

/* ---- tables of textures ---- */

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

/* ---- colours of vertices ---- */

/* Marks a vertex without a colour. */
#define NO_COLOR (-1.0f)

/* Makes room for a colour of each vertex, and marks those without one. */
static bool extend(struct scene *scene, size_t *capacity)
{
    size_t known = scene->color_count;
    void *array = scene->colors;

    if (!grow_array(&array, capacity, scene->position_count,
                    sizeof *scene->colors))
        return false;
    scene->colors = array;
    for (size_t i = known; i < scene->position_count; i++)
        scene->colors[i] = v3(NO_COLOR, NO_COLOR, NO_COLOR);
    scene->color_count = scene->position_count;
    return true;
}

/* Negative numbers and those that are not numbers are black. */
static float at_least_zero(double x)
{
    return x > 0 ? (float)x : 0.0f;
}

struct vec3 vertex_color_encoded(const double rgb[3])
{
    return v3(at_least_zero(rgb[0]), at_least_zero(rgb[1]),
              at_least_zero(rgb[2]));
}

bool vertex_colors_set(struct scene *scene, size_t *capacity, uint32_t index,
                       const double rgb[3])
{
    if (!extend(scene, capacity))
        return false;
    scene->colors[index] = vertex_color_encoded(rgb);
    return true;
}

bool vertex_colors_put(struct scene *scene, size_t *capacity,
                       const double rgb[3])
{
    return vertex_colors_set(scene, capacity, scene->position_count - 1, rgb);
}

float vertex_colors_white(const struct vec3 *colors, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (v3_max_component(colors[i]) > 1.0f)
            return 255.0f;
    return 1.0f;
}

static float decoded(float x, float white)
{
    return (float)color_decoded((double)f_min(x / white, 1.0f));
}

/* Table of the colours of whole numbers up to 255, which most files have. */
struct decoder {
    float white;
    float of_byte[256];
};

static float decode(const struct decoder *d, float x)
{
    return d->white == 255.0f && x <= 255.0f && x == (float)(int)x
               ? d->of_byte[(int)x]
               : decoded(x, d->white);
}

void vertex_colors_decode(struct vec3 *colors, size_t count, float white)
{
    struct decoder d = {.white = white};

    for (int i = 0; i < 256; i++)
        d.of_byte[i] = decoded((float)i, white);
    for (size_t i = 0; i < count; i++) {
        struct vec3 *c = &colors[i];

        *c = c->x == NO_COLOR
                 ? v3(1.0f, 1.0f, 1.0f)
                 : v3(decode(&d, c->x), decode(&d, c->y), decode(&d, c->z));
    }
}

bool vertex_colors_finish(struct scene *scene, size_t *capacity)
{
    if (scene->colors == NULL)
        return true;
    if (!extend(scene, capacity))
        return false;
    vertex_colors_decode(scene->colors, scene->color_count,
                         vertex_colors_white(scene->colors,
                                             scene->color_count));
    return true;
}
