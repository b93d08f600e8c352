// SPDX-License-Identifier: MIT
#include "formats/scene_load.h"

#include "scene/textures.h"
#include "formats/obj.h"

static void turn_z_up(struct scene *scene)
{
    for (size_t i = 0; i < scene->position_count; i++) {
        double *p = scene->file_positions + 3 * i;
        double y = p[1];

        p[1] = p[2];
        p[2] = -y;
    }
    for (size_t i = 0; i < scene->normal_count; i++) {
        struct vec3 *n = &scene->normals[i];
        float y = n->y;

        n->y = n->z;
        n->z = -y;
    }
}

bool scene_load(struct scene *scene, const char *path, bool up_is_z,
                struct warnings *report, struct error *err)
{
    if (!obj_read(scene, path, report, err))
        return false;
    if (up_is_z)
        turn_z_up(scene);
    if (!textures_load(scene, report, err))
        return false;
    return scene_finish(scene, report, err);
}
