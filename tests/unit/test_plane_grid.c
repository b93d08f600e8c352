// SPDX-License-Identifier: MIT
#include <stdbool.h>

#include "check.h"
#include "glim/plane_grid.h"

#define POINTS    2000
#define TRIANGLES 300

static double side_of(struct point2 a, struct point2 b, struct point2 p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

static bool is_inside(const struct point2 t[3], struct point2 p)
{
    double a = side_of(t[0], t[1], p);
    double b = side_of(t[1], t[2], p);
    double c = side_of(t[2], t[0], p);

    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

static bool meets(const struct plane_grid *g, const struct plane_triangle *t,
                  uint32_t cell)
{
    uint32_t row = cell / g->side;
    uint32_t first, last;

    if (row < t->first_row || row > t->last_row)
        return false;
    plane_grid_row(g, t, row, &first, &last);
    assert_int_equal(first / g->side, row);
    assert_int_equal(last / g->side, row);
    return first <= cell && cell <= last;
}

/* Points of a picture with some scale in x and in y: some on lines of cells,
 * corners among them, and triangles of them, thin ones and flat ones too. */
static void check_scale(double width, double height)
{
    struct point2 points[POINTS];
    uint64_t random = 7;
    int inside = 0;

    for (int i = 0; i < POINTS; i++) {
        points[i].x = width * check_random(&random);
        points[i].y = height * check_random(&random);
        if (i % 5 == 0)
            points[i].y = height * (i % 40) / 40;
        if (i % 7 == 0)
            points[i].x = width * (i % 44) / 44;
    }

    struct plane_grid g = plane_grid_over(points, POINTS);
    assert_in_range(g.side * g.side, POINTS / 2, POINTS);
    for (int i = 0; i < TRIANGLES; i++) {
        const struct point2 *p = points + i;
        struct point2 t[3] = {p[0], p[5], i % 3 == 0 ? p[6] : p[5 * (i % 4)]};
        struct plane_triangle met = plane_grid_triangle(&g, t[0], t[1], t[2]);

        for (int k = 0; k < POINTS; k++) {
            if (!is_inside(t, points[k]))
                continue;
            assert_true(meets(&g, &met, plane_grid_cell(&g, points[k])));
            inside++;
        }
    }
    assert_true(inside > TRIANGLES * 10);
}

static void test_points_in_triangles_are_in_their_cells(void **state)
{
    (void)state;
    check_scale(1, 1);
    check_scale(1e9, 1e-9);
    check_scale(1e-12, 1e30);
}

/* From corner to corner through the whole grid a thin triangle meets at most a
 * few cells a row, not all of them. */
static void test_thin_triangles_meet_few_cells(void **state)
{
    struct point2 points[10000] = {{0, 0}, {1, 1}, {1, 0.999}};
    struct plane_triangle t;
    uint32_t met = 0;

    (void)state;
    for (int i = 3; i < 10000; i++)
        points[i] = (struct point2){0.5, 0.5};

    struct plane_grid g = plane_grid_over(points, 10000);
    t = plane_grid_triangle(&g, points[0], points[1], points[2]);
    assert_int_equal(g.side, 100);
    assert_int_equal(t.first_row, 0);
    assert_int_equal(t.last_row, 99);
    for (uint32_t row = t.first_row; row <= t.last_row; row++) {
        uint32_t first, last;

        plane_grid_row(&g, &t, row, &first, &last);
        met += last - first + 1;
    }
    assert_in_range(met, 100, 400);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points_in_triangles_are_in_their_cells),
        cmocka_unit_test(test_thin_triangles_meet_few_cells),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
