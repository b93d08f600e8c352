// SPDX-License-Identifier: MIT
#include "studio/surfaces.h"

#include <math.h>

#include "base/geometry.h"
#include "bvh/bvh8_traverse.h"
#include "kernels/camera.h"
#include "kernels/hit.h"
#include "kernels/instance.h"
#include "kernels/texture.h"

/* Rays of a clearance. */
#define RAYS 64

/* Rank of the ray whose length is `near`: the seventh shortest of 64, a tenth.
 * Fewer rays hit leaves and wires. Above a floor at height h it is 1.28 h
 * long. */
#define NEAR_RAY 6

/* Turns between successive directions: 1 / golden ratio. */
#define TURN 0.61803398874989485

/* Most holes and panes that a ray passes. */
#define LAYERS_MOST 256

static bool is_glass(const struct material *m)
{
    return m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS ||
           m->transmission > 0.0f;
}

static bool stops(const struct world *w, struct hit h, enum surface_glass glass)
{
    const struct material *m =
        &w->materials[tri_at(w, h.tri, instance_of(w, h.tri)).material];

    return coverage_at(w, h) >= SURFACE_OPACITY &&
           !(glass == SURFACE_GLASS_PASSES && is_glass(m));
}

/* Sets the normal on the side that d comes from. A triangle without area has
 * the direction of the ray. */
static void set_normal(const struct world *w, struct hit h, const double d[3],
                       double normal[3])
{
    struct placed_tri t = tri_placed(w, h.tri);
    struct vec3 n = {0};
    double sign;

    if (!triangle_normal(t.p[0], t.p[1], t.p[2], &n))
        n = v3((float)-d[0], (float)-d[1], (float)-d[2]);
    sign = n.x * d[0] + n.y * d[1] + n.z * d[2] > 0 ? -1 : 1;
    normal[0] = sign * n.x;
    normal[1] = sign * n.y;
    normal[2] = sign * n.z;
    vec3d_normalize(normal);
}

/* Finds the first surface on a ray in normalised units. hit->t is its distance
 * from the ray's origin. */
static bool first_surface(struct bvh8_world *w, struct ray ray,
                          enum surface_glass glass, struct hit *hit)
{
    float passed = 0;

    /* else partial coverage would let rays pass by chance */
    w->world.settings.features &= ~(uint32_t)FEATURE_COVERAGE;
    if (w->tree == NULL || !isfinite(ray.o.x + ray.o.y + ray.o.z))
        return false;
    for (int i = 0; i < LAYERS_MOST; i++) {
        float t;

        if (!hit_closest(&w->world, ray, hit))
            return false;
        t = hit->t;
        hit->t += passed;
        if (stops(&w->world, *hit, glass))
            return true;
        passed = hit->t;
        ray.o = v3_add(ray.o, v3_scale(ray.d, t));
        ray.from = 1 + hit->tri;
        ray.t_max -= t;
    }
    return false;
}

bool surfaces_hit(const struct surfaces *s, const double from[3],
                  const double d[3], double most, enum surface_glass glass,
                  struct surface_hit *hit)
{
    struct bvh8_world w = {.world = world_arrays(s->host, s->scene),
                           .tree = world_tree(s->host)};
    struct ray ray = {
        .o = scene_point(s->scene, from),
        .d = v3((float)d[0], (float)d[1], (float)d[2]),
        .t_max = (float)fmin(most * s->scene->scale, FLOAT_MAX),
    };
    struct hit h;

    if (!first_surface(&w, ray, glass, &h))
        return false;
    hit->distance = h.t / s->scene->scale;
    hit->object = scene_tri_object(s->scene, h.tri);
    set_normal(&w.world, h, d, hit->normal);
    return true;
}

bool surfaces_pick(const struct surfaces *s, const struct view *view,
                   double x_px, double y_px, struct pick *pick)
{
    const struct scene *scene = s->scene;
    struct bvh8_world w = {.tree = world_tree(s->host)};
    struct vec3 ignored;
    struct error err;
    struct hit h;

    if (!(x_px >= 0 && x_px < view->width_px && y_px >= 0 &&
          y_px < view->height_px) ||
        !world_lend(s->host, scene, view, 0, &w.world, &err))
        return false;
    uint32_t x = (uint32_t)x_px;
    uint32_t y = (uint32_t)y_px;
    struct vec2 offset = {(float)(x_px - x), (float)(y_px - y)};
    struct ray ray = camera_ray(w.world.settings.camera, x, y, offset);
    if (!first_surface(&w, ray, SURFACE_GLASS_STOPS, &h))
        return false;
    struct placed_tri t = tri_placed(&w.world, h.tri);
    *pick = (struct pick){
        .tri = h.tri,
        .face = scene->tri_faces[scene_tri_index(scene, h.tri)],
        .object = scene_tri_object(scene, h.tri),
        .material = t.t.material,
        .distance = h.t / scene->scale,
    };
    scene_file_point(scene, hit_point(h, t.p[0], t.p[1], t.p[2], &ignored),
                     pick->position);
    return true;
}

/* ---- clearance ---- */

/* Computes direction i of a spiral from pole to pole with equal areas (Swinbank
 * and Purser 2006, "Fibonacci grids"). */
static void set_direction(int i, double d[3])
{
    double y = 1 - (2 * i + 1) / (double)RAYS;
    double angle = 2 * M_PI * TURN * i;
    double r = sqrt(1 - y * y);

    d[0] = r * cos(angle);
    d[1] = y;
    d[2] = r * sin(angle);
}

/* Inserts x into the sorted numbers and drops the greatest. */
static void insert(double *sorted, int count, double x)
{
    for (int i = 0; i < count; i++) {
        if (x < sorted[i]) {
            double other = sorted[i];

            sorted[i] = x;
            x = other;
        }
    }
}

static double distance_to_box(const struct scene *s, const double point[3])
{
    double off[3];

    for (int k = 0; k < 3; k++)
        off[k] = fmax(0, fmax(s->bounds_lo[k] - point[k],
                              point[k] - s->bounds_hi[k]));
    return vec3d_length(off);
}

struct clearance surfaces_clearance(const struct surfaces *s,
                                    const double point[3])
{
    double nearest[NEAR_RAY + 1];
    int hits = 0;

    for (int i = 0; i <= NEAR_RAY; i++)
        nearest[i] = INFINITY;
    for (int i = 0; i < RAYS; i++) {
        struct surface_hit hit;
        double d[3];

        set_direction(i, d);
        if (!surfaces_hit(s, point, d, INFINITY, SURFACE_GLASS_STOPS, &hit))
            continue;
        hits++;
        insert(nearest, NEAR_RAY + 1, hit.distance);
    }
    return (struct clearance){
        .nearest = nearest[0],
        .near = nearest[NEAR_RAY],
        .box_distance = distance_to_box(s->scene, point),
        .hit_share = (double)hits / RAYS,
    };
}

/* ---- sizes ---- */

double surfaces_size(const struct surfaces *s)
{
    double diagonal[3];

    vec3d_sub(s->scene->bounds_hi, s->scene->bounds_lo, diagonal);
    return vec3d_length(diagonal);
}

void point_along(const double from[3], const double d[3], double distance,
                 double point[3])
{
    for (int i = 0; i < 3; i++)
        point[i] = from[i] + distance * d[i];
}
