// SPDX-License-Identifier: MIT
#include "studio/camera/surfaces.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "world/bvh/ray_queries.h"
#include "kernels/camera.h"
#include "kernels/hit.h"
#include "kernels/instance.h"
#include "kernels/texture.h"

/* ---- rays ---- */

/* Rays of a clearance. */
#define RAYS 64

/* Rank of the ray whose length is `near`: the seventh shortest of 64, a tenth.
 * Fewer rays hit leaves and wires. Above a floor at height h it is 1.28 h
 * long. */
#define NEAR_RAY 6

/* Turns between successive directions: 1 / golden ratio. */
#define TURN 0.61803398874989485

/* Most holes and panes that a ray passes. */
#define LAYERS_MAX 256

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
static bool first_surface(struct world *w, struct ray ray,
                          enum surface_glass glass, struct hit *hit)
{
    float passed = 0;

    /* else partial coverage would let rays pass by chance */
    w->settings.features &= ~FEATURE_COVERAGE;
    if (w->nodes == NULL || !isfinite(ray.o.x + ray.o.y + ray.o.z))
        return false;
    for (int i = 0; i < LAYERS_MAX; i++) {
        float t;

        if (!hit_closest(w, ray, hit))
            return false;
        t = hit->t;
        hit->t += passed;
        if (stops(w, *hit, glass))
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
    struct world w = world_arrays(s->host, s->scene);
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
    set_normal(&w, h, d, hit->normal);
    return true;
}

bool surfaces_pick(const struct surfaces *s, const struct view *view,
                   double x_px, double y_px, struct pick *pick)
{
    const struct scene *scene = s->scene;
    struct world w;
    struct vec3 ignored;
    struct error err;
    struct hit h;

    if (!(x_px >= 0 && x_px < view->width_px && y_px >= 0 &&
          y_px < view->height_px) ||
        !world_lend(s->host, scene, view, 0, &w, &err))
        return false;
    uint32_t x = (uint32_t)x_px;
    uint32_t y = (uint32_t)y_px;
    struct vec2 offset = {(float)(x_px - x), (float)(y_px - y)};
    struct ray ray = camera_ray(w.settings.camera, x, y, offset);
    if (!first_surface(&w, ray, SURFACE_GLASS_STOPS, &h))
        return false;
    struct placed_tri t = tri_placed(&w, h.tri);
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

/* ---- moves ---- */

/* Length of the ray beyond the end of the way, in margins: the eye keeps the
 * margin from surfaces that it approaches at more than 1/256 rad. At less, it
 * comes nearer, but not within the rounding error of rays. */
#define BEYOND 256.0

/* Surfaces along which one move slides: three meet in a corner, and the last
 * round tests the rest of the way. */
#define ROUNDS 4

/* Share of the wanted motion below which the eye counts as stopped. */
#define STOPPED 0.25

/* Distances to the pivot that are tried, as powers of a factor: the last one is
 * a tenth. */
#define NEARER       0.85
#define NEARER_COUNT 15

/* Greatest growth of the distance to the pivot per radian of the orbit, as an
 * exponent, so that the camera returns without a jump. */
#define RETURN 1.5

static double margin_of(const struct surfaces *s)
{
    return COLLISION_MARGIN * surfaces_size(s);
}

/* Returns how far the eye can move in the unit direction d, at most `length`.
 * If that is less, *hit is the surface. */
static double free_length(const struct surfaces *s, const double from[3],
                          const double d[3], double length,
                          struct surface_hit *hit)
{
    double margin = margin_of(s), slope;

    if (!surfaces_hit(s, from, d, length + BEYOND * margin, SURFACE_GLASS_STOPS,
                      hit))
        return length;
    slope = fmax(-vec3d_dot(hit->normal, d), 1 / BEYOND);
    return fmax(0, fmin(length, hit->distance - margin / slope));
}

/* Changes the rest of the way so that it follows the surface, and keeps the
 * margin from it. `before` is the distance to the surface along d. */
static void slide_along(const struct surface_hit *hit, double before,
                        const double d[3], double margin, double way[3])
{
    double into = vec3d_dot(way, hit->normal);
    double height = -before * vec3d_dot(d, hit->normal);
    double lift = fmax(0, margin - height);

    point_along(way, hit->normal, lift - into, way);
}

bool collision_slide(const struct surfaces *s, const double from[3],
                     double to[3], uint32_t *object)
{
    double wanted[3], way[3], at[3], moved[3], length;
    bool is_blocked = false;

    vec3d_sub(to, from, wanted);
    memcpy(way, wanted, sizeof way);
    memcpy(at, from, sizeof at);
    for (int i = 0; i < ROUNDS && (length = vec3d_length(way)) > 0; i++) {
        struct surface_hit hit;
        double d[3], free;

        memcpy(d, way, sizeof d);
        if (!vec3d_normalize(d))
            break;
        free = free_length(s, at, d, length, &hit);
        point_along(at, d, free, at);
        if (!(free < length))
            break;
        if (!is_blocked)
            *object = hit.object;
        is_blocked = true;
        point_along(way, d, -free, way);
        slide_along(&hit, hit.distance - free, d, margin_of(s), way);
    }
    if (!is_blocked)
        return false;
    memcpy(to, at, sizeof at);
    vec3d_sub(at, from, moved);
    return vec3d_dot(moved, wanted) < STOPPED * vec3d_dot(wanted, wanted);
}

static bool is_free(const struct surfaces *s, const double from[3],
                    const double to[3])
{
    struct surface_hit hit;
    double d[3], length;

    vec3d_sub(to, from, d);
    length = vec3d_length(d);
    return !vec3d_normalize(d) ||
           !(free_length(s, from, d, length, &hit) < length);
}

bool collision_orbit(const struct surfaces *s, const double pivot[3],
                     double distance, const double from[3], double to[3])
{
    double before[3], after[3], near, angle;

    vec3d_sub(from, pivot, before);
    vec3d_sub(to, pivot, after);
    near = vec3d_length(before);
    if (!vec3d_normalize(before) || !vec3d_normalize(after))
        return true; /* the eye is at the pivot and stays there */
    angle = acos(fmax(-1, fmin(1, vec3d_dot(before, after))));
    distance = fmin(distance, near * exp(RETURN * angle));
    for (int i = 0; i < NEARER_COUNT; i++) {
        double in[3], turned[3], share = near * pow(NEARER, i);

        point_along(pivot, before, share, in);
        point_along(pivot, after, share, turned);
        if ((i == 0 || is_free(s, from, in)) && is_free(s, in, turned)) {
            struct surface_hit hit;

            distance = share < distance ? free_length(s, turned, after,
                                                      distance - share, &hit)
                                        : 0;
            point_along(turned, after, distance, to);
            return true;
        }
    }
    return false;
}
