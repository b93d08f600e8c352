// SPDX-License-Identifier: MIT
#include "read/scene_lists.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

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
