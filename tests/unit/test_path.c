// SPDX-License-Identifier: MIT
#include "check.h"
#include "lambert.h"
#include "mesh.h"

#include <math.h>

#include "kernels/traverse.h"

#include "kernels/path.h"

/* Mean radiance of n paths along one ray, and its standard error. */
struct estimate {
    double mean, error;
};

static struct estimate look(const struct world *w, struct vec3 eye,
                            struct vec3 at, int n)
{
    double sum = 0, squares = 0;
    struct estimate e;

    for (int i = 0; i < n; i++) {
        struct ray r = {eye, v3_unit(v3_sub(at, eye)), FLOAT_MAX, 0};
        struct path_sample s =
            path_trace(w, r,
                       sampler_start(1, 2, (uint64_t)i, w->settings.seed));

        assert_int_equal(s.cut, 0);
        sum += (double)s.radiance.x;
        squares += (double)s.radiance.x * (double)s.radiance.x;
    }
    e.mean = sum / n;
    e.error = sqrt(fmax(squares / n - e.mean * e.mean, 0) / (n - 1));
    return e;
}

/* 4.9 standard errors: happens once in a million by chance, and the seed is
 * fixed. `rounding` is the relative error of float. */
static void check_estimate(struct estimate e, double truth, double rounding)
{
    check_close(e.mean, truth, 4.9 * e.error + rounding * truth);
}

/* Closed room that shines everywhere: E / (1 - rho), with d vertices
 * E (1 - rho^d) / (1 - rho). */
static void furnace_shows_its_series(void **state)
{
    const float rhos[] = {0.0f, 0.3f, 0.8f, 0.95f};

    (void)state;
    for (int k = 0; k < 4; k++)
        for (uint32_t d = 1; d <= 1000; d = d == 1 ? 2 : d == 2 ? 7 : d * 200) {
            struct mesh m = {0};
            double rho = (double)rhos[k];
            struct estimate e;

            m.materials[0] = mesh_material(MATERIAL_DIFFUSE, rhos[k]);
            m.materials[0].emission = v3(2, 2, 2);
            mesh_add_box(&m, v3(-1, -1, -1), v3(1, 1, 1), 0);
            m.world.settings.max_vertices = d > 1000 ? 1000 : d;
            mesh_finish(&m);
            e = look(&m.world, v3(0.1f, 0.2f, 0.3f), v3(1, 0, 0), 40000);
            check_estimate(e,
                           2 * (1 - pow(rho, m.world.settings.max_vertices)) /
                               (1 - rho),
                           2e-6);
            mesh_free(&m);
        }
}

/* A thing in a constant sky of 1: white ones must vanish, to the bit or to
 * rounding; nothing is lost at the rim or gained. */
static double furnace_error(struct material material, int n)
{
    struct mesh m = {0};
    uint64_t seed = 9;
    double worst = 0;

    m.materials[0] = material;
    m.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_sphere(&m, v3(0, 0, 0), 0.5f, 24, 40, 0);
    mesh_finish(&m);
    for (int i = 0; i < n; i++) {
        struct vec3 at = v3((float)check_random(&seed) - 0.5f,
                            (float)check_random(&seed) - 0.5f, 0);
        struct estimate e = look(&m.world, v3(0, 0, 3), at, 1);

        worst = fmax(worst, fabs(e.mean - 1));
    }
    mesh_free(&m);
    return worst;
}

static void white_diffuse_vanishes(void **state)
{
    (void)state;
    assert_true(furnace_error(mesh_material(MATERIAL_DIFFUSE, 1.0f), 50000) ==
                0);
}

static void smooth_glass_vanishes(void **state)
{
    (void)state;
    check_at_most(furnace_error(mesh_material(MATERIAL_GLASS, 1.0f), 50000),
                  1e-6);
}

static void thin_glass_vanishes(void **state)
{
    (void)state;
    assert_true(
        furnace_error(mesh_material(MATERIAL_THIN_GLASS, 1.0f), 50000) == 0);
}

/* On the average of many rays; 3e-3 for each table on the way: a ray meets
 * glass some four times. */
static void white_rough_things_vanish(void **state)
{
    const struct {
        uint32_t kind;
        double meetings;
    } things[] = {{MATERIAL_METAL, 1},
                  {MATERIAL_PLASTIC, 1},
                  {MATERIAL_ROUGH_DIFFUSE, 1},
                  {MATERIAL_GLASS, 4}};

    (void)state;
    for (int i = 0; i < 4; i++) {
        struct mesh m = {0};

        m.materials[0] = mesh_material(things[i].kind, 1.0f);
        m.materials[0].alpha = 0.4f;
        m.materials[0].coat = v3(0.04f, 0.04f, 0.04f);
        m.world.settings.sky.color = v3(1, 1, 1);
        mesh_add_sphere(&m, v3(0, 0, 0), 0.5f, 24, 40, 0);
        mesh_finish(&m);
        check_estimate(look(&m.world, v3(0, 0, 3), v3(0.2f, 0.1f, 0.1f),
                            100000),
                       1, 3e-3 * things[i].meetings);
        mesh_free(&m);
    }
}

static void white_mirrors_vanish(void **state)
{
    (void)state;
    assert_true(furnace_error(mesh_material(MATERIAL_METAL, 1.0f), 50000) == 0);
}

/* n clear sheets, ior 1.5, before a lamp: T = 1 / (1 + 2 n R / (1 - R)) with
 * R = .04 a face. */
static void sheets_transmit_their_share(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) {
        struct mesh m = {0};
        double r = 0.04;

        m.materials[0] = mesh_material(MATERIAL_GLASS, 1.0f);
        m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
        m.materials[1].emission = v3(1, 1, 1);
        for (int i = 0; i < n; i++)
            mesh_add_box(&m, v3(-1, -1, -0.2f * (float)i - 0.1f),
                         v3(1, 1, -0.2f * (float)i), 0);
        mesh_add_quad(&m, v3(-1, -1, -1), v3(1, -1, -1), v3(1, 1, -1),
                      v3(-1, 1, -1), 1);
        mesh_finish(&m);
        check_estimate(look(&m.world, v3(0.1f, 0.2f, 1), v3(0.1f, 0.2f, 0),
                            200000),
                       1 / (1 + 2 * n * r / (1 - r)), 1e-5);
        mesh_free(&m);
    }
}

/* Inside glass radiance is eta^2 times that outside: a lamp seen from within
 * the medium through one face. */
static void radiance_scales_across_a_face(void **state)
{
    struct mesh m = {0};

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_GLASS, 1.0f);
    m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m.materials[1].emission = v3(1, 1, 1);
    /* the eye is below the face (in glass), the lamp above it */
    mesh_add_quad(&m, v3(-1, 0, 1), v3(1, 0, 1), v3(1, 0, -1), v3(-1, 0, -1),
                  0);
    mesh_add_quad(&m, v3(-9, 1, 9), v3(9, 1, 9), v3(9, 1, -9), v3(-9, 1, -9),
                  1);
    mesh_finish(&m);
    check_estimate(look(&m.world, v3(0, -0.5f, 0), v3(0, 0, 0), 100000),
                   0.96 * 1.5 * 1.5, 1e-5);
    mesh_free(&m);
}

static void rectangle_lights_a_plane(void **state)
{
    const float places[3][2] = {{0, 0}, {0.5f, 0.2f}, {-0.9f, 0.6f}};
    const double n[3] = {0, 1, 0};

    (void)state;
    for (int k = 0; k < 3; k++) {
        struct mesh m = {0};
        double x = (double)places[k][0], z = (double)places[k][1];
        const double lamp[4][3] = {{-0.4 - x, 0.7, -0.3 - z},
                                   {0.4 - x, 0.7, -0.3 - z},
                                   {0.4 - x, 0.7, 0.3 - z},
                                   {-0.4 - x, 0.7, 0.3 - z}};

        m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.6f);
        m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
        m.materials[1].emission = v3(5, 5, 5);
        mesh_add_quad(&m, v3(-2, 0, -2), v3(-2, 0, 2), v3(2, 0, 2),
                      v3(2, 0, -2), 0);
        mesh_add_quad(&m, v3(-0.4f, 0.7f, -0.3f), v3(0.4f, 0.7f, -0.3f),
                      v3(0.4f, 0.7f, 0.3f), v3(-0.4f, 0.7f, 0.3f), 1);
        mesh_finish(&m);
        check_estimate(look(&m.world, v3(places[k][0], 0.4f, places[k][1] + 1),
                            v3(places[k][0], 0, places[k][1]), 1000000),
                       5 * 0.6 / M_PI * lambert_irradiance(lamp, n), 1e-5);
        mesh_free(&m);
    }
}

/* STRESS M6: a camera inside glass under total reflection ends in time. */
static void total_reflection_ends(void **state)
{
    struct mesh m = {0};
    struct estimate e;

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_GLASS, 1.0f);
    m.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_box(&m, v3(-0.5f, -0.5f, -0.5f), v3(0.5f, 0.5f, 0.5f), 0);
    mesh_finish(&m);
    for (int i = 0; i < 1000; i++) {
        struct ray r = {v3(0.1f, 0.2f, 0.3f), v3_unit(v3(0.5f, 0.6f, 0.624f)),
                        FLOAT_MAX, 0};
        struct path_sample s =
            path_trace(&m.world, r, sampler_start(0, 0, (uint64_t)i, 0));

        assert_true(s.rays <= PATH_HARD_STOP);
        assert_true(s.radiance.x == 0 && s.cut == 1); /* never gets out */
    }
    e = look(&m.world, v3(0.1f, 0.1f, 0), v3(0.1f, 0.1f, 1), 10000);
    check_estimate(e, 1.5 * 1.5, 1e-5); /* everything is sky times eta^2 */
    mesh_free(&m);
}

/* A constant opacity passes its share of rays, on every bounce anew. */
static void opacity_passes_its_share(void **state)
{
    struct mesh m = {0};

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m.materials[0].opacity = 0.25f;
    m.world.settings.sky.color = v3(1, 1, 1);
    m.world.settings.features = FEATURE_COVERAGE;
    for (int i = 0; i < 2; i++)
        mesh_add_quad(&m, v3(-1, -1, (float)i), v3(1, -1, (float)i),
                      v3(1, 1, (float)i), v3(-1, 1, (float)i), 0);
    mesh_finish(&m);
    check_estimate(look(&m.world, v3(0.1f, 0.2f, 3), v3(0.1f, 0.2f, 0), 200000),
                   0.75 * 0.75, 0);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace_shows_its_series),
        cmocka_unit_test(white_diffuse_vanishes),
        cmocka_unit_test(smooth_glass_vanishes),
        cmocka_unit_test(thin_glass_vanishes),
        cmocka_unit_test(white_mirrors_vanish),
        cmocka_unit_test(white_rough_things_vanish),
        cmocka_unit_test(sheets_transmit_their_share),
        cmocka_unit_test(radiance_scales_across_a_face),
        cmocka_unit_test(rectangle_lights_a_plane),
        cmocka_unit_test(total_reflection_ends),
        cmocka_unit_test(opacity_passes_its_share),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
