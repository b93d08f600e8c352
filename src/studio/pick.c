// SPDX-License-Identifier: MIT
#include "studio/pick.h"

#include <math.h>

#include "studio/surfaces.h"
#include "kernels/camera.h"
#include "kernels/hit.h"
#include "kernels/instance.h"
#include "kernels/texture.h"

/* Finds the hit of least t, and of the lowest triangle number at equal t, like
 * the traversal of the tree. Returns false if there is none. */
static bool closest_hit(const struct world *w, struct ray ray, struct hit *best)
{
    struct shear shear = shear_of(ray);

    best->t = ray.t_max;
    best->tri = NO_INDEX;
    for (uint32_t i = 0; i < all_tri_count(w); i++) {
        struct placed_tri t = tri_placed(w, i);
        struct hit h = {.tri = i};

        if (triangle_hit(ray, shear, t.p[0], t.p[1], t.p[2], best->t, &h) &&
            h.t < best->t && coverage_at(w, h) >= SURFACE_OPACITY)
            *best = h;
    }
    return best->tri != NO_INDEX;
}

static struct vec3 point_of(const struct world *w, struct hit h)
{
    struct placed_tri t = tri_placed(w, h.tri);
    struct vec3 error;

    return hit_point(h, t.p[0], t.p[1], t.p[2], &error);
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
        .face = scene->tri_faces[scene_tri_index(scene, hit.tri)],
        .object = scene_tri_object(scene, hit.tri),
        .material = tri_placed(&world, hit.tri).t.material,
        .distance = hit.t / scene->scale,
    };
    scene_file_point(scene, point_of(&world, hit), pick->position);
    return true;
}

/* Joins a box, which is empty until *has_points is true, with the corners of a
 * triangle. */
static void join_tri(const struct scene *scene, const struct placed_tri *t,
                     double lo[3], double hi[3], bool *has_points)
{
    for (int c = 0; c < 3; c++) {
        double point[3];

        scene_file_point(scene, t->p[c], point);
        for (int k = 0; k < 3; k++) {
            lo[k] = *has_points ? fmin(lo[k], point[k]) : point[k];
            hi[k] = *has_points ? fmax(hi[k], point[k]) : point[k];
        }
        *has_points = true;
    }
}

void pick_bounds(const struct scene *scene, uint32_t object, double lo[3],
                 double hi[3])
{
    const struct world w = scene_shape(scene);
    struct tri_run run = {0};
    bool has_points = false;

    while (scene_next_run(scene, object, &run))
        for (uint32_t i = 0; i < run.count; i++) {
            struct placed_tri t = tri_placed(&w, run.first + i);

            join_tri(scene, &t, lo, hi, &has_points);
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
