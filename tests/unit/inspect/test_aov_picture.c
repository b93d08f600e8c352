// SPDX-License-Identifier: MIT
/* Properties of surfaces in files: a wall and a sphere against closed forms. */
#include "tests/unit/check.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "inspect/aov_picture.h"
#include "inspect/view_modes.h"
#include "tests/unit/files.h"
#include "tests/unit/folder.h"
#include "tests/unit/instanced.h"

#define SIDE 16

static struct options options;
static float numbers[3 * SIDE * SIDE];

/* Fills the numbers for a part of the picture of a scene. */
static void render(const char *path, enum aov_kind kind, struct rect crop)
{
    struct session s;
    struct view_mode show;
    struct world world;
    struct error err;

    options_init(&options);
    options.scene_path = path;
    options.thread_count = 2;
    check_or_say(session_open(&s, &options, clock_ns(), &err), err.text);
    view_mode_init(&show, &s);
    check_or_say(view_mode_traced(&show, &world, &err), err.text);
    struct aov_picture a = {kind, &s.engine.scene, &world, crop};
    aov_picture_render(&a, view_mode_pool(&show), numbers);
    view_mode_free(&show);
    session_close(&s);
}

static void render_whole(const char *path, enum aov_kind kind)
{
    render(path, kind, (struct rect){0, 0, SIDE, SIDE});
}

static void check_pixel(const float *got, double x, double y, double z,
                        double bound)
{
    check_close((double)got[0], x, bound);
    check_close((double)got[1], y, bound);
    check_close((double)got[2], z, bound);
}

/* A wall of two halves at z = 995, 5 units before the eye, of which the lower
 * right quarter is missing; uv are x and y. */
static void write_wall(void)
{
    put("wall.mtl", "newmtl left\nKd 0.25 0.5 0.75\n"
                    "newmtl right\nKd 0 0 1\n");
    put("wall.obj", "mtllib wall.mtl\n"
                    "v -9 -9 995\nv 0 -9 995\nv 0 9 995\nv -9 9 995\n"
                    "v 0 0 995\nv 9 0 995\nv 9 9 995\n"
                    "vt -9 -9\nvt 0 -9\nvt 0 9\nvt -9 9\n"
                    "o Left\nusemtl left\nf 1/1 2/2 3/3 4/4\n"
                    "o Right\nusemtl right\nf 5 6 7 3\n");
    put("wall.view", "eye 0 0 1000\nat 0 0 0\nfovy 90\nres 16 16\n"
                     "background 1 1 1\n");
}

/* Calls the check for each pixel whose ray through the middle meets the wall,
 * with the slopes of the ray. Pixels at the edges are left out for means. */
static void for_pixels_of_wall(void (*check)(const float *got, double sx,
                                             double sy))
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double sx = 2 * (x + 0.5) / SIDE - 1;
            double sy = 1 - 2 * (y + 0.5) / SIDE;
            const float *got = numbers + 3 * (y * SIDE + x);

            if (sx > 0 && sy < 0)
                check_pixel(got, 0, 0, 0, 0);
            else
                check(got, sx, sy);
        }
}

static void check_depth(const float *got, double sx, double sy)
{
    double depth = 5 * sqrt(1 + sx * sx + sy * sy);

    check_pixel(got, depth, depth, depth, 1e-5);
}

/* Far from the origin the rays themselves have floats of normalised units. */
static void check_position(const float *got, double sx, double sy)
{
    check_pixel(got, 5 * sx, 5 * sy, 995, 1e-4);
}

static void check_normal(const float *got, double sx, double sy)
{
    (void)sx;
    (void)sy;
    check_pixel(got, 0, 0, 1, 1e-6);
}

static void check_albedo(const float *got, double sx, double sy)
{
    (void)sy;
    check_pixel(got, sx < 0 ? 0.25 : 0, sx < 0 ? 0.5 : 0, sx < 0 ? 0.75 : 1,
                1e-6);
}

static void check_uv(const float *got, double sx, double sy)
{
    check_pixel(got, sx < 0 ? 5 * sx : 0, sx < 0 ? 5 * sy : 0, sx < 0, 1e-4);
}

static void check_number(const float *got, double sx, double sy)
{
    int number = sx < 0 ? 2 : 3; /* 1 is that of faces without a name */

    (void)sy;
    check_pixel(got, number, number, number, 0);
}

static void a_wall_has_its_closed_forms(void **state)
{
    (void)state;
    write_wall();
    render_whole("wall.obj", AOV_DEPTH);
    for_pixels_of_wall(check_depth);
    render_whole("wall.obj", AOV_POSITION);
    for_pixels_of_wall(check_position);
    render_whole("wall.obj", AOV_NORMALS);
    for_pixels_of_wall(check_normal);
    render_whole("wall.obj", AOV_ALBEDO);
    for_pixels_of_wall(check_albedo);
    render_whole("wall.obj", AOV_UV);
    for_pixels_of_wall(check_uv);
    render_whole("wall.obj", AOV_OBJECT);
    for_pixels_of_wall(check_number);
    render_whole("wall.obj", AOV_MATERIAL);
    for_pixels_of_wall(check_number);
}

/* A part of the picture has the same numbers as the whole, also in means. */
static void a_part_has_the_pixels_of_the_whole(void **state)
{
    static float whole[3 * SIDE * SIDE];
    const struct rect part = {3, 5, 7, 9};

    (void)state;
    write_wall();
    render_whole("wall.obj", AOV_ALBEDO);
    memcpy(whole, numbers, sizeof whole);
    render("wall.obj", AOV_ALBEDO, part);
    for (int y = 0; y < part.height; y++)
        assert_memory_equal(numbers + 3 * y * part.width,
                            whole + 3 * ((y + part.y) * SIDE + part.x),
                            3 * sizeof *whole * (size_t)part.width);
}

/* Writes a sphere of radius 1 with its normals. */
static void write_sphere(void)
{
    enum { ROWS = 128, COLS = 256 };
    FILE *f = fopen("sphere.obj", "w");

    assert_non_null(f);
    for (int i = 0; i <= ROWS; i++)
        for (int k = 0; k < COLS; k++) {
            double a = M_PI * i / ROWS, b = 2 * M_PI * k / COLS;
            double x = sin(a) * cos(b), y = cos(a), z = -sin(a) * sin(b);

            fprintf(f, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", x, y, z, x, y,
                    z);
        }
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < COLS; k++) {
            int a = i * COLS + k + 1, b = i * COLS + (k + 1) % COLS + 1;

            fprintf(f, "f %d//%d %d//%d %d//%d %d//%d\n", a, a, a + COLS,
                    a + COLS, b + COLS, b + COLS, b, b);
        }
    fclose(f);
    put("sphere.view", "eye 0 0 4\nat 0 0 0\nfovy 24\nres 16 16\n");
}

static void a_sphere_has_its_normals_and_depth(void **state)
{
    static float depth[3 * SIDE * SIDE];
    double slope = tan(12 * M_PI / 180);

    (void)state;
    write_sphere();
    render_whole("sphere.obj", AOV_DEPTH);
    memcpy(depth, numbers, sizeof depth);
    render_whole("sphere.obj", AOV_NORMALS);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double sx = slope * (2 * (i % SIDE + 0.5) / SIDE - 1);
        double sy = slope * (1 - 2 * (i / SIDE + 0.5) / SIDE);
        double d2 = sx * sx + sy * sy + 1, h = 16 - 15 * d2, s;

        if (h < 1) /* near the rim and beyond */
            continue;
        s = (4 - sqrt(h)) / d2; /* |(0, 0, 4) + s (sx, sy, -1)| = 1 */
        check_close((double)depth[3 * i], s * sqrt(d2), 1e-3);
        /* the mean over a pixel of 0.1 units */
        check_pixel(numbers + 3 * i, s * sx, s * sy, 4 - s, 0.02);
    }
}

/* A plain triangle behind the eye, and two halves of a wall of one mesh: the
 * left one shows object 0, the right one object 1. */
static void make_halves(struct scene *s)
{
    static const struct affine left = {
        {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    static const struct affine right = {
        {{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    struct warnings report = {0};
    struct error err;

    *s = (struct scene){.path = strdup("test.obj")};
    instanced_parse(s, "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0.25 0.5 0.75\n",
                    "usemtl a\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n"
                    "o mesh\nusemtl b\nv -2 -2 0\nv 0 -2 0\nv 0 2 0\n"
                    "v -2 2 0\nf 4 5 6 7\n");
    assert_true(scene_add_instance(s, 0, &left, 0, &err));
    assert_true(scene_add_instance(s, 0, &right, 1, &err));
    s->instances.copied_tris = 0;
    check_or_say(scene_finish(s, &report, &err), err.text);
    assert_int_equal(s->placed_count, 2);
    warnings_free(&report);
}

static void instances_have_their_object_and_material(void **state)
{
    struct host_world host = {0};
    struct warnings report = {0};
    struct world world;
    struct scene scene;
    struct view view;
    struct error err;
    struct aov_picture a = {AOV_OBJECT, &scene, &world, {0, 0, SIDE, SIDE}};

    (void)state;
    make_halves(&scene);
    view_init(&view);
    view.pose.eye[2] = 4;
    view.pose.fovy_deg = 40;
    view_set_size(&view, SIDE, SIDE);
    check_or_say(world_init(&host, &scene, 1, &report, &err) &&
                     world_lend(&host, &scene, &view, 0, &world, &err) &&
                     world_ensure_tree(&host, &world, NULL, &err),
                 err.text);
    aov_picture_render(&a, NULL, numbers);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_int_equal(numbers[3 * i], i % SIDE < SIDE / 2 ? 1 : 2);
    a.kind = AOV_MATERIAL;
    aov_picture_render(&a, NULL, numbers);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_int_equal(numbers[3 * i], 3);
    a.kind = AOV_ALBEDO;
    aov_picture_render(&a, NULL, numbers);
    for (int i = 0; i < SIDE * SIDE; i++)
        check_pixel(numbers + 3 * i, 0.25, 0.5, 0.75, 1e-6);
    world_free(&host);
    view_free(&view);
    scene_free(&scene);
    warnings_free(&report);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_has_its_closed_forms),
        cmocka_unit_test(a_part_has_the_pixels_of_the_whole),
        cmocka_unit_test(a_sphere_has_its_normals_and_depth),
        cmocka_unit_test(instances_have_their_object_and_material),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
