// SPDX-License-Identifier: MIT
/*
 * test_first_surface.c - features and direct light of the first surface that is
 * not a mirror or clear glass
 */
#include <math.h>

#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include "tests/unit/paths.h"
#include "tests/unit/truth.h"
#include "kernels/pixel.h"

enum { FLOOR, MIRROR, PANE };

/* A floor of albedo .5 at y = 0 under a constant sky, seen from (0, 2, 0). With
 * a mirror at x = 1, y > 1, and a pane of thin glass at y = 1.5, x < 0. */
static void open_room(struct mesh *m)
{
    *m = (struct mesh){0};
    m->materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m->materials[MIRROR] = mesh_material(MATERIAL_METAL, 1.0f);
    m->materials[PANE] = mesh_material(MATERIAL_THIN_GLASS, 1.0f);
    m->world.settings.sky.color = v3(1, 1, 1);
    m->world.settings.features = FEATURES_ALL;
    mesh_add_quad(m, v3(-9, 0, 9), v3(9, 0, 9), v3(9, 0, -9), v3(-9, 0, -9),
                  FLOOR);
    mesh_add_quad(m, v3(1, 1, 9), v3(1, 9, 9), v3(1, 9, -9), v3(1, 1, -9),
                  MIRROR);
    mesh_add_quad(m, v3(-9, 1.5f, 9), v3(0, 1.5f, 9), v3(0, 1.5f, -9),
                  v3(-9, 1.5f, -9), PANE);
    mesh_finish(m);
}

static struct path_sample follow(const struct mesh *m, struct vec3 d,
                                 uint64_t index, struct first_surface *s)
{
    struct ray r = {v3(0.1f, 2, 0), v3_unit(d), FLOAT_MAX, 0, 0};

    return trace_path(&m->world, r, sampler_start(3, 4, index, 7), s);
}

static void check_floor(const struct first_surface *s, double depth)
{
    assert_int_not_equal(s->state, SURFACE_AHEAD);
    check_close(s->depth, depth, 1e-5 * depth);
    check_close(s->albedo.x, 0.5, 0);
    check_close(s->normal.x, 0, 1e-6);
    check_close(s->normal.y, 1, 1e-6);
    check_close(s->seen.x, 0, 0);
}

/* The floor is found directly, in the mirror and through the pane, at the
 * length of the path. */
static void surfaces_are_found(void **state)
{
    struct first_surface s;
    struct mesh m;

    (void)state;
    open_room(&m);
    follow(&m, v3(0.3f, -2, 0), 0, &s);
    check_floor(&s, sqrt(0.09 + 4));
    /* .9 to the mirror, where y is 1.7; then down to the floor */
    follow(&m, v3(0.9f, -0.3f, 0), 0, &s);
    check_floor(&s, 2 / 0.3 * sqrt(0.81 + 0.09));
    for (uint64_t i = 0, seen = 0; seen < 5; i++) {
        follow(&m, v3(-0.5f, -2, 0), i, &s);
        if (s.state == SURFACE_AHEAD)
            continue; /* the pane has reflected the ray to the sky */
        check_floor(&s, sqrt(0.25 + 4));
        seen++;
    }
    follow(&m, v3(0, 1, 0.5f), 0, &s);
    assert_int_equal(s.state, SURFACE_AHEAD);
    check_close(s.direct.x, 1, 0);
    check_close(s.seen.x, 1, 0);
    follow(&m, v3(1, 0.5f, 0), 0, &s); /* the sky in the mirror */
    assert_int_equal(s.state, SURFACE_AHEAD);
    check_close(s.direct.x, 1, 1e-6);
    check_close(s.seen.x, 0, 0);
    m.world.settings.camera.lens_radius = 0.1f;
    follow(&m, v3(0, 1, 0.5f), 0, &s);
    check_close(s.direct.x, 1, 0);
    check_close(s.seen.x, 0, 0);
    mesh_free(&m);
}

/* The sky at x > 0, and a lamp at x < 0, are seen past coverage of 0, which a
 * cutoff makes of less, but not through partial coverage before the lamp or of
 * it: whether a sample meets them is chance. All their light is direct. */
static void light_behind_coverage_is_not_seen(void **state)
{
    enum { SHEET, LAMP };
    static const struct {
        float opacity, cutoff, lamp_opacity;
        bool sky_is_seen, lamp_is_seen;
    } sheets[] = {{0, 0, 1, true, true},       {0.3f, 0.5f, 1, true, true},
                  {0.5f, 0, 1, false, false},  {0.5f, 0.25f, 1, false, false},
                  {0.99f, 0, 1, false, false}, {0.01f, 0, 1, false, false},
                  {0, 0, 0.5f, true, false}};

    (void)state;
    for (size_t k = 0; k < sizeof sheets / sizeof sheets[0]; k++) {
        struct mesh m = {0};

        m.materials[SHEET] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
        m.materials[SHEET].opacity = sheets[k].opacity;
        m.materials[SHEET].cutoff = sheets[k].cutoff;
        m.materials[LAMP] = mesh_material(MATERIAL_DIFFUSE, 0);
        m.materials[LAMP].opacity = sheets[k].lamp_opacity;
        m.materials[LAMP].emission = v3(2, 2, 2);
        m.world.settings.sky.color = v3(4, 4, 4);
        m.world.settings.features = FEATURES_ALL;
        mesh_add_quad(&m, v3(-9, 3, 9), v3(9, 3, 9), v3(9, 3, -9),
                      v3(-9, 3, -9), SHEET);
        mesh_add_quad(&m, v3(-9, 4, 9), v3(0, 4, 9), v3(0, 4, -9),
                      v3(-9, 4, -9), LAMP);
        mesh_finish(&m);
        for (uint64_t i = 0; i < 200; i++) {
            bool is_sky = i % 2 == 0;
            bool is_seen =
                is_sky ? sheets[k].sky_is_seen : sheets[k].lamp_is_seen;
            struct first_surface s;
            struct path_sample all =
                follow(&m, v3(is_sky ? 0.1f : -0.2f, 1, 0), i, &s);

            check_close(s.seen.x, !is_seen ? 0 : is_sky ? 4 : 2, 0);
            if (is_seen || s.state == SURFACE_AHEAD)
                check_close(s.direct.x, all.radiance.x, 0);
        }
        mesh_free(&m);
    }
}

/* Direct light is the radiance of paths that end at the vertex after the
 * surface, to the bit; the rest is more, and the sum is that of a world without
 * first surfaces. */
static void direct_light_is_that_of_short_paths(void **state)
{
    static const struct {
        struct vec3 d;
        uint32_t vertices;
    } views[] = {{{0.3f, -2, 0}, 2}, {{0.9f, -0.3f, 0}, 3}};
    struct mesh m;
    int longer = 0;

    (void)state;
    open_room(&m);
    for (int k = 0; k < 2; k++)
        for (uint64_t i = 0; i < 500; i++) {
            struct first_surface s, ignored;
            struct path_sample whole, plain, direct;

            m.world.settings.max_vertices = PATH_HARD_STOP;
            m.world.settings.features = FEATURES_ALL;
            whole = follow(&m, views[k].d, i, &s);
            m.world.settings.features &= ~FEATURE_FILTER;
            plain = follow(&m, views[k].d, i, NULL);
            assert_memory_equal(&whole, &plain, sizeof whole);
            m.world.settings.max_vertices = views[k].vertices;
            direct = follow(&m, views[k].d, i, &ignored);
            assert_memory_equal(&s.direct, &direct.radiance, sizeof s.direct);
            assert_true(s.direct.x <= whole.radiance.x);
            longer += s.direct.x < whole.radiance.x;
        }
    assert_true(longer > 50); /* light between the floor and the mirror */
    mesh_free(&m);
}

/* Many directions into which rough metal scatters grazing light lie below it.
 * Paths that end there have the light of their shadow ray, which is not seen.
 */
static void light_of_paths_that_end_is_not_seen(void **state)
{
    struct point_light lamp = {.p = {4, 1, 1},
                               .cone_offset = 1,
                               .emission = {9, 9, 9}};
    struct lit_mesh s = {.lights = {.lights = NULL}};
    int ended = 0;

    (void)state;
    s.mesh.materials[FLOOR] = mesh_material(MATERIAL_METAL, 0.9f);
    s.mesh.materials[FLOOR].alpha = 0.3f;
    s.mesh.world.settings.features = FEATURES_ALL;
    s.mesh.world.point_lights = &lamp;
    s.mesh.world.settings.point_light_count = 1;
    mesh_add_quad(&s.mesh, v3(-99, 0, 99), v3(99, 0, 99), v3(99, 0, -99),
                  v3(-99, 0, -99), FLOOR);
    lit_mesh_finish(&s);
    lit_mesh_lend(&s, DIRECT_MIS);
    for (uint64_t i = 0; i < 5000; i++) {
        struct first_surface first;
        struct path_sample all = follow(&s.mesh, v3(1, -0.2f, 0), i, &first);

        check_close(first.seen.x, 0, 0);
        check_close(first.direct.x, all.radiance.x, 0);
        assert_true(all.radiance.x > 0);
        ended += all.rays == 2; /* of the camera and to the lamp */
    }
    assert_true(ended > 50);
    lit_mesh_free(&s);
}

/* Sums of features have the means of what was added, at most 65,536 times; sums
 * of light have all. */
static void sums_are_of_what_was_added(void **state)
{
    struct surface_sums sums = {.count = 0};
    struct first_surface s = {.direct = {1, 2, 3},
                              .albedo = {0.25f, 0.5f, 1.25f},
                              .normal = {-1, 0, 0.6f},
                              .depth = 3,
                              .state = SURFACE_MET};
    double n = SURFACE_SAMPLES_MAX;

    (void)state;
    for (uint64_t i = 0; i < SURFACE_SAMPLES_MAX + 11; i++) {
        s.state = i % 4 == 0 ? SURFACE_AHEAD : SURFACE_BEHIND;
        surface_add(&sums, i, s, v3(4, 4, i % 2 ? 4 : (float)NAN));
    }
    assert_int_equal(sums.count, SURFACE_SAMPLES_MAX);
    assert_int_equal(sums.hit_count, SURFACE_SAMPLES_MAX / 4 * 3);
    check_close(sum_float(sums.direct[0]), n + 11, 0);
    check_close(sum_float(sums.odd_direct[1]), 2 * (n / 2 + 5), 0);
    check_close(sum_float(sums.direct[2]), 3 * (n / 2 + 5), 0);
    check_close(sums.albedo[0] / (n * 0.75 * SURFACE_ONE), 0.25, 1e-5);
    check_close(sums.albedo[2] / (n * 0.75 * SURFACE_ONE), 1, 1e-5);
    check_close(sums.normal[0], 0, 0);
    check_close(sums.normal[2] / (n * 0.75 * SURFACE_ONE), 0.8, 1e-5);
    check_close(sum_float(sums.depth_square), 9 * 0.75 * n, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_are_found),
        cmocka_unit_test(light_behind_coverage_is_not_seen),
        cmocka_unit_test(direct_light_is_that_of_short_paths),
        cmocka_unit_test(light_of_paths_that_end_is_not_seen),
        cmocka_unit_test(sums_are_of_what_was_added),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
