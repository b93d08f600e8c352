// SPDX-License-Identifier: MIT
/* Smooth normals, compared with those of spheres, cylinders and boxes, and with
 * the same mesh by several threads or in many vertices. */
#include <math.h>
#include <stdlib.h>

#include "base/thread_pool.h"
#include "read/crease_normals.h"
#include "tests/unit/check.h"

static void allocate(struct scene *s, uint32_t vertices, uint32_t tris)
{
    *s = (struct scene){.file_positions = calloc(vertices, 3 * sizeof(double)),
                        .tris = calloc(tris, sizeof *s->tris)};
    assert_non_null(s->file_positions);
    assert_non_null(s->tris);
}

static void add_vertex(struct scene *s, double x, double y, double z)
{
    double *p = s->file_positions + 3 * s->position_count++;

    p[0] = x;
    p[1] = y;
    p[2] = z;
}

static void add_tri(struct scene *s, uint32_t a, uint32_t b, uint32_t c)
{
    s->tris[s->tri_count++] =
        (struct tri){.v = {a, b, c},
                     .vn = {NO_INDEX, NO_INDEX, NO_INDEX},
                     .vt = {NO_INDEX, NO_INDEX, NO_INDEX}};
}

/* A tube around y of one ring of squares, all cut along the same diagonal: a
 * corner has one triangle of one square and two of the next. */
static void make_tube(struct scene *s, uint32_t sides)
{
    allocate(s, 2 * sides, 2 * sides);
    for (uint32_t i = 0; i < sides; i++) {
        double a = 2 * M_PI * i / sides;

        add_vertex(s, cos(a), 0, sin(a));
        add_vertex(s, cos(a), 1, sin(a));
    }
    for (uint32_t i = 0; i < sides; i++) {
        uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);

        add_tri(s, a, a + 1, b);
        add_tri(s, b, a + 1, b + 1);
    }
}

static struct vec3 normal_of(const struct scene *s, uint32_t tri, int k)
{
    assert_true(s->tris[tri].vn[k] < s->normal_count);
    return s->normals[s->tris[tri].vn[k]];
}

/* Normals of a tube point away from its axis, however squares are cut: the
 * angles at a corner of a square add up to the same. */
static void tubes_are_round(void **state)
{
    struct scene s;

    (void)state;
    make_tube(&s, 10); /* 36 degrees */
    assert_true(crease_normals(&s, NULL));
    assert_int_equal(s.normal_count, 20);
    for (uint32_t i = 0; i < s.tri_count; i++) {
        for (int k = 0; k < 3; k++) {
            const double *p = s.file_positions + 3 * s.tris[i].v[k];
            struct vec3 n = normal_of(&s, i, k);

            check_close((double)n.x, p[0], 1e-4);
            check_close((double)n.y, 0, 1e-4);
            check_close((double)n.z, p[2], 1e-4);
        }
    }
    scene_free(&s);
}

static void creases_stay_flat(void **state)
{
    struct scene s;

    (void)state;
    make_tube(&s, 8); /* 45 degrees */
    assert_true(crease_normals(&s, NULL));
    for (uint32_t i = 0; i < s.tri_count; i++)
        for (int k = 0; k < 3; k++)
            assert_int_equal(s.tris[i].vn[k], NO_INDEX);
    scene_free(&s);
}

/* A sphere of rings of squares, without the last rings at its poles. Each
 * square has vertices of its own. */
static void make_sphere(struct scene *s, uint32_t n)
{
    allocate(s, 4 * n * n, 2 * n * n);
    for (uint32_t j = 0; j < n; j++) {
        for (uint32_t i = 0; i < n; i++) {
            uint32_t v = s->position_count;

            for (uint32_t k = 0; k < 4; k++) {
                double a = 2 * M_PI * ((i + k % 2) % n) / n;
                double b = M_PI * (j + k / 2 + 1) / (n + 2);

                add_vertex(s, sin(b) * cos(a), cos(b), sin(b) * sin(a));
            }
            add_tri(s, v, v + 1, v + 2);
            add_tri(s, v + 2, v + 1, v + 3);
        }
    }
}

/* Vertices at the same place count as one. The normals of a fine sphere differ
 * little from its radii, away from its open ends. */
static void spheres_are_round(void **state)
{
    struct scene s;

    (void)state;
    make_sphere(&s, 64);
    assert_true(crease_normals(&s, NULL));
    assert_int_equal(s.normal_count, 64 * 65);
    for (uint32_t i = 2 * 64; i < s.tri_count - 2 * 64; i++) {
        for (int k = 0; k < 3; k++) {
            const double *p = s.file_positions + 3 * s.tris[i].v[k];
            struct vec3 n = normal_of(&s, i, k);

            check_close((double)n.x * p[0] + (double)n.y * p[1] +
                            (double)n.z * p[2],
                        1, 1e-5);
        }
    }
    scene_free(&s);
}

/* The normals, their order and their numbers are the same. */
static void threads_do_not_matter(void **state)
{
    struct error err;
    struct pool *pool = pool_create(3, &err);
    struct scene a, b;

    (void)state;
    assert_non_null(pool);
    make_sphere(&a, 100); /* 40,000 vertices: several blocks */
    make_sphere(&b, 100);
    assert_true(crease_normals(&a, NULL) && crease_normals(&b, pool));
    assert_int_equal(a.normal_count, b.normal_count);
    assert_memory_equal(a.normals, b.normals,
                        a.normal_count * sizeof *a.normals);
    assert_memory_equal(a.tris, b.tris, a.tri_count * sizeof *a.tris);
    scene_free(&a);
    scene_free(&b);
    pool_destroy(pool);
}

/* A hub of many faces is joined by sorting, to the same result as by pairs:
 * the normals of a flat cone's rim and tip. */
static void hubs_have_one_normal(void **state)
{
    (void)state;
    for (uint32_t sides = 40; sides < 1000; sides += 400) {
        struct scene s;

        allocate(&s, sides + 1, sides);
        add_vertex(&s, 0, .1, 0);
        for (uint32_t i = 0; i < sides; i++)
            add_vertex(&s, cos(2 * M_PI * i / sides), 0,
                       sin(2 * M_PI * i / sides));
        for (uint32_t i = 0; i < sides; i++)
            add_tri(&s, 0, 1 + (i + 1) % sides, 1 + i);
        assert_true(crease_normals(&s, NULL));
        for (uint32_t i = 0; i < sides; i++) {
            check_close((double)normal_of(&s, i, 0).y, 1, 1e-6);
            assert_int_equal(s.tris[i].vn[0], s.tris[0].vn[0]);
        }
        scene_free(&s);
    }
}

/* Any number of copies of a face, and faces without area, end in time. */
static void bad_meshes_do_no_harm(void **state)
{
    struct scene s;

    (void)state;
    allocate(&s, 4, 300000);
    add_vertex(&s, 0, 0, 0);
    add_vertex(&s, 1, 0, 0);
    add_vertex(&s, 0, 1, 0);
    add_vertex(&s, NAN, 1e300, -1e300);
    for (uint32_t i = 0; i < 300000; i++)
        add_tri(&s, 0, i % 3 == 0 ? 1 : i % 3, i % 2 == 0 ? 2 : 3);
    assert_true(crease_normals(&s, NULL));
    for (uint32_t i = 0; i < s.tri_count; i++)
        for (int k = 0; k < 3; k++)
            assert_true(s.tris[i].vn[k] == NO_INDEX ||
                        s.tris[i].vn[k] < s.normal_count);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tubes_are_round),
        cmocka_unit_test(creases_stay_flat),
        cmocka_unit_test(spheres_are_round),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(hubs_have_one_normal),
        cmocka_unit_test(bad_meshes_do_no_harm),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
