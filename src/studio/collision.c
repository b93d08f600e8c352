// SPDX-License-Identifier: MIT
#include "studio/collision.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"

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
