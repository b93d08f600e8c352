// SPDX-License-Identifier: MIT
#include "studio/pick.h"

#include <math.h>

#include "kernels/camera.h"
#include "kernels/hit.h"
#include "kernels/texture.h"

/* Least opacity that counts as opaque. */
#define SOLID 0.5f

/* Finds the hit of least t, and of the lowest triangle number at equal t, like
 * the traversal of the tree. Returns false if there is none. */
static bool closest_hit(const struct world *w, struct ray ray, struct hit *best)
{
    struct shear shear = shear_of(ray);

    best->t = ray.t_max;
    best->tri = NO_INDEX;
    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        const uint32_t *v = w->tris[i].v;
        struct hit h = {.tri = i};

        if (triangle_hit(ray, shear, w->positions[v[0]], w->positions[v[1]],
                         w->positions[v[2]], best->t, &h) &&
            h.t < best->t && coverage_at(w, h) >= SOLID)
            *best = h;
    }
    return best->tri != NO_INDEX;
}

static struct vec3 point_of(const struct world *w, struct hit h)
{
    const uint32_t *v = w->tris[h.tri].v;
    struct vec3 error;

    return hit_point(h, w->positions[v[0]], w->positions[v[1]],
                     w->positions[v[2]], &error);
}

static void file_point(const struct scene *scene, struct vec3 p,
                       double point[3])
{
    point[0] = p.x / scene->scale + scene->center[0];
    point[1] = p.y / scene->scale + scene->center[1];
    point[2] = p.z / scene->scale + scene->center[2];
}

bool pick_at(const struct scene *scene, const struct host_world *host,
             const struct view *view, double x_px, double y_px,
             struct pick *pick)
{
    struct world world;
    struct error err;
    struct hit hit;

    if (!(x_px >= 0 && x_px < view->width_px && y_px >= 0 &&
          y_px < view->height_px) ||
        !world_lend(host, scene, view, 0, &world, &err))
        return false;
    uint32_t x = (uint32_t)x_px;
    uint32_t y = (uint32_t)y_px;
    struct vec2 offset = {(float)(x_px - x), (float)(y_px - y)};
    struct ray ray = camera_ray(world.settings.camera, x, y, offset);
    if (!closest_hit(&world, ray, &hit))
        return false;
    *pick = (struct pick){
        .tri = hit.tri,
        .face = scene->tri_faces[hit.tri],
        .object = scene->tri_objects[hit.tri],
        .material = world.tris[hit.tri].material,
        .distance = hit.t / scene->scale,
    };
    file_point(scene, point_of(&world, hit), pick->position);
    return true;
}

void pick_bounds(const struct scene *scene, uint32_t object, double lo[3],
                 double hi[3])
{
    bool is_first = true;

    for (uint32_t i = 0; i < scene->tri_count; i++) {
        for (int c = 0; c < 3 && scene->tri_objects[i] == object; c++) {
            double point[3];

            file_point(scene, scene->positions[scene->tris[i].v[c]], point);
            for (int k = 0; k < 3; k++) {
                lo[k] = is_first ? point[k] : fmin(lo[k], point[k]);
                hi[k] = is_first ? point[k] : fmax(hi[k], point[k]);
            }
            is_first = false;
        }
    }
}

bool pick_point_of_cell(const struct cells_rect *fit, int width_px,
                        int height_px, int col, int row, double *x_px,
                        double *y_px)
{
    if (col < fit->col || col >= fit->col + fit->cols || row < fit->row ||
        row >= fit->row + fit->rows)
        return false;
    *x_px = (col - fit->col + 0.5) * width_px / fit->cols;
    *y_px = (row - fit->row + 0.5) * height_px / fit->rows;
    return true;
}
