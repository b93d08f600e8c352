// SPDX-License-Identifier: MIT
/*
 * fuzz_tris.h - checks of a finished scene, which everything else relies on
 *
 * Threads:   one
 * Errors:    abort(), as fuzz.h
 */
#ifndef TESTS_FUZZ_TRIS_H
#define TESTS_FUZZ_TRIS_H

#include <math.h>

#include "engine/scene_load.h"
#include "fuzz.h"

static inline int fuzz_is_index(uint32_t index, uint32_t count)
{
    return index == NO_INDEX || index < count;
}

static inline int fuzz_is_finite(struct vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static inline void fuzz_check_tris(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->tri_count; i++) {
        const struct tri *t = &scene->tris[i];

        require(t->material < scene->material_count, "a material");
        require(scene->tri_objects[i] < scene->object_count, "an object");
        require(fuzz_is_finite(t->ng), "a normal");
        for (int k = 0; k < 3; k++) {
            require(t->v[k] < scene->position_count, "a vertex");
            require(fuzz_is_finite(scene->positions[t->v[k]]), "a place");
            require(fuzz_is_index(t->vn[k], scene->normal_count), "a normal");
            require(t->vn[k] == NO_INDEX ||
                        fuzz_is_finite(scene->normals[t->vn[k]]),
                    "a normal");
            require(fuzz_is_index(t->vt[k], scene->uv_count), "coordinates");
            require(scene->color_count == 0 ||
                        (t->v[k] < scene->color_count &&
                         fuzz_is_finite(scene->colors[t->v[k]])),
                    "a colour");
        }
    }
}

static inline void fuzz_check_instances(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const struct instance *at = &scene->placed[i];

        require(at->material < scene->material_count, "a material");
        require(scene->placed_objects[i] < scene->object_count, "an object");
        require(at->tri_count > 0 && at->mesh_tri < scene->tri_count &&
                    at->tri_count <= scene->tri_count - at->mesh_tri,
                "triangles of a mesh");
        require(at->first_tri == (i == 0 ? at[0].first_tri
                                         : at[-1].first_tri + at[-1].tri_count),
                "numbers");
        for (int k = 0; k < 3; k++)
            require(fuzz_is_finite(at->rows[k]) &&
                        fuzz_is_finite(at->inverse[k]),
                    "a matrix");
        require(fuzz_is_finite(at->origin), "a place");
    }
}

/* Parses bytes as a file of this name: they give a scene that can be rendered,
 * or one line. */
static inline void fuzz_check_scene(scene_parse *parse, const char *path,
                                    const uint8_t *data, size_t size)
{
    struct scene scene = {.path = NULL};
    struct warnings report = {0};
    struct error err = {""};

    if (parse(&scene, (const char *)data, size, path, &report, &err) &&
        scene_finish(&scene, &report, &err)) {
        fuzz_check_tris(&scene);
        fuzz_check_instances(&scene);
    } else
        fuzz_check_message(err.text);
    fuzz_check_report(&report);
    warnings_free(&report);
    scene_free(&scene);
}

#endif
