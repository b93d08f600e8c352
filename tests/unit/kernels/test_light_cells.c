// SPDX-License-Identifier: MIT
/* test_light_cells.c - the area of a plane in a cell, by counting points */
#include "tests/unit/check.h"

#include <math.h>

#include "kernels/light_cells.h"

/* Points along a side of the square that is counted. */
#define SIDE 1000

/* Of points at random in a cell and the plane through each: the mean area of
 * the plane in the cell is the integral, over the plane, of the part of cells
 * that a move by a vector keeps in the cell: the product of 1 - |x| for its
 * components. */
static double counted_area(struct vec3 n)
{
    struct vec3 t, b;
    double sum = 0, step = 4. / SIDE;

    frame_around(n, &t, &b);
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            double u = (i + .5) * step - 2, v = (j + .5) * step - 2, part = 1;

            for (uint32_t k = 0; k < 3; k++)
                part *= fmax(0, 1 - fabs(u * (double)v3_axis(t, k) +
                                         v * (double)v3_axis(b, k)));
            sum += part * step * step;
        }
    return sum;
}

static void planes_have_their_area(void **state)
{
    static const float normals[][3] = {{0, 1, 0},      {1, 0, 0},
                                       {1, 1, 0},      {0, -1, 1},
                                       {1, 1, 1},      {1, .1f, 0},
                                       {.2f, 1, .1f},  {-.7f, .8f, .6f},
                                       {.5f, .9f, 1},  {1, .9f, -.1f},
                                       {.01f, 1, .99f}};

    (void)state;
    for (size_t i = 0; i < sizeof normals / sizeof normals[0]; i++) {
        struct vec3 n =
            v3_unit(v3(normals[i][0], normals[i][1], normals[i][2]));

        check_close((double)light_cell_area(n), counted_area(n), 2e-5);
    }
}

/* Both sides of a sheet, and places a cell apart, have different cells; a
 * place's own cell is the same again. */
static void cells_are_apart(void **state)
{
    struct light_grid g = {.eye = v3(0, 0, 0),
                           .facing = v3_unit(v3(.3f, 1, .2f)),
                           .distance_scale = 1.5f,
                           .width = .01f};
    struct vec3 up = v3(0, 1, 0), p = v3(1, 2, 3);
    struct cell_place at = light_place(&g, p, up);

    (void)state;
    assert_true(at.key != 0);
    assert_true(at.width > 0.0f);
    assert_true(at.key == light_place(&g, p, up).key);
    assert_true(at.key != light_place(&g, p, v3_neg(up)).key);
    for (uint32_t k = 0; k < 3; k++) {
        float *x = k == 0 ? &p.x : k == 1 ? &p.y : &p.z;

        *x += 1.01f * at.width;
        assert_true(at.key != light_place(&g, p, up).key);
        *x -= 1.01f * at.width;
    }
    /* none at the eye, or at no place */
    assert_true(light_place(&g, g.eye, up).key == 0);
    assert_true(light_place(&g, v3(INFINITY, 0, 0), up).key == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_have_their_area),
        cmocka_unit_test(cells_are_apart),
    };

    return cmocka_run_group_tests_name("light_cells", tests, NULL, NULL);
}
