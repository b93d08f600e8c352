// SPDX-License-Identifier: MIT
/*
 * outlines.h - polygons to triangulate, and a check of their triangles
 *
 * Ownership: the caller frees the points
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_OUTLINES_H
#define TESTS_OUTLINES_H

#include <math.h>
#include <stdlib.h>

#include "read/triangulate.h"
#include "tests/unit/check.h"

#define PI 3.14159265358979323846

/* A polygon in the plane z = 0. */
struct outline {
    double *points; /* three numbers for each corner */
    uint32_t count;
};

static inline struct outline outline_of(uint32_t capacity)
{
    struct outline o = {calloc(3 * (size_t)capacity, sizeof(double)), 0};

    assert_non_null(o.points);
    return o;
}

static inline void add_point(struct outline *o, double x, double y)
{
    o->points[3 * (size_t)o->count] = x;
    o->points[3 * (size_t)o->count + 1] = y;
    o->count++;
}

/* The shoelace formula gives the signed area. */
static inline double area_of(const struct outline *o)
{
    long double sum = 0;

    for (size_t i = 0; i < o->count; i++) {
        const double *p = o->points + 3 * i;
        const double *q = o->points + 3 * ((i + 1) % o->count);

        sum += (long double)p[0] * q[1] - (long double)p[1] * q[0];
    }
    return (double)(sum / 2);
}

static inline double triangle_area(const struct outline *o, const uint32_t t[3])
{
    const double *a = o->points + 3 * (size_t)t[0];
    const double *b = o->points + 3 * (size_t)t[1];
    const double *c = o->points + 3 * (size_t)t[2];

    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

/* Triangulates the polygon. Checks that the triangles have its winding and that
 * their areas, none of them negative, sum to its area. */
static inline void check_cut(const struct outline *o, const char *name)
{
    struct polygon g = {0};
    double area = area_of(o);
    long double sum = 0;

    assert_true(polygon_triangulate(&g, o->points, o->count));
    assert_in_range(g.triangle_count, 1, o->count - 2);
    for (uint32_t i = 0; i < g.triangle_count; i++) {
        for (int k = 0; k < 3; k++)
            assert_in_range(g.triangles[i][k], 0, o->count - 1);
        sum += fabs(triangle_area(o, g.triangles[i]));
        if (triangle_area(o, g.triangles[i]) * area < -1e-15 * area * area) {
            print_error("%s, %u corners: triangle %u has area %g\n", name,
                        o->count, i, triangle_area(o, g.triangles[i]));
            _fail(__FILE__, __LINE__);
        }
    }
    check_close((double)sum, fabs(area), 1e-12 * fabs(area));
    assert_false(g.crosses_itself);
    polygon_free(&g);
}

#endif
