// SPDX-License-Identifier: MIT
/*
 * test_triangulate_large.c - polygons of many corners, whose triangles take
 * linear time
 */
#include <time.h>

#include "tests/unit/read/outlines.h"

static void large_concave_polygons_are_quick(void **state)
{
    uint32_t n = 100000;
    struct outline o = outline_of(n);
    uint64_t random = 88172645463325252u;
    clock_t begin = clock();

    (void)state;
    for (uint32_t i = 0; i < n; i++) {
        double r;

        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        r = 1 + 0.01 * (double)(random >> 40) * 0x1p-24;
        add_point(&o, r * cos(2 * PI * i / n), r * sin(2 * PI * i / n));
    }
    check_cut(&o, "coast");
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 10);
    free(o.points);
}

/* Makes a polygon with corners along its straight sides. Those inside a side
 * belong to no ear until the triangle beside them is cut. */
static struct outline with_corners_on_sides(const double (*corners)[2],
                                            uint32_t count, uint32_t per_side)
{
    struct outline o = outline_of(count * per_side);

    for (uint32_t i = 0; i < count; i++) {
        const double *a = corners[i];
        const double *b = corners[(i + 1) % count];

        for (uint32_t k = 0; k < per_side; k++)
            add_point(&o, a[0] + (b[0] - a[0]) * k / per_side,
                      a[1] + (b[1] - a[1]) * k / per_side);
    }
    return o;
}

static void long_straight_sides_are_cut(void **state)
{
    static const double ell[6][2] = {{0, 0}, {4, 0}, {4, 1},
                                     {1, 1}, {1, 4}, {0, 4}};

    (void)state;
    for (uint32_t per_side = 5; per_side <= 5000; per_side *= 10) {
        struct outline o = with_corners_on_sides(ell, 6, per_side);

        check_cut(&o, "L with corners on its sides");
        free(o.points);
    }
}

/* A spiral band has ears only at its ends. */
static void spirals_are_cut(void **state)
{
    (void)state;
    for (uint32_t n = 50; n <= 50000; n *= 10) {
        struct outline o = outline_of(2 * n);

        for (uint32_t i = 0; i < n; i++)
            add_point(&o, 0.05 * i * cos(0.05 * i), 0.05 * i * sin(0.05 * i));
        for (uint32_t i = n; i-- > 0;)
            add_point(&o, (0.05 * i + 2) * cos(0.05 * i),
                      (0.05 * i + 2) * sin(0.05 * i));
        check_cut(&o, "spiral");
        free(o.points);
    }
}

/* One ring is wide, the other narrow. */
static void smooth_rings_are_cut(void **state)
{
    static const double inner[] = {0.5, 1.5};
    uint32_t n = 10000;

    (void)state;
    for (int k = 0; k < 2; k++) {
        struct outline o = outline_of(2 * n + 2);

        for (uint32_t i = 0; i <= n; i++)
            add_point(&o, 2 * cos(2 * PI * (i % n) / n),
                      2 * sin(2 * PI * (i % n) / n));
        for (uint32_t i = n + 1; i-- > 0;)
            add_point(&o, inner[k] * cos(2 * PI * (i % n) / n),
                      inner[k] * sin(2 * PI * (i % n) / n));
        check_cut(&o, "smooth ring");
        free(o.points);
    }
}

static void a_million_corners_are_cut(void **state)
{
    uint32_t n = 1000000;

    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct outline o = outline_of(n);

        for (uint32_t i = 0; i < n; i++) {
            double r = kind == 1 && i % 2 == 1 ? 0.2 : 1;

            add_point(&o, r * cos(2 * PI * i / n), r * sin(2 * PI * i / n));
        }
        /* Rounding to six digits, as in text files, makes the polygon not
         * strictly convex and some corners equal. */
        for (size_t i = 0; kind == 2 && i < 3 * (size_t)n; i++)
            o.points[i] = nearbyint(o.points[i] * 1e6) / 1e6;
        check_cut(&o, "circle or star of a million");
        free(o.points);
    }
}

/* Like check_cut(), but without a limit on the number of triangles: corners on
 * an edge add triangles. */
static void check_covers(const struct outline *o)
{
    struct polygon g = {0};
    double sum = 0;

    assert_true(polygon_triangulate(&g, o->points, o->count));
    assert_false(g.crosses_itself);
    for (uint32_t i = 0; i < g.triangle_count; i++) {
        double area = triangle_area(o, g.triangles[i]);

        assert_true(area > -1e-12);
        sum += area;
    }
    check_close(sum, area_of(o), 1e-9 * sum);
    polygon_free(&g);
}

/* Walks along the walls of a random maze in a box, which it enters and leaves
 * at one place. The walls have no width, and a corner occurs up to four times.
 */
struct maze {
    struct outline *outline;
    uint64_t random;
    bool seen[40][40];
    bool leaves_out; /* sometimes omits corners half way along straight walls */
};

static void walk_maze(struct maze *m, int x, int y, int back)
{
    static const int step[4][2] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}};
    bool is_seldom = m->leaves_out && check_random(&m->random) < 0.5;
    bool has_turned = false;

    m->seen[y][x] = true;
    if (!is_seldom)
        add_point(m->outline, x, y);
    for (int k = 1; k < 4; k++) {
        int way = (back + k) % 4;
        int to_x = x + step[way][0];
        int to_y = y + step[way][1];

        if (to_x < 0 || to_y < 0 || to_x >= 40 || to_y >= 40 ||
            m->seen[to_y][to_x] || check_random(&m->random) < 0.2)
            continue;
        if (is_seldom && !has_turned && k != 2)
            add_point(m->outline, x, y);
        has_turned = true;
        walk_maze(m, to_x, to_y, (way + 2) % 4);
        add_point(m->outline, x, y);
    }
    if (is_seldom && !has_turned)
        add_point(m->outline, x, y);
}

static void rotate(struct outline *o, double angle)
{
    for (uint32_t i = 0; i < o->count; i++) {
        double *p = o->points + 3 * (size_t)i;
        double x = p[0];

        p[0] = cos(angle) * x - sin(angle) * p[1];
        p[1] = sin(angle) * x + cos(angle) * p[1];
    }
}

/* The triangles cover the box once, whatever the walls are. */
static void walls_without_width_are_cut(void **state)
{
    (void)state;
    for (uint64_t round = 0; round < 400; round++) {
        struct outline o = outline_of(4 * 40 * 40 + 8);
        struct maze m = {&o, round, .leaves_out = round % 4 >= 2};

        add_point(&o, -1, -1);
        add_point(&o, 40, -1);
        add_point(&o, 40, 40);
        add_point(&o, -1, 40);
        add_point(&o, -1, 0);
        walk_maze(&m, 0, 0, 2);
        add_point(&o, -1, 0);
        if (round % 2 == 1)
            rotate(&o, (double)round);
        check_close(area_of(&o), 41 * 41, 1e-9);
        check_covers(&o);
        free(o.points);
    }
}

/* No result is right, but one is returned, in linear time. */
static void crossing_outlines_are_reported(void **state)
{
    struct polygon g = {0};
    struct outline o = outline_of(20000);
    struct outline flat = outline_of(100);
    double bowtie[12] = {0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1.5, 0};
    uint32_t random = 1;
    clock_t begin = clock();

    (void)state;
    assert_true(polygon_triangulate(&g, bowtie, 4));
    assert_int_equal(g.triangle_count, 2);
    assert_true(g.crosses_itself);
    for (uint32_t i = 0; i < 20000; i++) {
        random = random * 1664525u + 1013904223u;
        add_point(&o, random >> 16, random & 0xffffu);
    }
    assert_true(polygon_triangulate(&g, o.points, o.count));
    assert_in_range(g.triangle_count, 1, 19998);
    assert_true(g.crosses_itself);
    for (int i = 0; i < 100; i++)
        add_point(&flat, i % 7, 0);
    assert_true(polygon_triangulate(&g, flat.points, flat.count));
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 20);
    polygon_free(&g);
    free(o.points);
    free(flat.points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_concave_polygons_are_quick),
        cmocka_unit_test(long_straight_sides_are_cut),
        cmocka_unit_test(spirals_are_cut),
        cmocka_unit_test(smooth_rings_are_cut),
        cmocka_unit_test(a_million_corners_are_cut),
        cmocka_unit_test(walls_without_width_are_cut),
        cmocka_unit_test(crossing_outlines_are_reported),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
