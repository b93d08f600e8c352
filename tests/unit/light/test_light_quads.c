// SPDX-License-Identifier: MIT
/* test_light_quads.c - lights of two triangles */
#include <math.h>

#include "tests/unit/check.h"
#include "tests/unit/chi_square.h"
#include "tests/unit/lambert.h"
#include "tests/unit/lamps.h"

/* Each ring is one light: a rectangle, a parallelogram, and a quadrilateral
 * with opposite sides that differ by a fifth, whose halves differ in density.
 */
static const struct vec3 rings[3][4] = {{{-0.4f, 0.7f, -0.3f},
                                         {0.4f, 0.7f, -0.3f},
                                         {0.4f, 0.7f, 0.3f},
                                         {-0.4f, 0.7f, 0.3f}},
                                        {{-0.4f, 0.2f, -0.3f},
                                         {0.4f, 0.6f, -0.1f},
                                         {0.3f, 0.7f, 0.4f},
                                         {-0.5f, 0.3f, 0.2f}},
                                        {{-0.4f, 0.7f, -0.3f},
                                         {0.4f, 0.7f, -0.3f},
                                         {0.32f, 0.7f, 0.3f},
                                         {-0.32f, 0.7f, 0.3f}}};

static void quads_obey_lambert(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (uint32_t k = 0; k < 3; k++) {
        struct mesh m = {0};
        struct lights lights;

        add_ring(&m, rings[k], k);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, 1);
        for (int i = 0; i < 40; i++) {
            struct receiver r = any_receiver(&seed);
            double error, e;

            r.transmits = false;
            e = irradiance(&m.world, &r, 100000, &seed, &error);
            check_close(e, lambert(rings[k], 4, &r), Z_LIMIT * error + 1e-6);
        }
        discard(&m, &lights);
    }
}

/* Chi-square test over 16 x 16 parts of a parallelogram, with the cube root of
 * Wilson and Hilferty. The parts are those of p0 + s (p1 - p0) + t (p3 - p0).
 */
static void points_are_uniform_on_parallelograms(void **state)
{
    const int side = 16, n = 200000;
    const double cells = side * side;
    const struct vec3 *ring = rings[1];
    const struct vec3 a = v3_sub(ring[1], ring[0]),
                      b = v3_sub(ring[3], ring[0]);
    const double aa = (double)v3_dot(a, a), ab = (double)v3_dot(a, b),
                 bb = (double)v3_dot(b, b);
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false, false};
    uint64_t seed = 21;

    (void)state;
    for (uint32_t turns = 0; turns < 9; turns++) {
        int counts[16 * 16] = {0};
        struct mesh m = {0};
        struct lights lights;
        struct chi_square chi = chi_begin();

        add_ring(&m, ring, turns);
        finish(&m, &lights);
        for (int i = 0; i < n; i++) {
            struct light_sample sample;
            struct vec3 d;
            double da, db, s, t;

            assert_true(light_sample(&m.world, &r, NO_INDEX, any_choice(&seed),
                                     v2(0, 0), &sample));
            d = v3_sub(sample.p, ring[0]);
            da = (double)v3_dot(d, a);
            db = (double)v3_dot(d, b);
            s = (da * bb - db * ab) / (aa * bb - ab * ab);
            t = (db * aa - da * ab) / (aa * bb - ab * ab);
            /* The diagonal, where s is t, decides which half the sample belongs
             * to. */
            if (fabs(s - t) > 1e-5)
                assert_int_equal(sample.tri, s > t ? 0 : 1);
            counts[(int)fmin(fmax(s * side, 0), side - 1) * side +
                   (int)fmin(fmax(t * side, 0), side - 1)]++;
        }
        for (int i = 0; i < side * side; i++)
            chi_add(&chi, n / cells, counts[i]);
        check_at_most(fabs(chi_deviate(&chi)), Z_LIMIT);
        discard(&m, &lights);
    }
}

/* A parallelogram is as likely as its two halves on the other side, which stay
 * separate lights; the tolerance of 2 % covers the difference in distance. Its
 * ball in the tree encloses both halves. */
static void both_halves_count(void **state)
{
    const struct vec3 p = {0.5f, 1, 0}, x = {0.01f, 0, 0}, z = {0, 0, 0.01f};
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false, false};
    struct mesh m = {0};
    struct lights lights;
    float whole, halves;
    uint32_t i;

    (void)state;
    mesh_add_quad(&m, p, v3_add(p, x), v3_add(v3_add(p, x), z), v3_add(p, z),
                  LAMP);
    mesh_add(&m, v3_neg(p), v3_neg(x), v3_neg(z), 0);
    for (int half = 0; half < 2; half++) {
        struct vec3 at = v3(-p.x, p.y, 0);

        mesh_add(&m, at, v3_sub(at, z), v3_sub(at, x), LAMP);
        mesh_add(&m, at, x, z, 0);
    }
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 3);
    whole = light_tree_pmf(&m.world, &r, 0);
    halves = light_tree_pmf(&m.world, &r, 1) + light_tree_pmf(&m.world, &r, 2);
    check_close(whole, halves, 0.02);
    i = lights.lights[0].path[0] & 7;
    check_close(lights.nodes[0].x[i], 0.505, 1e-6);
    check_close(lights.nodes[0].y[i], 1, 1e-6);
    check_close(lights.nodes[0].z[i], 0.005, 1e-6);
    check_close(lights.nodes[0].radius[i], sqrt(0.5) / 100, 1e-6);
    discard(&m, &lights);
}

static uint32_t count_lights(struct mesh *m)
{
    struct lights lights;
    uint32_t count;

    finish(m, &lights);
    count = lights.light_count;
    discard(m, &lights);
    *m = (struct mesh){0};
    return count;
}

/* Triangles without a common side, in different planes, with different
 * emission, or with opposite fronts are two lights. */
static void unlike_triangles_are_two_lights(void **state)
{
    const struct vec3 *p = rings[0];
    const struct vec3 folded[4] = {p[0], p[1], p[2], p[1]};
    const struct vec3 bent[4] = {p[0], p[1], p[2], v3(-0.4f, 0.71f, 0.3f)};
    const struct vec3 uneven[4] = {p[0], p[1], v3(-0.1f, 0.7f, 0.3f), p[3]};
    struct mesh m = {0};

    (void)state;
    for (uint32_t turns = 0; turns < 9; turns++) {
        add_ring(&m, p, turns);
        assert_int_equal(count_lights(&m), 1);
        add_ring(&m, folded, turns);
        assert_int_equal(count_lights(&m), 2);
        add_ring(&m, bent, turns);
        assert_int_equal(count_lights(&m), 2);
        add_ring(&m, uneven, turns);
        assert_int_equal(count_lights(&m), 2);
    }
    mesh_add(&m, p[0], p[1], p[2], LAMP);
    mesh_add(&m, p[0], p[3], p[2], LAMP); /* opposite winding */
    assert_int_equal(count_lights(&m), 2);
    mesh_add(&m, p[0], p[1], p[2], LAMP);
    mesh_add(&m, p[0], v3_add(p[2], v3(0, 0, 1e-6f)), p[3], LAMP);
    assert_int_equal(count_lights(&m), 2);
    mesh_add_quad(&m, p[0], p[1], p[2], p[3], LAMP);
    m.tris[1].material = LAMP + 1;
    m.materials[LAMP + 1] = mesh_material(MATERIAL_DIFFUSE, 0);
    m.materials[LAMP + 1].emission = v3(1, 2, 3.1f);
    assert_int_equal(count_lights(&m), 2);
    mesh_add(&m, p[0], p[1], p[2], LAMP); /* apart in file order */
    mesh_add(&m, p[0], v3(0, 5, 0), v3(1, 5, 0), 0);
    mesh_add(&m, p[0], p[2], p[3], LAMP);
    assert_int_equal(count_lights(&m), 2);
    mesh_add_quad(&m, p[0], p[1], p[2], p[3], LAMP); /* a pair and a triangle */
    mesh_add(&m, p[2], p[3], p[0], LAMP);
    assert_int_equal(count_lights(&m), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_obey_lambert),
        cmocka_unit_test(points_are_uniform_on_parallelograms),
        cmocka_unit_test(both_halves_count),
        cmocka_unit_test(unlike_triangles_are_two_lights),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
