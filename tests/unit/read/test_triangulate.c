// SPDX-License-Identifier: MIT
/* test_triangulate.c - triangles of polygons of all shapes, planes and sizes */
#include "tests/unit/read/outlines.h"

static int compare_edges(const void *a, const void *b)
{
    uint64_t p = *(const uint64_t *)a;
    uint64_t q = *(const uint64_t *)b;

    return (p > q) - (p < q);
}

/* Checks that every edge of the outline belongs to exactly one triangle, and
 * every other edge to two, in opposite directions. */
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

/* Tests both windings, and every start corner of small polygons. */
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

static void regular_polygons_are_cut(void **state)
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

static void stars_and_combs_are_cut(void **state)
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

/* With corners on straight edges, any fan from one corner has triangles without
 * area. */
static void corners_on_edges_make_no_flat_triangles(void **state)
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

/* The outline of a ring goes along a bridge to the hole, around it, and
 * back. */
static void hole_with_a_bridge_stays_open(void **state)
{
    (void)state;
    for (int n = 3; n <= 30; n++) {
        struct outline o = outline_of(2 * (uint32_t)n + 2);
        double expected =
            /* Area between two regular polygons. */
            (4 - 1) * n / 2.0 * sin(2 * PI / n);

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

/* Nine square holes are joined to the outline or to each other by bridges. */
static void many_holes_stay_open(void **state)
{
    struct outline o = outline_of(128);

    (void)state;
    add_point(&o, 0, 0);
    add_point(&o, 10, 0);
    add_point(&o, 10, 10);
    add_point(&o, 0, 10);
    for (int row = 2; row >= 0; row--) {
        double y = 1 + 3 * row;

        /* The outline follows the lower edges of a row of holes and returns. */
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

/* Tests outlines that are visible from their middle, and the same with a
 * hole. */
static void random_polygons_are_cut(void **state)
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

static void coincident_corners_are_cut(void **state)
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

static void any_plane_and_size_are_cut(void **state)
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
            /* The diagonal goes through the reflex corner. */
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
        cmocka_unit_test(regular_polygons_are_cut),
        cmocka_unit_test(stars_and_combs_are_cut),
        cmocka_unit_test(corners_on_edges_make_no_flat_triangles),
        cmocka_unit_test(hole_with_a_bridge_stays_open),
        cmocka_unit_test(many_holes_stay_open),
        cmocka_unit_test(random_polygons_are_cut),
        cmocka_unit_test(coincident_corners_are_cut),
        cmocka_unit_test(any_plane_and_size_are_cut),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
