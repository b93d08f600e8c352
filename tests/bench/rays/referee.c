// SPDX-License-Identifier: MIT
#include "referee.h"

#include <float.h>
#include <math.h>

#include "kernels/instance.h"

/* Margin of tests in double, far above its errors and those of rounded corners.
 */
#define MARGIN 1e-6

__extension__ typedef __float128 wide;

struct point {
    wide x[3];
};

bool referee_is_same(float a, float b)
{
    if (a >= FLT_MAX || b >= FLT_MAX)
        return a >= FLT_MAX && b >= FLT_MAX;
    return fabsf(a - b) <= T_TOLERANCE * fmaxf(a, b) + T_ROUNDING;
}

static struct point point_of(struct vec3 p)
{
    return (struct point){{p.x, p.y, p.z}};
}

static wide dot(struct point a, struct point b)
{
    return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

static struct point sub(struct point a, struct point b)
{
    return (struct point){{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}

static struct point cross(struct point a, struct point b)
{
    return (struct point){{a.x[1] * b.x[2] - a.x[2] * b.x[1],
                           a.x[2] * b.x[0] - a.x[0] * b.x[2],
                           a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

/* Moves a corner of a mesh to its place, or not without an instance. */
static struct point place(const struct instance *at, struct vec3 p,
                          bool is_rounded)
{
    struct point from = point_of(p), to = from;

    if (at != NULL && is_rounded)
        return point_of(instance_point(*at, p));
    for (int i = 0; at != NULL && i < 3; i++)
        to.x[i] = dot(point_of(at->rows[i]), from) + (&at->origin.x)[i];
    return to;
}

/* Returns the distance to the triangle, or -1 if the ray misses it. Edges and
 * corners belong to it. */
static wide distance_of(const struct ray *r, const struct point p[3])
{
    struct point o = point_of(r->o), d = point_of(r->d);
    struct point a = sub(p[0], o), b = sub(p[1], o), c = sub(p[2], o);
    struct point n = cross(sub(p[1], p[0]), sub(p[2], p[0]));
    wide u = dot(d, cross(b, c)), v = dot(d, cross(c, a)),
         w = dot(d, cross(a, b));

    if (((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) ||
        dot(n, d) == 0)
        return -1;
    return dot(n, a) / dot(n, d);
}

/* Moves a corner in double, for tests with a margin. */
static void place_near(const struct instance *at, struct vec3 p, double to[3])
{
    const double from[3] = {(double)p.x, (double)p.y, (double)p.z};

    for (int i = 0; i < 3; i++)
        to[i] = at == NULL ? from[i]
                           : (double)at->rows[i].x * from[0] +
                                 (double)at->rows[i].y * from[1] +
                                 (double)at->rows[i].z * from[2] +
                                 (double)(&at->origin.x)[i];
}

/* Returns true if a ray may meet the box of these points. */
static bool may_meet(const struct ray *r, double p[][3], int count)
{
    const double o[3] = {(double)r->o.x, (double)r->o.y, (double)r->o.z};
    const double d[3] = {(double)r->d.x, (double)r->d.y, (double)r->d.z};
    double enter = -MARGIN, leave = DBL_MAX;

    for (int k = 0; k < 3; k++) {
        double lo = DBL_MAX, hi = -DBL_MAX;

        for (int i = 0; i < count; i++) {
            lo = p[i][k] < lo ? p[i][k] : lo;
            hi = p[i][k] > hi ? p[i][k] : hi;
        }
        lo -= MARGIN + o[k];
        hi += MARGIN - o[k];
        if (d[k] == 0 && (lo > 0 || hi < 0))
            return false;
        if (d[k] == 0)
            continue;
        enter = fmax(enter, fmin(lo / d[k], hi / d[k]) - MARGIN);
        leave = fmin(leave, fmax(lo / d[k], hi / d[k]) + MARGIN);
    }
    return enter <= leave;
}

/* Lowers *least to the distance of the nearest of consecutive triangles. */
static void look_at(const struct world *w, const struct ray *r,
                    const struct instance *at, uint32_t first, uint32_t count,
                    bool is_rounded, wide *least)
{
    for (uint32_t i = first; i < first + count; i++) {
        double near[3][3];
        struct point p[3];
        wide t;

        for (int k = 0; k < 3; k++)
            place_near(at, w->positions[w->tris[i].v[k]], near[k]);
        if (!may_meet(r, near, 3))
            continue;
        for (int k = 0; k < 3; k++)
            p[k] = place(at, w->positions[w->tris[i].v[k]], is_rounded);
        t = distance_of(r, p);
        if (t > 0 && t < *least)
            *least = t;
    }
}

/* The corners of the box of an instance's mesh, in their places. */
static void box_of(const struct world *w, const struct instance *at,
                   double corners[8][3])
{
    static uint32_t mesh = NO_INDEX;
    static struct vec3 lo, hi;

    if (mesh != at->mesh) {
        mesh = at->mesh;
        lo = v3(FLT_MAX, FLT_MAX, FLT_MAX);
        hi = v3(-FLT_MAX, -FLT_MAX, -FLT_MAX);
        for (uint32_t i = at->mesh_tri; i < at->mesh_tri + at->tri_count; i++)
            for (int k = 0; k < 3; k++) {
                lo = v3_min(lo, w->positions[w->tris[i].v[k]]);
                hi = v3_max(hi, w->positions[w->tris[i].v[k]]);
            }
    }
    for (int i = 0; i < 8; i++)
        place_near(at,
                   v3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y,
                      i & 4 ? hi.z : lo.z),
                   corners[i]);
}

float referee_distance(const struct world *w, const struct ray *r,
                       bool is_rounded)
{
    wide least = r->t_max;
    double corners[8][3];

    look_at(w, r, NULL, 0, plain_tri_count(w), is_rounded, &least);
    for (uint32_t i = 0; i < w->settings.instance_count; i++) {
        const struct instance *at = &w->instances[i];

        box_of(w, at, corners);
        if (may_meet(r, corners, 8))
            look_at(w, r, at, at->mesh_tri, at->tri_count, is_rounded, &least);
    }
    return (float)least;
}
