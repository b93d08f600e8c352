// SPDX-License-Identifier: MIT
/*
 * A scene is loaded with its materials and images, which are found by their
 * names in the files, and everything in it can be rendered. fuzz_put_scene()
 * describes the input.
 */
#include <math.h>

#include "scene/world.h"
#include "formats/scene_load.h"
#include "fuzz.h"

static int is_index(uint32_t index, uint32_t count)
{
    return index == NO_INDEX || index < count;
}

static int is_finite(struct vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static void check_tris(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->tri_count; i++) {
        const struct tri *t = &scene->tris[i];

        require(t->material < scene->material_count, "a material");
        require(scene->tri_objects[i] < scene->object_count, "an object");
        require(is_finite(t->ng), "a normal");
        for (int k = 0; k < 3; k++) {
            require(t->v[k] < scene->position_count, "a vertex");
            require(is_finite(scene->positions[t->v[k]]), "a place");
            require(is_index(t->vn[k], scene->normal_count), "a normal");
            require(is_index(t->vt[k], scene->uv_count), "coordinates");
        }
    }
}

static void check_textures(const struct host_world *host,
                           const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const struct texture *t = &host->textures[i];

        require((uint64_t)t->first + (uint64_t)t->width * t->height <=
                    host->texel_count,
                "texels");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *path = fuzz_put_scene(data, size);
    struct scene scene = {.path = NULL};
    struct host_world host = {.tris = NULL};
    struct warnings report = {0};
    struct error err = {""};

    if (scene_load(&scene, path, false, &report, &err) &&
        world_init(&host, &scene, 1, &report, &err)) {
        check_tris(&scene);
        check_textures(&host, &scene);
    } else {
        fuzz_check_message(err.text);
    }
    fuzz_check_report(&report);
    warnings_free(&report);
    world_free(&host);
    scene_free(&scene);
    free(path);
    return 0;
}
