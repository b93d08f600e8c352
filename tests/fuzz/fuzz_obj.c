// SPDX-License-Identifier: MIT
/*
 * A scene is loaded with its materials and images, which are found by their
 * names in the files, and everything in it can be rendered. fuzz_put_scene()
 * describes the input.
 */
#include "engine/scene_load.h"
#include "fuzz_tris.h"
#include "mutate_text.h"
#include "world/world.h"

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

    if (scene_load(&scene, path, SCENE_UP_OF_FILE, &report, &err) &&
        world_init(&host, &scene, 1, &report, &err)) {
        fuzz_check_tris(&scene);
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
