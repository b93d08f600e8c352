// SPDX-License-Identifier: MIT
#include "read/vertex_colors.h"

#include "base/memory.h"
#include "image/color.h"

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
