// SPDX-License-Identifier: MIT
#include "formats/vertex_colors.h"

#include "base/memory.h"
#include "picture/color.h"

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

bool vertex_colors_put(struct scene *scene, size_t *capacity,
                       const double rgb[3])
{
    if (!extend(scene, capacity))
        return false;
    scene->colors[scene->position_count - 1] =
        v3(at_least_zero(rgb[0]), at_least_zero(rgb[1]), at_least_zero(rgb[2]));
    return true;
}

static float decoded(float x, float white)
{
    return (float)color_decoded((double)f_min(x / white, 1.0f));
}

bool vertex_colors_finish(struct scene *scene, size_t *capacity)
{
    float white = 1.0f;

    if (scene->colors == NULL)
        return true;
    if (!extend(scene, capacity))
        return false;
    for (size_t i = 0; i < scene->color_count; i++)
        if (v3_max_component(scene->colors[i]) > 1.0f)
            white = 255.0f;
    for (size_t i = 0; i < scene->color_count; i++) {
        struct vec3 *c = &scene->colors[i];

        *c = c->x == NO_COLOR ? v3(1.0f, 1.0f, 1.0f)
                              : v3(decoded(c->x, white), decoded(c->y, white),
                                   decoded(c->z, white));
    }
    return true;
}
