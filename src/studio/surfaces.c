// SPDX-License-Identifier: MIT
#include "studio/surfaces.h"

#include <math.h>

#include "base/geometry.h"
#include "bvh/bvh8_traverse.h"
#include "kernels/instance.h"
#include "kernels/texture.h"

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
    double passed = 0;

    if (w.tree == NULL || !isfinite(ray.o.x + ray.o.y + ray.o.z))
        return false;
    for (int i = 0; i < LAYERS_MOST; i++) {
        struct hit h;

        if (!hit_closest(&w.world, ray, &h))
            return false;
        passed += h.t;
        if (stops(&w.world, h, glass)) {
            hit->distance = passed / s->scene->scale;
            hit->object = scene_tri_object(s->scene, h.tri);
            set_normal(&w.world, h, d, hit->normal);
            return true;
        }
        ray.o = v3_add(ray.o, v3_scale(ray.d, h.t));
        ray.from = 1 + h.tri;
        ray.t_max -= h.t;
    }
    return false;
}

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
