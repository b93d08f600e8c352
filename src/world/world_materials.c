// SPDX-License-Identifier: MIT
#include "world/world_materials.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "world/textures.h"

/* New arrays to be swapped in. NULL keeps the world's array. */
struct new_arrays {
    struct tri *tris;
    struct instance *instances;
    uint32_t *assigned;
    struct material *materials;
    struct material_values *sources;
    bool *material_is_used;
    struct texture *textures;
    struct lights lights;
    bool has_lights;
};

/* A change of materials in progress. */
struct material_change {
    struct host_world *host;
    const struct scene *scene;
    uint32_t count; /* as in world_set_materials() */
    const struct material_values *sources;
    const uint32_t *assigned;
    struct new_arrays next;
};

static bool out_of_memory(const struct material_change *c, struct error *err)
{
    return fail(err, "%s: out of memory for the changed materials",
                c->scene->path);
}

static void *copy_array(const void *from, size_t count, size_t size_bytes)
{
    void *to = alloc_array(count, size_bytes);

    if (to != NULL && count > 0)
        memcpy(to, from, count * size_bytes);
    return to;
}

/* ---- triangles ---- */

static bool needs_tris(const struct host_world *host, const struct scene *scene,
                       const uint32_t *assigned)
{
    for (uint32_t i = 0; i < scene->object_count; i++) {
        uint32_t before = host->assigned != NULL ? host->assigned[i] : NO_INDEX;

        if (before != assigned[i])
            return true;
    }
    return false;
}

static bool make_tris(struct material_change *c)
{
    const struct scene *scene = c->scene;
    struct new_arrays *next = &c->next;

    if (!needs_tris(c->host, scene, c->assigned))
        return true;
    next->tris = copy_array(scene->tris, scene->tri_count, sizeof *next->tris);
    next->instances =
        copy_array(scene->placed, scene->placed_count, sizeof *next->instances);
    next->assigned =
        copy_array(c->assigned, scene->object_count, sizeof *next->assigned);
    if (next->tris == NULL || next->instances == NULL || next->assigned == NULL)
        return false;
    for (uint32_t i = 0; i < scene->tri_count; i++) {
        uint32_t assigned = next->assigned[scene->tri_objects[i]];

        if (assigned != NO_INDEX)
            next->tris[i].material = assigned;
    }
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        uint32_t assigned = next->assigned[scene->placed_objects[i]];

        if (assigned != NO_INDEX)
            next->instances[i].material = assigned;
    }
    return true;
}

/* ---- materials ---- */

static bool *find_used(const struct material_change *c)
{
    bool *is_used = alloc_array(c->count, sizeof *is_used);

    if (is_used != NULL && c->next.tris == NULL)
        memcpy(is_used, c->host->material_is_used,
               c->host->material_count * sizeof *is_used);
    else if (is_used != NULL) {
        for (uint32_t i = 0; i < c->scene->tri_count; i++)
            is_used[c->next.tris[i].material] = true;
        for (uint32_t i = 0; i < c->scene->placed_count; i++)
            is_used[c->next.instances[i].material] = true;
    }
    return is_used;
}

static bool is_as_before(const struct material_change *c, uint32_t i)
{
    const struct host_world *host = c->host;

    return i < host->material_count &&
           (host->material_is_used[i] || !c->next.material_is_used[i]) &&
           material_values_equal(&host->sources[i], &c->sources[i]);
}

/* Loads the images of material i that comes into use, into a copy of the
 * textures, since the old array is lent. */
static bool load_textures(struct material_change *c, uint32_t i,
                          struct error *err)
{
    struct host_world *host = c->host;
    struct material *m = &c->next.materials[i];
    struct texture *lent = host->textures;
    struct warnings report = {0};
    bool ok;

    if (c->next.textures == NULL && !textures_are_tried(host, m)) {
        c->next.textures = copy_array(lent, host->texture_count, sizeof *lent);
        if (c->next.textures == NULL)
            return out_of_memory(c, err);
    }
    if (c->next.textures != NULL)
        host->textures = c->next.textures;
    ok = textures_load_for(host, c->scene, &c->sources[i], m, &report, err);
    host->textures = lent;
    warnings_free(&report);
    return ok;
}

static bool make_materials(struct material_change *c, struct error *err)
{
    struct new_arrays *next = &c->next;
    bool ok = true;

    next->material_is_used = find_used(c);
    next->materials = alloc_array(c->count, sizeof *next->materials);
    next->sources = copy_array(c->sources, c->count, sizeof *next->sources);
    if (next->material_is_used == NULL || next->materials == NULL ||
        next->sources == NULL)
        return out_of_memory(c, err);
    for (uint32_t i = 0; ok && i < c->count; i++) {
        if (is_as_before(c, i)) {
            next->materials[i] = c->host->materials[i];
            continue;
        }
        next->materials[i] = world_material(c->scene, &c->sources[i]);
        if (next->material_is_used[i])
            ok = load_textures(c, i, err);
    }
    return ok;
}

/* ---- lights, path guide ---- */

/* Returns true if `differ` is true for a used material before and after the
 * change, or for the material of a triangle. */
static bool any_differs(const struct material_change *c,
                        bool (*differ)(const struct material *,
                                       const struct material *))
{
    const struct host_world *host = c->host;
    const struct new_arrays *next = &c->next;
    const struct tri *tris = world_tris(host, c->scene);
    const struct instance *instances = world_instances(host, c->scene);

    for (uint32_t i = 0; i < host->material_count; i++)
        if (host->material_is_used[i] &&
            differ(&host->materials[i], &next->materials[i]))
            return true;
    for (uint32_t i = 0; next->tris != NULL && i < c->scene->tri_count; i++)
        if (differ(&host->materials[tris[i].material],
                   &next->materials[next->tris[i].material]))
            return true;
    for (uint32_t i = 0; next->tris != NULL && i < c->scene->placed_count; i++)
        if (differ(&host->materials[instances[i].material],
                   &next->materials[next->instances[i].material]))
            return true;
    return false;
}

static struct world next_arrays(const struct material_change *c)
{
    struct world arrays = world_arrays(c->host, c->scene);

    arrays.materials = c->next.materials;
    arrays.settings.material_count = c->count;
    if (c->next.tris != NULL) {
        arrays.tris = c->next.tris;
        arrays.instances = c->next.instances;
    }
    if (c->next.textures != NULL)
        arrays.textures = c->next.textures;
    return arrays;
}

static bool make_lights(struct material_change *c, struct error *err)
{
    struct world arrays = next_arrays(c);

    if (!any_differs(c, lights_differ))
        return true;
    c->next.has_lights = lights_build(&c->next.lights, &arrays, err);
    return c->next.has_lights;
}

static bool needs_guide(const struct material_change *c)
{
    return c->next.has_lights || c->next.textures != NULL ||
           any_differs(c, path_guides_differ);
}

/* ---- swap ---- */

static bool has_coverage(const struct host_world *host)
{
    return (world_features(host) & FEATURE_COVERAGE) != 0;
}

/* A tree that lacks copies is not that of surfaces that let rays through. */
static void renew_shape(struct host_world *host)
{
    const struct bvh8 *tree = world_tree(host);

    if (tree != NULL && !tree->lacks_copies)
        return;
    world_drop_tree(host);
    world_renew(host, WORLD_SHAPE);
}

static void swap_in(struct material_change *c)
{
    struct host_world *host = c->host;
    struct new_arrays *next = &c->next;
    bool had_coverage = has_coverage(host);

    free(host->materials);
    host->materials = next->materials;
    free(host->sources);
    host->sources = next->sources;
    free(host->material_is_used);
    host->material_is_used = next->material_is_used;
    host->material_count = c->count;
    world_renew(host, WORLD_MATERIALS);
    if (next->tris != NULL) {
        free(host->tris);
        host->tris = next->tris;
        free(host->instances);
        host->instances = next->instances;
        free(host->assigned);
        host->assigned = next->assigned;
        world_renew(host, WORLD_TRIS);
    }
    if (next->textures != NULL) {
        free(host->textures);
        host->textures = next->textures;
        world_renew(host, WORLD_TEXTURES);
    }
    if (next->has_lights) {
        lights_free(&host->lights);
        host->lights = next->lights;
        world_renew(host, WORLD_LIGHTS);
    }
    if (has_coverage(host) && !had_coverage)
        renew_shape(host);
}

static void free_arrays(struct new_arrays *next)
{
    free(next->materials);
    free(next->sources);
    free(next->material_is_used);
    free(next->tris);
    free(next->instances);
    free(next->assigned);
    free(next->textures);
    lights_free(&next->lights);
}

/* Returns true if the world has these already. */
static bool has_materials(const struct host_world *host,
                          const struct scene *scene, uint32_t count,
                          const struct material_values *sources,
                          const uint32_t *assigned)
{
    if (host->material_count != count || needs_tris(host, scene, assigned))
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!material_values_equal(&host->sources[i], &sources[i]))
            return false;
    return true;
}

bool world_set_materials(struct host_world *host, const struct scene *scene,
                         uint32_t count, const struct material_values *sources,
                         const uint32_t *assigned, struct error *err)
{
    struct material_change c = {.host = host,
                                .scene = scene,
                                .count = count,
                                .sources = sources,
                                .assigned = assigned};
    bool ok;

    if (has_materials(host, scene, count, sources, assigned))
        return true;
    ok = (scene->texture_count == host->texture_count ||
          textures_add(host, scene)) &&
         make_tris(&c);
    ok = ok || out_of_memory(&c, err);
    ok = ok && make_materials(&c, err) && make_lights(&c, err);
    if (!ok) {
        free_arrays(&c.next);
        return false;
    }
    if (needs_guide(&c))
        path_guide_outdate(&host->guide);
    path_guide_recolor(&host->guide);
    swap_in(&c);
    return true;
}
