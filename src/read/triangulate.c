// SPDX-License-Identifier: MIT
#include "read/triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Polygons with more corners are triangulated by the sweep: a large fan has
 * long thin triangles, which are slow to trace. */
#define EAR_CORNERS_MAX 100

/* Limits on the corner tests of ear clipping, after which ears are no longer
 * tested. They bound the time by the size of the file. */
#define WORK_MIN         20000
#define WORK_PER_CORNER  1000
#define WORK_CORNERS_MAX 1024

/* Most triangles made of an outline that crosses itself. They overlap, so a ray
 * may meet most of them; larger outlines lose corners instead. */
#define CROSSING_TRIANGLES_MAX 1000

/* Relative rounding error of coordinates: a few units in the last place of a
 * double. */
#define ROUNDING 1e-15

/* Corners tested in vain before the search for ears stays beside the last
 * one. */
#define SCARCE_MISSES 16

/* Value of next[] for a corner that is not in the ring. */
#define NOT_LINKED 0xffffffffu

/* Relative rounding error of the products in turn(): a few dozen roundings. */
#define STRAIGHT 1e-14

/* Tests for an ear, from the strictest to none. They are tried in this
 * order. */
enum ear_rule {
    EAR_CLEAR,   /* no corner inside or on its edges */
    EAR_TOUCHED, /* corners on its edges are allowed */
    EAR_CONVEX,  /* any left turn, for outlines that cross themselves */
    EAR_ANY
};

/* Axis-parallel projection plane: the two axes that are kept, and the scale
 * that brings the corners near 1. */
struct plane {
    double scale;
    int x, y;
};

static bool reserve(struct polygon *g, uint32_t corner_count)
{
    size_t n = corner_count;

    if (n <= g->capacity)
        return true;
    n = n < 2 * g->capacity ? 2 * g->capacity : n;
    n = n < 64 ? 64 : n;
    polygon_free(g);
    g->triangles = alloc_array(2 * n, sizeof *g->triangles);
    g->points = alloc_array(n, sizeof *g->points);
    g->prev = alloc_array(n, sizeof *g->prev);
    g->next = alloc_array(n, sizeof *g->next);
    g->is_reflex = alloc_array(n, sizeof *g->is_reflex);
    g->reflex = alloc_array(n, sizeof *g->reflex);
    if (!g->triangles || !g->points || !g->prev || !g->next || !g->is_reflex ||
        !g->reflex) {
        polygon_free(g);
        return false;
    }
    g->capacity = n;
    return true;
}

void polygon_free(struct polygon *g)
{
    free(g->triangles);
    free(g->points);
    free(g->prev);
    free(g->next);
    free(g->is_reflex);
    free(g->reflex);
    memset(g, 0, sizeof *g);
}

static void emit(struct polygon *g, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *t = g->triangles[g->triangle_count++];

    t[0] = a;
    t[1] = b;
    t[2] = c;
}

static bool emit_fan(struct polygon *g, uint32_t n)
{
    uint32_t step = 1 + n / CROSSING_TRIANGLES_MAX;

    for (uint32_t i = 1; i < n - 1; i += step)
        emit(g, 0, i, i + step < n ? i + step : n - 1);
    return true;
}

/* Returns the power of two that brings the corners near 1, so that products of
 * coordinates neither overflow nor vanish. */
static double scale_of(const double *corners, uint32_t n)
{
    double most = 0;
    int exponent;

    for (size_t i = 0; i < 3 * (size_t)n; i++)
        most = fmax(most, fabs(corners[i]));
    if (most > 1e-50 && most < 1e50)
        return 1;
    frexp(most, &exponent);
    return ldexp(1, exponent < -1000 ? 1000 : -exponent);
}

/* Returns corner i relative to corner 0. */
static void offset(const double *corners, double scale, uint32_t i,
                   double to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = corners[3 * (size_t)i + k] * scale - corners[k] * scale;
}

/* Computes twice the area as a vector with Newell's method, which also suits
 * corners that are not quite in a plane. */
static void area_vector(const double *corners, double scale, uint32_t n,
                        double area[3])
{
    double p[3] = {0};

    memset(area, 0, 3 * sizeof *area);
    for (uint32_t i = 1; i < n; i++) {
        double q[3];

        offset(corners, scale, i, q);
        area[0] += p[1] * q[2] - p[2] * q[1];
        area[1] += p[2] * q[0] - p[0] * q[2];
        area[2] += p[0] * q[1] - p[1] * q[0];
        memcpy(p, q, sizeof p);
    }
}

/* Chooses the projection plane in which the outline is counter-clockwise.
 * Returns false if the polygon has no area. Dropping one axis suffices, since
 * lines stay lines. */
static bool find_plane(struct plane *plane, const double *corners, uint32_t n)
{
    double area[3];
    int axis = 0;

    plane->scale = scale_of(corners, n);
    area_vector(corners, plane->scale, n, area);
    for (int k = 1; k < 3; k++)
        axis = fabs(area[k]) > fabs(area[axis]) ? k : axis;
    plane->x = (axis + (area[axis] < 0 ? 2 : 1)) % 3;
    plane->y = (axis + (area[axis] < 0 ? 1 : 2)) % 3;
    return fabs(area[axis]) > 0;
}

static void project(struct polygon *g, const struct plane *plane,
                    const double *corners, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        double p[3];

        offset(corners, plane->scale, i, p);
        g->points[i] = (struct point2){p[plane->x], p[plane->y]};
    }
}

/* Returns the bound on rounding errors of the projected corners. */
static struct point2 noise_of(const struct plane *plane, const double *corners,
                              uint32_t n)
{
    struct point2 most = {0, 0};

    for (size_t i = 0; i < n; i++) {
        most.x = fmax(most.x, fabs(corners[3 * i + plane->x]));
        most.y = fmax(most.y, fabs(corners[3 * i + plane->y]));
    }
    return (struct point2){ROUNDING * (plane->scale * most.x),
                           ROUNDING * (plane->scale * most.y)};
}

/* Returns a positive number if a, b, c turn left, a negative one if they turn
 * right. Results within the rounding error are 0: otherwise tests of collinear
 * points contradict each other (a hole that touches a cut once led to a
 * triangle across the hole). */
static double turn(const struct polygon *g, uint32_t a, uint32_t b, uint32_t c)
{
    struct point2 p = g->points[a];
    struct point2 q = g->points[b];
    struct point2 r = g->points[c];
    double left = (q.x - p.x) * (r.y - p.y);
    double right = (q.y - p.y) * (r.x - p.x);
    double rounding = STRAIGHT * (fabs(left) + fabs(right));

    return fabs(left - right) > rounding ? left - right : 0;
}

/* Returns true if every corner turns left and the outline goes around once. A
 * pentagram turns left as well but changes from falling to rising twice. */
static bool is_convex(const struct polygon *g, uint32_t n)
{
    int rises = 0;
    bool was_down = g->points[0].y < g->points[n - 1].y;

    for (uint32_t i = 0; i < n; i++) {
        uint32_t j = i + 1 == n ? 0 : i + 1;
        uint32_t k = j + 1 == n ? 0 : j + 1;
        bool is_down = g->points[j].y < g->points[i].y;

        if (!(turn(g, i, j, k) > 0))
            return false;
        rises += was_down && !is_down;
        was_down = is_down;
    }
    return rises == 1;
}

static bool same_corner(const double *corners, uint32_t a, uint32_t b)
{
    return memcmp(corners + 3 * (size_t)a, corners + 3 * (size_t)b,
                  3 * sizeof *corners) == 0;
}

/* Links the corners into a ring, without repeated ones. Returns the number of
 * corners in the ring. */
static uint32_t link_corners(struct polygon *g, const double *corners,
                             uint32_t n)
{
    uint32_t count = 1;
    uint32_t last = 0;

    for (uint32_t i = 1; i < n; i++) {
        g->next[i] = NOT_LINKED;
        if (same_corner(corners, last, i))
            continue;
        g->next[last] = i;
        g->prev[i] = last;
        last = i;
        count++;
    }
    if (count > 1 && same_corner(corners, last, 0)) {
        g->next[last] = NOT_LINKED;
        last = g->prev[last];
        count--;
    }
    g->next[last] = 0;
    g->prev[0] = last;
    return count;
}

static void list_reflex_corners(struct polygon *g)
{
    uint32_t i = 0;

    g->reflex_count = 0;
    do {
        g->is_reflex[i] = !(turn(g, g->prev[i], i, g->next[i]) > 0);
        if (g->is_reflex[i])
            g->reflex[g->reflex_count++] = i;
        i = g->next[i];
    } while (i != 0);
}

static bool same_point(struct point2 a, struct point2 b)
{
    return a.x == b.x && a.y == b.y;
}

/* Returns true if corner p keeps a, b, c from being an ear. */
static bool is_in_the_way(const struct polygon *g, enum ear_rule rule,
                          const uint32_t ear[3], uint32_t p)
{
    struct point2 at = g->points[p];
    double ab = turn(g, ear[0], ear[1], p);
    double bc = turn(g, ear[1], ear[2], p);
    double ca = turn(g, ear[2], ear[0], p);

    if (rule == EAR_TOUCHED)
        return ab > 0 && bc > 0 && ca > 0;
    return ab >= 0 && bc >= 0 && ca >= 0 &&
           !same_point(at, g->points[ear[0]]) &&
           !same_point(at, g->points[ear[1]]) &&
           !same_point(at, g->points[ear[2]]);
}

static double least(double a, double b, double c)
{
    double ab = a < b ? a : b;

    return ab < c ? ab : c;
}

/* Returns true if no reflex corner is in the way of the ear. The box test
 * excludes corners far away on the line of a needle, which rounding may put on
 * all three edges. */
static bool is_empty_ear(struct polygon *g, enum ear_rule rule,
                         const uint32_t ear[3])
{
    struct point2 a = g->points[ear[0]];
    struct point2 b = g->points[ear[1]];
    struct point2 c = g->points[ear[2]];
    struct point2 low = {least(a.x, b.x, c.x), least(a.y, b.y, c.y)};
    struct point2 high = {-least(-a.x, -b.x, -c.x), -least(-a.y, -b.y, -c.y)};

    for (uint32_t i = 0; i < g->reflex_count; i++) {
        uint32_t p = g->reflex[i];
        struct point2 at = g->points[p];

        g->work++;
        if (at.x < low.x || at.x > high.x || at.y < low.y || at.y > high.y ||
            g->next[p] == NOT_LINKED || !g->is_reflex[p] || p == ear[0] ||
            p == ear[1] || p == ear[2])
            continue;
        if (is_in_the_way(g, rule, ear, p))
            return false;
    }
    return true;
}

/* Returns true if the cut from a to c starts inside the outline at both ends.
 * Points alone cannot tell where corners coincide, as at a bridge to a hole. At
 * a reflex corner everything left of the edge to b is inside. */
static bool cut_is_inside(const struct polygon *g, enum ear_rule rule,
                          uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t before = g->prev[a];
    uint32_t after = g->next[c];
    double at_a = turn(g, before, a, b) < 0 ? 1 : turn(g, before, a, c);
    double at_c = turn(g, b, c, after) < 0 ? 1 : turn(g, a, c, after);

    if (rule == EAR_TOUCHED)
        return at_a >= 0 && at_c >= 0;
    return at_a > 0 && at_c > 0;
}

static bool is_ear(struct polygon *g, enum ear_rule rule, uint32_t b)
{
    uint32_t ear[3] = {g->prev[b], b, g->next[b]};

    if (rule == EAR_ANY)
        return true;
    if (!(turn(g, ear[0], b, ear[2]) > 0))
        return false;
    return rule == EAR_CONVEX || (cut_is_inside(g, rule, ear[0], b, ear[2]) &&
                                  is_empty_ear(g, rule, ear));
}

static void unlink_corner(struct polygon *g, uint32_t b)
{
    uint32_t a = g->prev[b];
    uint32_t c = g->next[b];

    g->next[a] = c;
    g->prev[c] = a;
    g->next[b] = NOT_LINKED;
    g->is_reflex[a] = !(turn(g, g->prev[a], a, c) > 0);
    g->is_reflex[c] = !(turn(g, a, c, g->next[c]) > 0);
}

/* Cuts ears until a triangle is left. The next candidate is not beside the last
 * ear, which would make a fan of slivers. On long straight sides and in narrow
 * corridors the only ears are at the ends of the last cut: there the search
 * alternates between both ends. */
static void cut_ring(struct polygon *g, uint32_t count)
{
    uint64_t work_max =
        WORK_MIN +
        WORK_PER_CORNER * (count < WORK_CORNERS_MAX ? count : WORK_CORNERS_MAX);
    enum ear_rule rule = EAR_CLEAR;
    uint32_t misses = 0;
    uint32_t b = 0;
    bool is_scarce = false;
    bool is_back = false;

    for (g->work = 0; count > 3; g->work++) {
        uint32_t a = g->prev[b];
        uint32_t c = g->next[b];

        if (g->work > work_max)
            rule = EAR_ANY;
        if (!is_ear(g, rule, b)) {
            b = is_back ? a : c;
            if (++misses % count == 0)
                rule++;
            continue;
        }
        g->crosses_itself |= turn(g, a, b, c) < 0 || rule == EAR_CONVEX;
        if (rule < EAR_CONVEX || count <= CROSSING_TRIANGLES_MAX)
            emit(g, a, b, c);
        unlink_corner(g, b);
        count--;
        if (misses > 1) /* the ear was at neither end of the last cut */
            is_scarce = misses > SCARCE_MISSES;
        is_back = is_scarce && !is_back;
        b = !is_scarce ? g->next[c] : is_back ? c : a;
        misses = 0;
        rule = EAR_CLEAR;
    }
    g->crosses_itself |= turn(g, g->prev[b], b, g->next[b]) < 0;
    emit(g, g->prev[b], b, g->next[b]);
}

static void cut_ears(struct polygon *g, const double *corners, uint32_t n)
{
    uint32_t count = link_corners(g, corners, n);

    g->triangle_count = 0;
    g->crosses_itself = false;
    if (count < 3) {
        emit_fan(g, 3);
        return;
    }
    list_reflex_corners(g);
    cut_ring(g, count);
}

bool polygon_triangulate(struct polygon *g, const double *corners, uint32_t n)
{
    enum monotone_result result;
    struct plane plane;

    if (!reserve(g, n))
        return false;
    g->triangle_count = 0;
    g->crosses_itself = false;
    if (n == 3 || !find_plane(&plane, corners, n))
        return emit_fan(g, n);
    project(g, &plane, corners, n);
    if (n <= EAR_CORNERS_MAX) {
        if (is_convex(g, n))
            return emit_fan(g, n);
        cut_ears(g, corners, n);
        if (!g->crosses_itself)
            return true;
    }
    result = monotone_cut(g->points, n, noise_of(&plane, corners, n),
                          g->triangles, &g->triangle_count);
    g->crosses_itself = result == MONOTONE_CROSSING;
    if (g->crosses_itself) {
        cut_ears(g, corners, n);
        g->crosses_itself = true;
    }
    return result != MONOTONE_NO_MEMORY;
}
