// SPDX-License-Identifier: MIT
/*
 * test_pick.c - picks against rays of the render, against closed forms in file
 * units, and at surfaces that let rays pass
 */
#include <math.h>
#include <unistd.h>

#include "engine/scene_load.h"
#include "studio/camera/framing.h"
#include "studio/camera/pick_cursor.h"
#include "tests/unit/brute.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"
#include "world/world.h"
#include "kernels/camera.h"

static struct host_world host; /* the most recently loaded scene */

static void load(struct scene *scene, const char *obj)
{
    struct warnings report = {0};
    struct world world;
    struct error err;

    *scene = (struct scene){0};
    put("a.obj", obj);
    check_or_say(scene_load(scene, "a.obj", SCENE_UP_OF_FILE, &report, &err) &&
                     world_init(&host, scene, 1, &report, &err),
                 err.text);
    world = world_arrays(&host, scene);
    check_or_say(world_ensure_tree(&host, &world, NULL, &err), err.text);
    warnings_free(&report);
}

static void unload(struct scene *scene)
{
    world_free(&host);
    scene_free(scene);
}

static struct view view_from(double x, double y, double z)
{
    struct view v;

    view_init(&v);
    v.pose.eye[0] = x;
    v.pose.eye[1] = y;
    v.pose.eye[2] = z;
    v.has_camera = true;
    return v;
}

/* Loads 2000 triangles of random places and sizes. */
static void load_soup(struct scene *scene)
{
    uint64_t seed = 5;
    char *text = NULL;
    size_t size_bytes;
    FILE *to = open_memstream(&text, &size_bytes);

    assert_non_null(to);
    for (int i = 0; i < 2000; i++) {
        double at[3], size = 0.5 * check_random(&seed);

        for (int k = 0; k < 3; k++)
            at[k] = 70 + 4 * check_random(&seed);
        for (int c = 0; c < 3; c++)
            fprintf(to, "v %.9g %.9g %.9g\n",
                    at[0] + size * check_random(&seed),
                    at[1] + size * check_random(&seed),
                    at[2] + size * check_random(&seed));
        fprintf(to, "f -3 -2 -1\n");
    }
    assert_int_equal(fclose(to), 0);
    load(scene, text);
    free(text);
}

/* Compares with the rays of samples, traced by brute force. */
static void picks_hit_what_the_render_hits(void **state)
{
    struct scene scene;
    struct surfaces surfaces = {&scene, &host};
    struct view view = view_from(72, 73, 78);
    struct world w;
    struct error err;
    uint32_t hit_count = 0;

    (void)state;
    load_soup(&scene);
    for (int k = 0; k < 3; k++)
        view.pose.at[k] = 72;
    view.pose.aperture = 1; /* a pick goes through the middle of the lens */
    assert_true(world_lend(&host, &scene, &view, 0, &w, &err));
    w.settings.camera.lens_radius = 0;
    for (uint32_t i = 0; i < 1000; i++) {
        uint32_t x = i * 617 % 1024, y = i * 211 % 576;
        struct camera_sample start = camera_sample_begin(&w.settings, x, y, i);
        struct vec2 at = random_2d(start.sampler, DIMENSION_PIXEL);
        struct pick pick;
        struct hit hit;
        bool is_hit = brute_force(&w, start.ray, &hit);

        assert_int_equal(surfaces_pick(&surfaces, &view, x + (double)at.x,
                                       y + (double)at.y, &pick),
                         is_hit);
        if (!is_hit)
            continue;
        hit_count++;
        assert_int_equal(pick.tri, hit.tri);
        check_close(pick.distance * scene.scale, hit.t, 0);
    }
    assert_in_range(hit_count, 200, 800);
    unload(&scene);
}

/* Loads a floor far from the origin, in named parts. */
static void picks_are_in_file_units(void **state)
{
    struct scene scene;
    struct surfaces surfaces = {&scene, &host};
    struct view view = view_from(1000, 2030, -500);
    struct pick pick;

    (void)state;
    put("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    load(&scene, "mtllib a.mtl\n"
                 "v 900 2000 -400\nv 1000 2000 -400\nv 1000 2000 -600\n"
                 "v 900 2000 -600\nv 1100 2000 -400\nv 1100 2000 -600\n"
                 "o left\nusemtl red\nf 1 2 3 4\n"
                 "o right\nusemtl blue\nf 2 5 6 3\n");
    view.pose.at[0] = 1010; /* 10 to the right and 30 down, on the floor */
    view.pose.at[1] = 2000;
    view.pose.at[2] = -500;
    assert_true(surfaces_pick(&surfaces, &view, 512, 288, &pick));
    assert_string_equal(scene.object_names[pick.object], "right");
    assert_string_equal(scene.material_names[pick.material], "blue");
    assert_int_equal(pick.face, 1);
    check_close(pick.position[0], 1010, 1e-4);
    check_close(pick.position[1], 2000, 1e-4);
    check_close(pick.position[2], -500, 1e-4);
    check_close(pick.distance, sqrt(1000), 1e-4);
    /* At the left edge the ray differs from the view direction, which is along
     * (3, *, 3), by half the horizontal field of view: it is along z. */
    double side = tan(20 * M_PI / 180) * 1024 / 576;
    assert_true(surfaces_pick(&surfaces, &view, 0, 288, &pick));
    check_close(pick.distance, sqrt(1000) * hypot(1, side), 1e-3);
    check_close(pick.position[2], -500 - sqrt(1000) * side, 1e-3);
    unload(&scene);
}

static void picks_have_the_box_of_their_object(void **state)
{
    struct scene scene;
    struct surfaces surfaces = {&scene, &host};
    struct framing f;

    (void)state;
    load(&scene, "o one\nv 1 2 3\nv 4 1 3\nv 2 5 9\nf 1 2 3\n"
                 "o two\nv -7 0 0\nv 0 -8 0\nv 0 0 20\nf 4 5 6\n");
    framing_init(&f, &surfaces, 1, 1);
    for (int k = 0; k < 3; k++) {
        check_close(f.lo[k], ((double[]){1, 1, 3})[k], 1e-5);
        check_close(f.hi[k], ((double[]){4, 5, 9})[k], 1e-5);
    }
    unload(&scene);
}

static void picks_of_the_sky_miss(void **state)
{
    struct scene scene;
    struct surfaces surfaces = {&scene, &host};
    struct view view = view_from(0, 0, 5);
    struct pick pick = {.tri = 77};

    (void)state;
    load(&scene, "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    assert_false(surfaces_pick(&surfaces, &view, 5, 5, &pick));
    assert_false(surfaces_pick(&surfaces, &view, -512, 288, &pick));
    assert_false(surfaces_pick(&surfaces, &view, 1024, 288, &pick));
    assert_false(surfaces_pick(&surfaces, &view, 512, 576, &pick));
    assert_false(surfaces_pick(&surfaces, &view, 512, NAN, &pick));
    assert_int_equal(pick.tri, 77);
    assert_true(surfaces_pick(&surfaces, &view, 512, 288, &pick));
    view.pose.at[2] = 5; /* without a direction */
    assert_false(surfaces_pick(&surfaces, &view, 512, 288, &pick));
    unload(&scene);
}

/* A pick goes through surfaces that are more transparent than solid: two sheets
 * before a wall. */
static void picks_pass_transparent_surfaces(void **state)
{
    struct scene scene;
    struct surfaces surfaces = {&scene, &host};
    struct view view = view_from(0, 0, 5);
    struct pick pick;

    (void)state;
    put("a.mtl", "newmtl clear\nd .4\nnewmtl dense\nd .6\n");
    load(&scene, "mtllib a.mtl\n"
                 "v -1 -1 2\nv 1 -1 2\nv 0 1 2\nusemtl clear\nf 1 2 3\n"
                 "v -1 -1 1\nv 1 -1 1\nv 0 1 1\nusemtl dense\nf 4 5 6\n"
                 "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 7 8 9\n");
    assert_true(surfaces_pick(&surfaces, &view, 512, 288, &pick));
    check_close(pick.distance, 4, 1e-6);
    unload(&scene);
}

/* 40 strips before a wall: all are picked if they cover more than a half, and
 * none if they cover less. Chance has no part in it. */
static void picks_are_not_random(void **state)
{
    static const char *const covers[] = {".4", ".6"};

    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        struct scene scene;
        struct surfaces surfaces = {&scene, &host};
        struct view view = view_from(0, 0, 5);
        char *text = NULL, mtl[64];
        size_t size_bytes;
        FILE *to = open_memstream(&text, &size_bytes);

        assert_non_null(to);
        fprintf(to, "mtllib a.mtl\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n"
                    "usemtl sheet\n");
        for (int i = 0; i < 40; i++)
            fprintf(to, "v %g -1 1\nv %g -1 1\nv %g 1 1\nf -3 -2 -1\n",
                    i * .05 - 1, i * .05 - .95, i * .05 - .975);
        assert_int_equal(fclose(to), 0);
        snprintf(mtl, sizeof mtl, "newmtl sheet\nd %s\n", covers[dense]);
        put("a.mtl", mtl);
        load(&scene, text);
        for (int i = 0; i < 40; i++) {
            double x = (i * .05 - .975) / (4 * tan(20 * M_PI / 180));
            struct pick pick;

            assert_true(
                surfaces_pick(&surfaces, &view, 512 + 288 * x, 300, &pick));
            check_close(pick.position[2], dense, 1e-5);
        }
        unload(&scene);
        free(text);
    }
}

/* The cells together cover the picture. */
static void cells_cover_the_picture(void **state)
{
    struct cells_rect fit = {.col = 3, .row = 2, .cols = 40, .rows = 10};
    double p[2];

    (void)state;
    assert_true(pick_cursor_point(&fit, 200, 100, 3, 2, p));
    check_close(p[0], 2.5, 1e-12);
    check_close(p[1], 5, 1e-12);
    assert_true(pick_cursor_point(&fit, 200, 100, 42, 11, p));
    check_close(p[0], 197.5, 1e-12);
    check_close(p[1], 95, 1e-12);
    assert_false(pick_cursor_point(&fit, 200, 100, 2, 2, p));
    assert_false(pick_cursor_point(&fit, 200, 100, 3, 1, p));
    assert_false(pick_cursor_point(&fit, 200, 100, 43, 2, p));
    assert_false(pick_cursor_point(&fit, 200, 100, 3, 12, p));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picks_hit_what_the_render_hits),
        cmocka_unit_test(picks_are_in_file_units),
        cmocka_unit_test(picks_have_the_box_of_their_object),
        cmocka_unit_test(picks_of_the_sky_miss),
        cmocka_unit_test(picks_pass_transparent_surfaces),
        cmocka_unit_test(picks_are_not_random),
        cmocka_unit_test(cells_cover_the_picture),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
