// SPDX-License-Identifier: MIT
#include "scene/scene_materials.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/textures.h"

/* What is to be swapped in; NULL: what is there stays. */
struct next {
    char **names; /* of new materials, behind those of the scene */
    uint32_t name_count;
    struct tri *tris;
    struct material *materials;
    bool *material_is_used;
    struct texture *textures;
    struct lights lights;
    bool has_lights;
};

static bool out_of_memory(const struct scene *scene, struct error *err)
{
    return fail(err, "%s: out of memory for the changed materials",
                scene->path);
}

/* ---- triangles ---- */

static uint32_t assigned_of(const struct scene *scene, uint32_t object)
{
    return scene->assigned != NULL ? scene->assigned[object] : NO_INDEX;
}

static bool needs_tris(const struct scene *scene, const struct style *style)
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (assigned_of(scene, i) != style->assigned[i])
            return true;
    return false;
}

/* What the file says is needed again when an object goes back to it. */
static bool keep_file_materials(struct scene *scene)
{
    if (scene->file_materials != NULL)
        return true;
    scene->file_materials =
        alloc_array(scene->tri_count, sizeof *scene->file_materials);
    scene->assigned = alloc_array(scene->object_count, sizeof *scene->assigned);
    if (scene->file_materials == NULL || scene->assigned == NULL) {
        free(scene->file_materials);
        free(scene->assigned);
        scene->file_materials = scene->assigned = NULL;
        return false;
    }
    for (uint32_t i = 0; i < scene->tri_count; i++)
        scene->file_materials[i] = scene->tris[i].material;
    for (uint32_t i = 0; i < scene->object_count; i++)
        scene->assigned[i] = NO_INDEX;
    return true;
}

static bool make_tris(struct scene *scene, const struct style *style,
                      struct next *next)
{
    if (!needs_tris(scene, style))
        return true;
    if (!keep_file_materials(scene))
        return false;
    next->tris = alloc_array(scene->tri_count, sizeof *next->tris);
    if (next->tris == NULL)
        return false;
    for (uint32_t i = 0; i < scene->tri_count; i++) {
        uint32_t assigned = style->assigned[scene->tri_objects[i]];

        next->tris[i] = scene->tris[i];
        next->tris[i].material =
            assigned != NO_INDEX ? assigned : scene->file_materials[i];
    }
    return true;
}

static const struct tri *tris_of(const struct scene *scene,
                                 const struct next *next)
{
    return next->tris != NULL ? next->tris : scene->tris;
}

/* ---- materials ---- */

static bool *find_used(const struct scene *scene, const struct style *style,
                       const struct next *next)
{
    bool *is_used = alloc_array(style->material_count, sizeof *is_used);

    if (is_used != NULL && next->tris == NULL)
        memcpy(is_used, scene->material_is_used,
               scene->material_count * sizeof *is_used);
    else if (is_used != NULL)
        for (uint32_t i = 0; i < scene->tri_count; i++)
            is_used[next->tris[i].material] = true;
    return is_used;
}

static bool is_as_before(const struct scene *scene, const struct style *style,
                         const bool *is_used, uint32_t i)
{
    return i < scene->material_count &&
           (scene->material_is_used[i] || !is_used[i]) &&
           mtl_source_equal(&scene->material_origins[i].source,
                            &style->sources[i]);
}

static struct material make_material(const struct scene *scene,
                                     const struct style *style, uint32_t i)
{
    /* What is odd in the file was said when it was read. */
    struct warnings report = {0};
    struct material m =
        material_from_source(&style->sources[i], scene->path, &report);

    warnings_free(&report);
    return m;
}

/* Images that come into use are read into a copy of the textures. */
static bool load_textures(struct scene *scene, struct material *m,
                          struct next *next, struct error *err)
{
    struct warnings report = {0};
    struct texture *lent = scene->textures;
    bool ok;

    if (next->textures == NULL && !textures_are_tried(scene, m)) {
        next->textures = alloc_array(scene->texture_count, sizeof *lent);
        if (next->textures == NULL)
            return out_of_memory(scene, err);
        memcpy(next->textures, lent, scene->texture_count * sizeof *lent);
    }
    if (next->textures != NULL)
        scene->textures = next->textures;
    ok = textures_load_for(scene, m, &report, err);
    scene->textures = lent;
    warnings_free(&report);
    return ok;
}

static bool make_materials(struct scene *scene, const struct style *style,
                           struct next *next, struct error *err)
{
    bool *is_used = find_used(scene, style, next);
    bool ok = is_used != NULL || out_of_memory(scene, err);

    next->material_is_used = is_used;
    next->materials =
        alloc_array(style->material_count, sizeof *next->materials);
    if (ok && next->materials == NULL)
        ok = out_of_memory(scene, err);
    for (uint32_t i = 0; ok && i < style->material_count; i++) {
        if (is_as_before(scene, style, is_used, i)) {
            next->materials[i] = scene->materials[i];
            continue;
        }
        next->materials[i] = make_material(scene, style, i);
        if (is_used[i])
            ok = load_textures(scene, &next->materials[i], next, err);
    }
    return ok;
}

/* ---- lights, directions ---- */

/* Is there a material in use, or a triangle, whose material is another in what
 * `differ` looks at? */
static bool any_differs(const struct scene *scene, const struct next *next,
                        bool (*differ)(const struct material *,
                                       const struct material *))
{
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (scene->material_is_used[i] &&
            differ(&scene->materials[i], &next->materials[i]))
            return true;
    for (uint32_t i = 0; next->tris != NULL && i < scene->tri_count; i++)
        if (differ(&scene->materials[scene->tris[i].material],
                   &next->materials[next->tris[i].material]))
            return true;
    return false;
}

static struct world next_arrays(const struct scene *scene,
                                const struct style *style,
                                const struct next *next)
{
    struct world arrays = scene_arrays(scene);

    arrays.tris = tris_of(scene, next);
    arrays.materials = next->materials;
    arrays.settings.material_count = style->material_count;
    if (next->textures != NULL)
        arrays.textures = next->textures;
    return arrays;
}

static bool make_lights(struct scene *scene, const struct style *style,
                        struct next *next, struct error *err)
{
    struct world arrays = next_arrays(scene, style, next);

    if (!any_differs(scene, next, lights_differ))
        return true;
    next->has_lights = lights_build(&next->lights, &arrays, err);
    return next->has_lights;
}

static bool needs_guide(const struct scene *scene, const struct next *next)
{
    return next->has_lights || next->textures != NULL ||
           any_differs(scene, next, path_guides_differ);
}

/* ---- all ---- */

/* Names and origins, which no world has. */
static bool grow_names(struct scene *scene, const struct style *style,
                       struct next *next)
{
    size_t count = style->material_count;
    uint32_t new_count = style->material_count - scene->material_count;
    char **names;
    struct material_origin *origins;

    names = realloc(scene->material_names, count * sizeof *names);
    if (names == NULL)
        return false;
    scene->material_names = names;
    origins = realloc(scene->material_origins, count * sizeof *origins);
    if (origins == NULL)
        return false;
    scene->material_origins = origins;
    next->names = alloc_array(new_count, sizeof *next->names);
    if (next->names == NULL)
        return false;
    for (; next->name_count < new_count; next->name_count++) {
        uint32_t i = scene->material_count + next->name_count;

        next->names[next->name_count] = strdup(style->names[i]);
        if (next->names[next->name_count] == NULL)
            return false;
    }
    return true;
}

static void take_sources(struct scene *scene, const struct style *style,
                         struct next *next)
{
    for (uint32_t i = 0; i < next->name_count; i++) {
        uint32_t material = scene->material_count + i;

        scene->material_names[material] = next->names[i];
        scene->material_origins[material].file = NO_INDEX;
    }
    free(next->names); /* the scene owns the texts now */
    scene->material_count = style->material_count;
    for (uint32_t i = 0; i < style->material_count; i++)
        scene->material_origins[i].source = style->sources[i];
}

static void swap_in(struct scene *scene, const struct style *style,
                    struct next *next)
{
    free(scene->materials);
    scene->materials = next->materials;
    free(scene->material_is_used);
    scene->material_is_used = next->material_is_used;
    if (next->tris != NULL) {
        free(scene->tris);
        scene->tris = next->tris;
        memcpy(scene->assigned, style->assigned,
               scene->object_count * sizeof *scene->assigned);
    }
    if (next->textures != NULL) {
        free(scene->textures);
        scene->textures = next->textures;
    }
    if (next->has_lights) {
        lights_free(&scene->lights);
        scene->lights = next->lights;
    }
}

static void drop(struct next *next)
{
    for (uint32_t i = 0; i < next->name_count; i++)
        free(next->names[i]);
    free(next->names);
    free(next->materials);
    free(next->material_is_used);
    free(next->tris);
    free(next->textures);
    lights_free(&next->lights);
}

bool scene_is_styled(const struct scene *scene, const struct style *style)
{
    if (scene->material_count != style->material_count ||
        needs_tris(scene, style))
        return false;
    for (uint32_t i = 0; i < style->material_count; i++)
        if (!mtl_source_equal(&scene->material_origins[i].source,
                              &style->sources[i]))
            return false;
    return true;
}

bool scene_restyle(struct scene *scene, const struct style *style,
                   struct error *err)
{
    struct next next = {.materials = NULL};
    bool ok;

    if (scene_is_styled(scene, style))
        return true;
    ok = (grow_names(scene, style, &next) && make_tris(scene, style, &next)) ||
         out_of_memory(scene, err);
    ok = ok && make_materials(scene, style, &next, err) &&
         make_lights(scene, style, &next, err);
    if (!ok) {
        drop(&next);
        return false;
    }
    if (needs_guide(scene, &next))
        path_guide_outdate(&scene->guide);
    path_guide_recolor(&scene->guide);
    swap_in(scene, style, &next);
    take_sources(scene, style, &next);
    scene_find_emitters(scene);
    return true;
}
