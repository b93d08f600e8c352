// SPDX-License-Identifier: MIT
/*
 * test_attenuation.c - solids that absorb light against closed forms and
 * quadrature
 */
#include <unistd.h>

#include "tests/unit/facets.h"
#include "tests/unit/files.h"
#include "tests/unit/lambert.h"
#include "tests/unit/truth.h"

#include "engine/scene_load.h"

enum { GLASS, LAMP, FLOOR };

static const struct vec3 sigma = {0.3f, 1, 4};

static struct material glass_of(float ior, struct vec3 absorption)
{
    struct material m = mesh_material(MATERIAL_GLASS, 1);

    m.ior = ior;
    m.medium.extinction = absorption;
    return m;
}

static double channel(struct vec3 v, int k)
{
    return (double)(k == 0 ? v.x : k == 1 ? v.y : v.z);
}

static void light_falls_by_the_law_of_beer(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        float s = (float)exp(12 * check_random(&seed) - 6);
        float t = (float)exp(12 * check_random(&seed) - 6);
        struct vec3 left = transmittance(v3(s, 0, FLOAT_MAX), t);

        check_close((double)left.x, exp(-(double)s * (double)t), 1e-5);
        assert_true(left.y == 1 && left.z == 0);
    }
    assert_true(transmittance(sigma, FLOAT_MAX).x == 0);
    assert_true(transmittance(v3(0, 0, 0), FLOAT_MAX).x == 1);
}

/* A pane before a lamp transmits (1 - F)^2 t / (1 - F^2 t^2), where t is left
 * after one crossing of the pane and F is the reflectance of a face. */
static void panes_transmit_their_series(void **state)
{
    const double thickness = 0.4;

    (void)state;
    for (int i = 0; i < 4; i++) {
        double cosine = 1 - 0.25 * i, sine = sqrt(1 - cosine * cosine);
        double inside = sqrt(1 - sine * sine / 2.25);
        double f = fresnel_by_angles(cosine, 1.5);
        struct claim c = {.eye = v3((float)(-2 * sine), 0, (float)(2 * cosine)),
                          .paths = 1000};
        struct lit_mesh s = {0};

        s.mesh.materials[GLASS] = glass_of(1.5f, sigma);
        s.mesh.materials[LAMP] = lamp_material(1);
        mesh_add_box(&s.mesh, v3(-50, -50, -(float)thickness), v3(50, 50, 0),
                     GLASS);
        mesh_add_quad(&s.mesh, v3(-60, -60, -1), v3(60, -60, -1),
                      v3(60, 60, -1), v3(-60, 60, -1), LAMP);
        lit_mesh_finish(&s);
        for (int k = 0; k < 3; k++) {
            double t = exp(-channel(sigma, k) * thickness / inside);

            c.truth[k] = (1 - f) * (1 - f) * t / (1 - f * f * t * t);
        }
        check_claim(&s, c);
        lit_mesh_free(&s);
    }
}

/* The light of a ball in a white sky, F + (1 - F)^2 t / (1 - F t) along a ray
 * that crosses it by chords of the same length, and its mean over the disc. */
static void balls_have_the_mean_of_their_chords(void **state)
{
    enum { RAYS = 40000, STEPS = 20000 };
    double got[3] = {0}, want[3] = {0};
    struct mesh m = {0};
    uint64_t seed = 2;

    (void)state;
    m.materials[0] = glass_of(1.5f, sigma);
    m.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_sphere(&m, v3(0, 0, 0), 0.5f, 300, 500, 0);
    mesh_finish(&m);
    for (int i = 0; i < RAYS; i++) {
        double r = 0.5 * sqrt(check_random(&seed));
        double phi = 2 * M_PI * check_random(&seed);
        struct ray ray = {v3((float)(r * cos(phi)), (float)(r * sin(phi)), 2),
                          v3(0, 0, -1), FLOAT_MAX, 0, 0};
        struct path_sample s =
            trace_path(&m.world, ray, sampler_start(1, 1, (uint64_t)i, 5),
                       NULL);

        for (int k = 0; k < 3; k++)
            got[k] += channel(s.radiance, k) / RAYS;
    }
    mesh_free(&m);
    for (int i = 0; i < STEPS; i++) {
        double sine2 = (i + 0.5) / STEPS;
        double f = fresnel_by_angles(sqrt(1 - sine2), 1.5);
        double chord = sqrt(1 - sine2 / 2.25);

        for (int k = 0; k < 3; k++) {
            double t = exp(-channel(sigma, k) * chord);

            want[k] += (f + (1 - f) * (1 - f) * t / (1 - f * t)) / STEPS;
        }
    }
    for (int k = 0; k < 3; k++)
        check_close(got[k], want[k], 0.006);
}

/* The floor and a lamp are in glass, and the floor is seen from outside. */
static void glass_absorbs_light_between_things_in_it(void **state)
{
    const float albedo = 0.6f, size = 0.3f, height = 0.4f, left = 0.05f;
    struct claim c = {.eye = {0, 2, 0}, .paths = 4096};
    struct lit_mesh s = {0};
    const int n = 200;

    (void)state;
    s.mesh.materials[GLASS] = glass_of(1.5f, sigma);
    s.mesh.materials[LAMP] = lamp_material(2);
    s.mesh.materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, albedo);
    mesh_add_quad(&s.mesh, v3(-.01f, 0, -.01f), v3(-.01f, 0, .01f),
                  v3(.01f, 0, .01f), v3(.01f, 0, -.01f), FLOOR);
    mesh_add_quad(&s.mesh, v3(left, height, -size),
                  v3(left + size, height, -size), v3(left + size, height, size),
                  v3(left, height, size), LAMP);
    mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), GLASS);
    s.mesh.world.settings.max_vertices = 3;
    lit_mesh_finish(&s);
    for (int i = 0; i < n * n; i++) {
        double x = (double)left + (double)size * (i % n + 0.5) / n;
        double z = (double)size * (2 * (i / n + 0.5) / n - 1);
        double d2 = x * x + z * z + (double)(height * height);
        double form = (double)(height * height) / (d2 * d2) *
                      (double)(2 * size * size) / n / n;

        for (int k = 0; k < 3; k++)
            c.truth[k] += 2 * form * (double)albedo / M_PI * 0.96 / 2.25 *
                          exp(-channel(sigma, k) * (1 + sqrt(d2)));
    }
    check_claim(&s, c);
    lit_mesh_free(&s);
}

/* Rough glass in a white sky, where light samples and paths that meet the sky
 * give the same picture. Within it the sky cannot be seen. */
static void rough_glass_absorbs_alike_by_all_techniques(void **state)
{
    double means[3] = {0}, errors[3] = {0};
    struct lit_mesh s = {0};
    const struct claim c = {.eye = {0.2f, 0.1f, 2}, .paths = 4000};

    (void)state;
    s.mesh.materials[GLASS] = glass_of(1.5f, v3(0.5f, 0.5f, 0.5f));
    s.mesh.materials[GLASS].alpha = 0.3f;
    s.mesh.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_box(&s.mesh, v3(-.5f, -.5f, -.5f), v3(.5f, .5f, .5f), GLASS);
    lit_mesh_finish(&s);
    for (int direct = DIRECT_MIS; direct <= DIRECT_BSDF; direct++) {
        struct estimate e;

        lit_mesh_lend(&s, (enum direct)direct);
        e = claim_estimate(&s.mesh.world, &c);
        means[direct] = e.mean[0];
        errors[direct] = e.error[0];
        assert_true(e.mean[0] > 0.3 && e.mean[0] < 0.9);
    }
    for (int i = 0; i < 2; i++)
        check_close(means[i], means[2],
                    T_LIMIT *
                        sqrt(errors[i] * errors[i] + errors[2] * errors[2]));
    lit_mesh_free(&s);
}

/* glTF's KHR_materials_volume: white light has the attenuation colour c after
 * the attenuation distance d, and c^(x / d) after x. In units of the file. */
static void files_state_colour_and_distance(void **state)
{
    static const char mtl[] = "newmtl m\nTf .5 .25 1\nTf_distance 1.5\nNi 1\n"
                              "illum 7\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
    static const char obj[] =
        "mtllib a.mtl\nusemtl m\nv -40 -40 0\nv 40 -40 0\nv 40 40 0\n"
        "v -40 40 0\nv -40 -40 -3\nv 40 -40 -3\nv 40 40 -3\nv -40 40 -3\n"
        "f 1 2 3 4\nf 8 7 6 5\nusemtl lamp\nv -40 -40 -9\nv 40 -40 -9\n"
        "v 40 40 -9\nv -40 40 -9\nf 9 10 11 12\n";
    struct scene scene = {0};
    struct host_world host = {0};
    struct warnings report = {0};
    struct view view;
    struct world w = {0};
    struct path_sample s;
    struct error err;
    struct ray r = {{0.01f, 0.02f, 1}, {0, 0, -1}, FLOAT_MAX, 0, 0};

    (void)state;
    put("a.mtl", mtl);
    put("a.obj", obj);
    view_init(&view);
    view.pose.eye[2] = 5;
    check_or_say(scene_load(&scene, "a.obj", SCENE_UP_OF_FILE, &report, &err) &&
                     world_init(&host, &scene, 1, &report, &err) &&
                     world_lend(&host, &scene, &view, 0, &w, &err) &&
                     world_ensure_tree(&host, &w, NULL, &err),
                 err.text);
    assert_true(scene.scale != 1);
    assert_int_not_equal(world_features(&host) & FEATURE_ATTENUATION, 0);
    s = trace_path(&w, r, sampler_start(0, 0, 0, 0), NULL);
    check_close((double)s.radiance.x, 0.25, 1e-5);
    check_close((double)s.radiance.y, 0.0625, 1e-5);
    check_close((double)s.radiance.z, 1, 1e-6);
    world_free(&host);
    scene_free(&scene);
    view_free(&view);
    warnings_free(&report);
}

static int remove_files(void **state)
{
    unlink("a.obj");
    unlink("a.mtl");
    return leave_empty_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_falls_by_the_law_of_beer),
        cmocka_unit_test(panes_transmit_their_series),
        cmocka_unit_test(balls_have_the_mean_of_their_chords),
        cmocka_unit_test(glass_absorbs_light_between_things_in_it),
        cmocka_unit_test(rough_glass_absorbs_alike_by_all_techniques),
        cmocka_unit_test(files_state_colour_and_distance),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_files);
}
