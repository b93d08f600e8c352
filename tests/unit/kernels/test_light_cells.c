// SPDX-License-Identifier: MIT
/* test_light_cells.c - cells of light: the area of a plane in a cell, by
 * counting points; levels; even light, which stays even */
#include "tests/unit/check.h"

#include <math.h>

#include "kernels/light_cells.h"
#include "world/light/light_cells.h"

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

static const struct light_grid grid = {.facing = {.3f, 1, .2f},
                                       .offset = {.3f, .6f, .9f},
                                       .distance_scale = 1.5f,
                                       .width = .01f};

/* The key of a cell of a level at a point. */
static uint64_t key_of(struct vec3 p, struct vec3 ng, uint32_t level)
{
    uint64_t key = light_place(&grid, p, ng, cell_octave(&grid, p)).key;

    return key != 0 ? light_cell_above(key, level) : 0;
}

/* Both sides of a sheet, places a cell apart, octaves and levels have different
 * cells; a place's own cell is the same again. */
static void cells_are_apart(void **state)
{
    struct vec3 up = v3(0, 1, 0), p = v3(1, 2, 3);
    float width = light_place(&grid, p, up, cell_octave(&grid, p)).width;

    (void)state;
    assert_true(width > 0.0f);
    for (uint32_t level = 0; level < CELL_LEVELS; level++) {
        uint64_t key = key_of(p, up, level);
        float beyond = 1.01f * width * (float)(1u << level);

        assert_true(key != 0);
        assert_true(key == key_of(p, up, level));
        assert_true(key != key_of(p, v3_neg(up), level));
        for (uint32_t k = 0; k < 3; k++) {
            struct vec3 q = p;
            float *x = k == 0 ? &q.x : k == 1 ? &q.y : &q.z;

            *x += beyond;
            assert_true(key != key_of(q, up, level));
        }
        for (uint32_t k = 0; k < level; k++)
            assert_true(key != key_of(p, up, k));
    }
    assert_true(light_place(&grid, p, up, cell_octave(&grid, p)).key !=
                light_place(&grid, p, up, cell_octave(&grid, p) + 1).key);
    /* none at the eye, or at no place */
    assert_true(key_of(grid.eye, up, 0) == 0);
    assert_true(key_of(v3(INFINITY, 0, 0), up, 0) == 0);
}

/* Eight cells are one of the next level. */
static void cells_are_in_cells(void **state)
{
    struct vec3 up = v3(0, 1, 0), p = v3(1, 2, 3);
    float width = light_place(&grid, p, up, cell_octave(&grid, p)).width;
    uint64_t seed = 5;
    int wrong = 0; /* by the last bits of a coordinate */

    (void)state;
    for (int i = 0; i < 20000; i++) {
        struct vec3 from = v3_scale(v3((float)check_random(&seed) - .5f,
                                       (float)check_random(&seed) - .5f,
                                       (float)check_random(&seed) - .5f),
                                    40 * width);
        struct vec3 move = v3_scale(v3((float)check_random(&seed) - .5f,
                                       (float)check_random(&seed) - .5f,
                                       (float)check_random(&seed) - .5f),
                                    2 * width);
        struct vec3 a = v3_add(p, from), b = v3_add(a, move);
        bool is_one = false;

        for (uint32_t level = 0; level < CELL_LEVELS; level++) {
            float wide = width * (float)(1u << level);
            const float d[] = {a.x, a.y, a.z, b.x, b.y, b.z};
            const float o[] = {grid.offset.x, grid.offset.y, grid.offset.z};
            bool is_same = key_of(a, up, level) == key_of(b, up, level);
            bool truth = true;

            for (int k = 0; k < 3; k++)
                truth = truth &&
                        floor((double)((d[k] + width * o[k]) / wide)) ==
                            floor((double)((d[k + 3] + width * o[k]) / wide));
            wrong += is_same != truth;
            assert_true(is_same || !is_one);
            is_one = is_same;
        }
    }
    assert_in_range(wrong, 0, 200);
}

/* Deposits along a side of the floor, and their distance. */
#define DEPOSITS 800
#define STEP     0.01f

/* Puts the light of irradiance 1 on the floor below the eye. */
static void light_floor(struct light_cells *c, int half, uint64_t *seed)
{
    for (uint32_t i = 0; i < DEPOSITS * DEPOSITS; i++) {
        float x = (float)(i % DEPOSITS) + (float)check_random(seed);
        float z = (float)(i / DEPOSITS) + (float)check_random(seed);
        struct light_deposit d = {.path = i,
                                  .light =
                                      v3(STEP * STEP, STEP * STEP, STEP * STEP),
                                  .d = v3(0, 1, 0)};

        light_cells_add(c, 0, half,
                        v3(STEP * (x - DEPOSITS / 2), -1,
                           STEP * (z - DEPOSITS / 2)),
                        v3(0, 1, 0), &d);
    }
}

/* A floor with even light has the same radiance at all distances from the eye,
 * also where octaves meet and where cells are of several levels. */
static void even_light_stays_even(void **state)
{
    struct world w = {.settings.camera = {.up = {0, .4f, 0}, .height = 90}};
    struct surface_point v = {.ng = {0, 1, 0},
                              .n = {0, 1, 0},
                              .t = {1, 0, 0},
                              .b = {0, 0, 1}};
    struct bsdf b = {.color = {1, 1, 1}, .kind = MATERIAL_DIFFUSE};
    struct light_cells c = {.cells = NULL};
    struct pool *pool = pool_create(2, NULL);
    const struct cancel never = {0};
    uint64_t seed = 7;

    (void)state;
    assert_true(light_cells_begin(&c, &w, 0, 1, pool));
    light_floor(&c, 0, &seed);
    light_floor(&c, 1, &seed);
    assert_true(light_cells_end(&c, 1, pool, &never));
    w.light_grids = c.grids;
    w.light_cells = c.cells;
    for (int ring = 3; ring < 20; ring++)
        for (uint32_t half = 0; half < 2; half++) {
            double sum = 0;

            for (int i = 0; i < 8000; i++) {
                float r = 0.1f * ((float)ring + (float)check_random(&seed));
                struct vec2 turn = cos_sin_turns((float)check_random(&seed));
                struct vec2 u =
                    v2((float)check_random(&seed), (float)check_random(&seed));

                v.p = v3(r * turn.x, -1, r * turn.y);
                sum += (double)light_cells_radiance(&w, half, &v, &b,
                                                    v3(0, 0, 1), u)
                           .y;
            }
            check_close(sum / 8000, 1 / 3.14159265, .03 / 3.14159265);
        }
    light_cells_free(&c);
    pool_destroy(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_have_their_area),
        cmocka_unit_test(cells_are_apart),
        cmocka_unit_test(cells_are_in_cells),
        cmocka_unit_test(even_light_stays_even),
    };

    return cmocka_run_group_tests_name("light_cells", tests, NULL, NULL);
}
