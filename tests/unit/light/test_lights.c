// SPDX-License-Identifier: MIT
#include "world/light/lights.h"

#include <math.h>

#include "world/light/sky_table.h"
#include "kernels/light.h"

#include "tests/unit/check.h"
#include "tests/unit/lambert.h"
#include "tests/unit/lamps.h"
#include "tests/unit/mesh.h"
#include "tests/unit/sky_pdf.h"

/* Returns the sum of the densities of all triangles along a direction, found by
 * testing every triangle. */
static double density_along(const struct world *w, const struct receiver *r,
                            struct vec3 d)
{
    struct ray ray = {r->p, d, FLOAT_MAX, 0, 0};
    struct shear shear = shear_of(ray);
    double sum = 0;

    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct vec3 p0 = w->positions[w->tris[i].v[0]];
        struct vec3 p1 = w->positions[w->tris[i].v[1]];
        struct vec3 p2 = w->positions[w->tris[i].v[2]];
        struct vec3 error;
        struct hit h;

        if (triangle_hit(ray, shear, (struct leaf_tri){p0, p1, p2, NO_INDEX},
                         FLOAT_MAX, &h))
            sum +=
                (double)light_pdf_at(w, r, i, hit_point(h, p0, p1, p2, &error));
    }
    return sum;
}

/* Integrates over the sphere by midpoints of 1000 x 2000. The error at the rim
 * of a triangle is its length times the spacing. */
static void density_integrates_to_one(void **state)
{
    const int rows = 1000;
    uint64_t seed = 77;
    struct mesh m = {0};
    struct lights lights;
    struct receiver r;
    double sum = 0;

    (void)state;
    add_lamps(&m, 6, 0.7, &seed);
    add_quads(&m, 6, 0.7, &seed);
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 12);
    r = any_receiver(&seed);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < 2 * rows; j++) {
            double z = 2 * (i + 0.5) / rows - 1;
            double phi = M_PI * (j + 0.5) / rows;
            double s = sqrt(1 - z * z);

            sum += density_along(&m.world, &r,
                                 v3((float)(s * cos(phi)),
                                    (float)(s * sin(phi)), (float)z));
        }
    check_close(sum * 4 * M_PI / (2.0 * rows * rows), 1, 3e-3);
    discard(&m, &lights);
}

static void sample_and_density_agree(void **state)
{
    const int counts[][2] = {{1, 0}, {5, 0}, {500, 0}, {0, 1}, {0, 5}, {9, 9}};
    int found = 0, seconds = 0;

    (void)state;
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        uint64_t seed = 19;
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, counts[k][0], 0.3, &seed);
        add_quads(&m, counts[k][1], 0.3, &seed);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, counts[k][0] + counts[k][1]);
        for (int i = 0; i < 20000; i++) {
            struct receiver r = any_receiver(&seed);
            struct light_sample s;

            if (!light_sample(&m.world, &r, NO_INDEX, any_choice(&seed),
                              any_choice(&seed), &s))
                continue;
            found++;
            seconds += lights.lights[lights.tri_lights[s.tri]].tris[1] == s.tri;
            assert_true(s.pdf == light_pdf_at(&m.world, &r, s.tri, s.p));
            assert_true(s.pdf > 0 && s.pdf <= FLOAT_MAX);
            check_close(v3_length(s.wi), 1, 1e-6);
            check_close((double)v3_dot(s.wi, v3_unit(v3_sub(s.p, r.p))), 1,
                        1e-6);
            assert_true(s.radiance.x == 1 && s.radiance.z == 3);
        }
        discard(&m, &lights);
    }
    assert_true(found > 118000 && seconds > 20000);
}

/* Tests the irradiance from few to many lamps together. */
static void many_lamps_obey_lambert(void **state)
{
    const int counts[] = {1, 7, 60, 1000};

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        uint64_t seed = 1234;
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, counts[k], 0.4 / sqrt(counts[k]), &seed);
        finish(&m, &lights);
        for (int i = 0; i < 10; i++) {
            struct receiver r = any_receiver(&seed);
            double truth = 0, error, e;

            r.transmits = false;
            for (uint32_t t = 0; t < m.tri_count; t++)
                truth += lambert(&m.positions[3 * t], 3, &r);
            e = irradiance(&m.world, &r, 200000, &seed, &error);
            check_close(e, truth, Z_LIMIT * error + 1e-6 * truth);
        }
        discard(&m, &lights);
    }
}

/* Solid angle of a triangle (Van Oosterom and Strackee 1983). */
static double solid_angle(const struct vec3 *p, struct vec3 from)
{
    struct vec3 a = v3_unit(v3_sub(p[0], from));
    struct vec3 b = v3_unit(v3_sub(p[1], from));
    struct vec3 c = v3_unit(v3_sub(p[2], from));

    return 2 * atan2(fabs((double)v3_dot(a, v3_cross(b, c))),
                     1 + (double)(v3_dot(a, b) + v3_dot(b, c) + v3_dot(c, a)));
}

/* The mean of 1 / pdf is the solid angle of what is sampled, whatever the
 * shares of sky and lamps are. This tests the whole sky and a lamp before it.
 */
static void sky_and_lamps_share(void **state)
{
    const float shares[][2] = {{0.5f, 0.5f}, {0.25f, 0.5f}, {0.125f, 0.25f}};
    const int n = 100000;
    uint64_t seed = 55;
    struct vec3 texels[8] = {{1, 1, 1}, {2, 2, 2}, {1, 1, 1}, {3, 3, 3},
                             {4, 4, 4}, {1, 1, 1}, {2, 2, 2}, {1, 1, 1}};
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false, false};
    struct sky_table table = {NULL};
    struct error err;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    mesh_add(&m, v3(0, 1, 0), v3(0.5f, 0.9f, 0), v3(0, 0.8f, 0.6f), LAMP);
    finish(&m, &lights);
    m.world.settings.sky = (struct sky){{1, 1, 1}, 4, 2, 0, 1, 0};
    m.world.sky_texels = texels;
    assert_true(sky_table_build(&table, texels, 4, 2, SKY_ALONE, &err));
    sky_table_lend(&table, &m.world);
    assert_true(m.world.settings.sky_share == 0.5f &&
                m.world.settings.light_share == 0.5f);
    for (size_t k = 0; k < 3; k++) {
        double sums[2] = {0, 0}, squares[2] = {0, 0};
        const double truths[2] = {4 * M_PI, solid_angle(m.positions, r.p)};

        m.world.settings.sky_share = shares[k][0];
        m.world.settings.light_share = shares[k][1];
        for (int i = 0; i < n; i++) {
            struct vec2 point = any_choice(&seed);
            struct light_sample s;
            int lamp;

            if (!light_sample(&m.world, &r, NO_INDEX, point, any_choice(&seed),
                              &s))
                continue;
            lamp = s.tri != NO_INDEX ? 1 : 0;
            assert_true(s.pdf == (lamp ? light_pdf_at(&m.world, &r, s.tri, s.p)
                                       : sky_light_pdf(&m.world, &r, s.wi)));
            sums[lamp] += 1 / (double)s.pdf;
            squares[lamp] += pow((double)s.pdf, -2);
        }
        for (int i = 0; i < 2; i++) {
            double mean = sums[i] / n;

            check_close(mean, truths[i],
                        Z_LIMIT * sqrt((squares[i] / n - mean * mean) / n) +
                            1e-6);
        }
    }
    sky_table_free(&table);
    discard(&m, &lights);
}

/* Tests a lamp of area 1/2 and radiance 2 under skies of increasing
 * radiance. */
static void weak_lamps_are_sampled_less_often(void **state)
{
    struct mesh m = {0};
    struct lights lights;
    float share = 1;

    (void)state;
    mesh_add(&m, v3(0, 1, 0), v3(1, 1, 0), v3(0, 1, 1), LAMP);
    finish(&m, &lights);
    check_close(lights.unsampled_variance, 2, 1e-6);
    for (float sky = 0; sky < 20; sky += 0.5f) {
        m.world.settings.sky.color = v3(sky, sky, sky);
        lights_lend(&lights, &m.world);
        assert_true(m.world.settings.light_share <= share &&
                    m.world.settings.light_share > 0);
        share = m.world.settings.light_share;
        /* The lamp's 2 pi is compared with the square of pi times the sky. */
        assert_true(sky > 2 || share == 1);
        assert_true(sky < 3 || share < 1);
    }
    check_close(share, 0.1, 1e-7);
    discard(&m, &lights);
}

/* STRESS M8, M9: degenerate lights do no harm. */
static void degenerate_lights_give_finite_densities(void **state)
{
    const struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, z = {0, 0, 1};
    struct receiver r = {{0.2f, -0.5f, 0.2f}, {0, 1, 0}, false, false};
    struct light_sample s;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 0);
    assert_false(light_sample(&m.world, &r, NO_INDEX, v2(0, 0), v2(0, 0), &s));
    discard(&m, &lights);

    m = (struct mesh){0};
    mesh_add(&m, o, x, z, 0);                 /* black */
    mesh_add(&m, o, x, v3(0.5f, 0, 0), LAMP); /* without area */
    /* Almost without area. */
    mesh_add(&m, o, v3(1e-30f, 0, 0), v3(0, 0, 1e-30f), LAMP);
    mesh_add(&m, o, x, z, LAMP);
    mesh_add(&m, o, x, z, 2);
    mesh_add(&m, o, x, z, 3);
    for (uint32_t k = 2; k < 4; k++) {
        float e = k == 2 ? 1e38f : 1e-38f;

        m.materials[k] = mesh_material(MATERIAL_DIFFUSE, 0);
        m.materials[k].emission = v3(e, e, e);
    }
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 3);
    assert_int_equal(lights.tri_lights[1], NO_INDEX);
    assert_true(light_pdf_at(&m.world, &r, 1, o) == 0);
    check_close(sum_of_probabilities(&m.world, &r), 1, 1e-6);
    assert_true(
        light_sample(&m.world, &r, NO_INDEX, v2(0.3f, 0.6f), v2(0, 0), &s));
    /* At the lamp itself and in its plane the density is a number. */
    r.p = s.p;
    for (int i = 0; i < 2; i++) {
        if (light_sample(&m.world, &r, NO_INDEX, v2(0.3f, 0.6f), v2(0, 0), &s))
            assert_true(s.pdf > 0 && s.pdf <= FLOAT_MAX);
        r.p.x += 3;
    }
    discard(&m, &lights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density_integrates_to_one),
        cmocka_unit_test(sample_and_density_agree),
        cmocka_unit_test(many_lamps_obey_lambert),
        cmocka_unit_test(sky_and_lamps_share),
        cmocka_unit_test(weak_lamps_are_sampled_less_often),
        cmocka_unit_test(degenerate_lights_give_finite_densities),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
