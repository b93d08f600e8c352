// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "formats/triangulate.h"
#include "tests/unit/check.h"

#define PI 3.14159265358979323846

/* Polygons in the plane z = 0 and what is known about them. */
struct outline {
    double *points; /* 3 a corner */
    uint32_t count;
};

static struct outline outline_of(uint32_t capacity)
{
    struct outline o = {calloc(3 * (size_t)capacity, sizeof(double)), 0};

    assert_non_null(o.points);
    return o;
}

static void add_point(struct outline *o, double x, double y)
{
    o->points[3 * (size_t)o->count] = x;
    o->points[3 * (size_t)o->count + 1] = y;
    o->count++;
}

/* Shoelace formula. */
static double area_of(const struct outline *o)
{
    long double sum = 0;

    for (size_t i = 0; i < o->count; i++) {
        const double *p = o->points + 3 * i;
        const double *q = o->points + 3 * ((i + 1) % o->count);

        sum += (long double)p[0] * q[1] - (long double)p[1] * q[0];
    }
    return (double)(sum / 2);
}

static double triangle_area(const struct outline *o, const uint32_t t[3])
{
    const double *a = o->points + 3 * (size_t)t[0];
    const double *b = o->points + 3 * (size_t)t[1];
    const double *c = o->points + 3 * (size_t)t[2];

    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

static int compare_edges(const void *a, const void *b)
{
    uint64_t p = *(const uint64_t *)a;
    uint64_t q = *(const uint64_t *)b;

    return (p > q) - (p < q);
}

/* Cuts, and checks that the triangles wind like the polygon and that their
 * areas, none of them negative, add up to its area. */
static void check_cut(const struct outline *o, const char *name)
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

/* The same without a bound on how many triangles there are: an edge that is met
 * by corners has more. */
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

/* Every edge of the outline is one of exactly one triangle, and every other
 * edge one of two, from either side. */
static void check_edges(const struct outline *o)
{
    struct polygon g = {0};
    uint64_t *edges;
    uint32_t n = 0;
    uint32_t outer = 0;

    assert_true(polygon_triangulate(&g, o->points, o->count));
    assert_int_equal(g.triangle_count, o->count - 2);
    edges = calloc(3 * (size_t)g.triangle_count, sizeof *edges);
    assert_non_null(edges);
    for (uint32_t i = 0; i < g.triangle_count; i++) {
        for (int k = 0; k < 3; k++)
            edges[n++] =
                (uint64_t)g.triangles[i][k] << 32 | g.triangles[i][(k + 1) % 3];
    }
    qsort(edges, n, sizeof *edges, compare_edges);
    for (uint32_t i = 0; i < n; i++) {
        uint64_t back = edges[i] << 32 | edges[i] >> 32;

        assert_true(i == 0 || edges[i] != edges[i - 1]);
        if (bsearch(&back, edges, n, sizeof *edges, compare_edges))
            continue;
        assert_int_equal(edges[i] & 0xffffffffu,
                         ((edges[i] >> 32) + 1) % o->count);
        outer++;
    }
    assert_int_equal(outer, o->count);
    free(edges);
    polygon_free(&g);
}

/* Both windings, and starting at every corner of small ones. */
static void check_all_turns(const struct outline *o, const char *name)
{
    uint32_t starts = o->count <= 64 ? o->count : 1;

    for (uint32_t s = 0; s < starts; s++) {
        for (int is_back = 0; is_back < 2; is_back++) {
            struct outline turned = outline_of(o->count);

            for (uint32_t i = 0; i < o->count; i++) {
                uint32_t j = (is_back ? 2 * o->count - i : i) + s;
                const double *p = o->points + 3 * (size_t)(j % o->count);

                add_point(&turned, p[0], p[1]);
            }
            check_cut(&turned, name);
            free(turned.points);
        }
    }
}

static void test_regular(void **state)
{
    (void)state;
    for (uint32_t n = 3; n <= 64; n++) {
        struct outline o = outline_of(n);
        struct polygon g = {0};

        for (uint32_t i = 0; i < n; i++)
            add_point(&o, cos(2 * PI * i / n), sin(2 * PI * i / n));
        check_all_turns(&o, "regular");
        assert_true(polygon_triangulate(&g, o.points, n));
        assert_int_equal(g.triangle_count, n - 2);
        polygon_free(&g);
        free(o.points);
    }
}

static void test_stars_and_combs(void **state)
{
    (void)state;
    for (uint32_t n = 5; n <= 64; n++) {
        struct outline star = outline_of(n);
        struct outline comb = outline_of(n);

        for (uint32_t i = 0; i < n; i++) {
            double r = i % 2 == 0 ? 1 : 0.2;

            add_point(&star, r * cos(2 * PI * i / n), r * sin(2 * PI * i / n));
        }
        add_point(&comb, 0, 0);
        add_point(&comb, n, 0);
        for (uint32_t i = 2; i < n; i++)
            add_point(&comb, n - i, i % 2 == 0 ? 5 : 0.5);
        check_all_turns(&star, "star");
        check_all_turns(&comb, "comb");
        free(star.points);
        free(comb.points);
    }
}

/* Corners on straight edges: no fan from one of them covers the polygon
 * without triangles of no area. */
static void test_corners_on_edges(void **state)
{
    struct outline o = outline_of(16);
    struct polygon g = {0};

    (void)state;
    for (int i = 0; i < 4; i++)
        add_point(&o, i, 0);
    for (int i = 0; i < 4; i++)
        add_point(&o, 4, i);
    for (int i = 0; i < 4; i++)
        add_point(&o, 4 - i, 4);
    for (int i = 0; i < 4; i++)
        add_point(&o, 0, 4 - i);
    check_all_turns(&o, "square with points on its edges");
    assert_true(polygon_triangulate(&g, o.points, o.count));
    assert_int_equal(g.triangle_count, 14);
    for (uint32_t i = 0; i < g.triangle_count; i++)
        assert_true(triangle_area(&o, g.triangles[i]) > 0);
    polygon_free(&g);
    free(o.points);
}

/* A ring: outline, bridge to the hole, around the hole, and back. */
static void test_hole_with_bridge(void **state)
{
    (void)state;
    for (int n = 3; n <= 30; n++) {
        struct outline o = outline_of(2 * (uint32_t)n + 2);
        double expected =
            (4 - 1) * n / 2.0 * sin(2 * PI / n); /* two regular polygons */

        for (int i = 0; i <= n; i++)
            add_point(&o, 2 * cos(2 * PI * (i % n) / n),
                      2 * sin(2 * PI * (i % n) / n));
        for (int i = n; i >= 0; i--)
            add_point(&o, cos(2 * PI * (i % n) / n), sin(2 * PI * (i % n) / n));
        assert_true(fabs(area_of(&o) - expected) < 1e-12 * expected);
        check_all_turns(&o, "ring");
        free(o.points);
    }
}

/* Nine square holes, joined to the outline or to each other by bridges. */
static void test_many_holes(void **state)
{
    struct outline o = outline_of(128);

    (void)state;
    add_point(&o, 0, 0);
    add_point(&o, 10, 0);
    add_point(&o, 10, 10);
    add_point(&o, 0, 10);
    for (int row = 2; row >= 0; row--) {
        double y = 1 + 3 * row;

        /* along the lower edges of the holes of a row, out and back */
        add_point(&o, 0, y);
        for (int i = 0; i < 3; i++) {
            double x = 1 + 3 * i;

            add_point(&o, x, y);
            if (i < 2) {
                add_point(&o, x + 1, y);
            } else {
                add_point(&o, x, y + 1);
                add_point(&o, x + 1, y + 1);
                add_point(&o, x + 1, y);
                add_point(&o, x, y);
            }
        }
        for (int i = 1; i >= 0; i--) {
            double x = 1 + 3 * i;

            add_point(&o, x + 1, y);
            add_point(&o, x + 1, y + 1);
            add_point(&o, x, y + 1);
            add_point(&o, x, y);
        }
        add_point(&o, 0, y);
    }
    check_cut(&o, "nine holes");
    free(o.points);
}

/* Outlines that are seen whole from the middle, and the same with a hole. */
static void test_random(void **state)
{
    uint64_t random = 1;

    (void)state;
    for (int round = 0; round < 3000; round++) {
        uint32_t n = 4 + (uint32_t)(check_random(&random) * 300);
        struct outline o = outline_of(2 * n + 2);
        struct outline ring = outline_of(2 * n + 2);

        for (uint32_t i = 0; i < n; i++) {
            double r = 1 + 4 * check_random(&random);

            add_point(&o, r * cos(2 * PI * i / n), r * sin(2 * PI * i / n));
        }
        check_cut(&o, "random");
        check_edges(&o);
        for (uint32_t i = 0; i <= n; i++)
            add_point(&ring, o.points[3 * (i % n)], o.points[3 * (i % n) + 1]);
        for (uint32_t i = n + 1; i-- > 0;) {
            double r = 0.1 + 0.5 * (double)(i % n) / n;

            add_point(&ring, r * cos(2 * PI * i / n), r * sin(2 * PI * i / n));
        }
        check_cut(&ring, "random ring");
        free(o.points);
        free(ring.points);
    }
}

static void test_coincident_corners(void **state)
{
    static const double square[5][2] = {
        {0, 0}, {2, 0}, {2, 2}, {0.5, 0.5}, {0, 2}};
    struct outline o = outline_of(15);

    (void)state;
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 3; k++)
            add_point(&o, square[i][0], square[i][1]);
    }
    check_cut(&o, "every corner three times");
    free(o.points);
}

static void test_large_and_concave_is_quick(void **state)
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

/* Corners along the straight sides of a polygon: a side's, but for its ends,
 * are none of an ear until the one beside it is cut. */
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

static void test_long_straight_sides(void **state)
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

/* A band that is wound up: only its ends have ears in the end. */
static void test_spirals(void **state)
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

/* A wide and a narrow one. */
static void test_smooth_rings(void **state)
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

static void test_a_million_corners(void **state)
{
    uint32_t n = 1000000;

    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct outline o = outline_of(n);

        for (uint32_t i = 0; i < n; i++) {
            double r = kind == 1 && i % 2 == 1 ? 0.2 : 1;

            add_point(&o, r * cos(2 * PI * i / n), r * sin(2 * PI * i / n));
        }
        /* as text of six digits has them: neither strictly convex nor all
         * different */
        for (size_t i = 0; kind == 2 && i < 3 * (size_t)n; i++)
            o.points[i] = nearbyint(o.points[i] * 1e6) / 1e6;
        check_cut(&o, "circle or star of a million");
        free(o.points);
    }
}

/* Walks around the walls of a random maze inside a box, in and out of it again
 * at one place: each wall has no width, and its corners come up to four times.
 */
struct maze {
    struct outline *outline;
    uint64_t random;
    bool seen[40][40];
    bool leaves_out; /* corners half way along straight walls, at times */
};

static void walk(struct maze *m, int x, int y, int back)
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
        walk(m, to_x, to_y, (way + 2) % 4);
        add_point(m->outline, x, y);
    }
    if (is_seldom && !has_turned)
        add_point(m->outline, x, y);
}

static void turn_around(struct outline *o, double angle)
{
    for (uint32_t i = 0; i < o->count; i++) {
        double *p = o->points + 3 * (size_t)i;
        double x = p[0];

        p[0] = cos(angle) * x - sin(angle) * p[1];
        p[1] = sin(angle) * x + cos(angle) * p[1];
    }
}

/* The box is covered once, whatever is in it. */
static void test_walls_without_width(void **state)
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
        walk(&m, 0, 0, 2);
        add_point(&o, -1, 0);
        if (round % 2 == 1)
            turn_around(&o, (double)round);
        check_close(area_of(&o), 41 * 41, 1e-9);
        check_covers(&o);
        free(o.points);
    }
}

/* No answer is right, but there is one, in time proportional to the size. */
static void test_outlines_that_cross_themselves(void **state)
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

static void test_any_plane_and_any_size(void **state)
{
    static const double sizes[] = {1e-300, 1e-30, 1, 1e30, 1e300};
    static const double arrow[4][2] = {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}};
    struct polygon g = {0};

    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        for (int axis = 0; axis < 3; axis++) {
            double p[12] = {0};

            for (int i = 0; i < 4; i++) {
                p[3 * i + (axis + 1) % 3] = arrow[i][0] * sizes[s];
                p[3 * i + (axis + 2) % 3] = arrow[i][1] * sizes[s];
            }
            assert_true(polygon_triangulate(&g, p, 4));
            assert_int_equal(g.triangle_count, 2);
            assert_false(g.crosses_itself);
            /* the cut goes through the reflex corner */
            for (int t = 0; t < 2; t++)
                assert_true(g.triangles[t][0] == 3 || g.triangles[t][1] == 3 ||
                            g.triangles[t][2] == 3);
        }
    }
    polygon_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_regular),
        cmocka_unit_test(test_stars_and_combs),
        cmocka_unit_test(test_corners_on_edges),
        cmocka_unit_test(test_hole_with_bridge),
        cmocka_unit_test(test_many_holes),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_coincident_corners),
        cmocka_unit_test(test_large_and_concave_is_quick),
        cmocka_unit_test(test_long_straight_sides),
        cmocka_unit_test(test_spirals),
        cmocka_unit_test(test_smooth_rings),
        cmocka_unit_test(test_a_million_corners),
        cmocka_unit_test(test_walls_without_width),
        cmocka_unit_test(test_outlines_that_cross_themselves),
        cmocka_unit_test(test_any_plane_and_any_size),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
