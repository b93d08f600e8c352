// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "engine/scene_load.h"
#include "read/obj.h"
#include "scene/pose_fit.h"
#include "tests/unit/files.h"
#include "world/world_lamps.h"

/* Two texels: an opaque 255 128 0 and a transparent 10 20 30. */
static const unsigned char two_texels[] = {
    137, 80,  78,  71,  13, 10, 26,  10, 0,  0,  0,   13,  73,  72,  68,
    82,  0,   0,   0,   2,  0,  0,   0,  1,  8,  6,   0,   0,   0,   244,
    34,  127, 138, 0,   0,  0,  17,  73, 68, 65, 84,  120, 218, 99,  248,
    223, 192, 240, 159, 75, 68, 142, 1,  0,  17, 28,  2,   187, 140, 47,
    119, 109, 0,   0,   0,  0,  73,  69, 78, 68, 174, 66,  96,  130};

struct loaded {
    struct scene scene;
    struct host_world world;
    struct warnings report;
    struct error err;
};

static struct loaded load_as(const char *path, const char *text,
                             enum scene_up up)
{
    struct loaded l = {.scene = {.path = NULL}};

    put_bytes(path, text, strlen(text));
    if (!scene_load(&l.scene, path, up, &l.report, &l.err) ||
        !world_init(&l.world, &l.scene, 2, &l.report, &l.err)) {
        print_error("%s\n", l.err.text);
        _fail(__FILE__, __LINE__);
    }
    unlink(path);
    return l;
}

static struct loaded load_turned(const char *text, enum scene_up up)
{
    return load_as("a.obj", text, up);
}

static struct loaded load(const char *text)
{
    return load_turned(text, SCENE_UP_OF_FILE);
}

static void unload(struct loaded *l)
{
    world_free(&l->world);
    scene_free(&l->scene);
    warnings_free(&l->report);
}

/* Checks that every vertex used by a triangle has the place of the file, to the
 * precision of floats, and that the greatest extent is in [1, 2). */
static void check_normalized(const struct scene *s, const double *file)
{
    double extent = 0;
    int exponent;

    assert_true(frexp(s->scale, &exponent) == 0.5);
    for (int k = 0; k < 3; k++) {
        float lo = INFINITY;
        float hi = -INFINITY;

        for (uint32_t t = 0; t < s->tri_count; t++) {
            for (int c = 0; c < 3; c++) {
                uint32_t v = s->tris[t].v[c];
                const float xyz[] = {s->positions[v].x, s->positions[v].y,
                                     s->positions[v].z};
                double want =
                    (file[3 * v + (uint32_t)k] - s->center[k]) * s->scale;

                lo = xyz[k] < lo ? xyz[k] : lo;
                hi = xyz[k] > hi ? xyz[k] : hi;
                check_close((double)xyz[k], want, fabs(want) * 0x1p-24);
            }
        }
        extent = fmax(extent, (double)(hi - lo));
        check_close((double)(hi + lo), 0, 1e-6);
    }
    assert_true(extent >= 1);
    assert_true(extent < 2);
}

static void scenes_are_normalised(void **state)
{
    static const double sizes[] = {1e-300, 1e-30, 1e-6,  0.3,    1,
                                   1e6,    1e30,  1e300, 1.7e308};
    static const double offsets[] = {0, 1, -1};

    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        for (size_t j = 0; j < sizeof offsets / sizeof offsets[0]; j++) {
            double s = sizes[i];
            double o = offsets[j] * s / 2;
            double file[9] = {o - s / 2, o, 0,     o + s / 2, o,
                              s / 4,     o, s / 3, s / 5};
            char text[512];
            struct loaded l;

            snprintf(text, sizeof text,
                     "v %.17g %.17g %.17g\nv %.17g %.17g %.17g\n"
                     "v %.17g %.17g %.17g\nf 1 2 3\n",
                     file[0], file[1], file[2], file[3], file[4], file[5],
                     file[6], file[7], file[8]);
            l = load(text);
            assert_int_equal(l.scene.tri_count, 1);
            assert_int_equal(l.report.entry_count, 0);
            assert_null(l.scene.file_positions);
            check_normalized(&l.scene, file);
            assert_true(l.scene.bounds_lo[0] == file[0]);
            assert_true(l.scene.bounds_hi[0] == file[3]);
            unload(&l);
        }
    }
}

static void triangles_without_area_are_dropped(void **state)
{
    struct loaded l = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv .1 .1 .1\n"
                           "v .3 .3 .3\nf 1 1 1\nf 1 2 2\nf 1 4 2\nf 1 5 6\n"
                           "f 1 2 3\nf 2 3 2\n");

    (void)state;
    assert_int_equal(l.scene.tri_count, 1);
    assert_int_equal(l.scene.tri_faces[0], 4);
    assert_int_equal(l.report.entry_count, 1);
    assert_int_equal(l.report.entries[0].count, 5);
    assert_string_equal(l.report.entries[0].kind, "triangles without area");
    unload(&l);
}

/* An area of the file that is zero in floats: a speck beside a large world. */
static void triangles_too_small_for_floats_are_dropped(void **state)
{
    struct loaded l = load("v 0 0 0\nv 1e12 0 0\nv 0 1e12 0\nv 1 1 0\n"
                           "v 1.001 1 0\nv 1 1.001 0\nf 1 2 3\nf 4 5 6\n");

    (void)state;
    assert_int_equal(l.scene.tri_count, 1);
    assert_int_equal(l.report.entry_count, 1);
    unload(&l);
}

/* Beside an edge of 5e38 an edge of 1 is 2^-129, which has no reciprocal. The
 * first face keeps its normal; rounding leaves nothing of the second. */
static void needles_keep_their_normals(void **state)
{
    static const char *const others[] = {"v 0 1 0", "v 0 1e-9 0", "v 0 1e30 0"};

    (void)state;
    for (int i = 0; i < 3; i++) {
        char text[128];
        struct loaded l;

        snprintf(text, sizeof text,
                 "v -5e38 0 0\nv 0 0 0\nv 0 0 1\n%s\nf 1 2 3\nf 1 4 3\n",
                 others[i]);
        l = load(text);
        assert_in_range(l.scene.tri_count, 1, 2);
        assert_int_equal(l.scene.tri_count + l.scene.dropped_count, 2);
        assert_int_equal(l.report.entry_count, l.scene.dropped_count);
        assert_true(fabsf(l.scene.tris[0].ng.y) == 1);
        for (uint32_t k = 0; k < l.scene.tri_count; k++)
            check_close(hypot(hypot((double)l.scene.tris[k].ng.x,
                                    (double)l.scene.tris[k].ng.y),
                              (double)l.scene.tris[k].ng.z),
                        1, 1e-6);
        unload(&l);
    }
}

static void unused_vertices_have_no_effect(void **state)
{
    struct loaded l = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e9 0 0\nv nan 0 0\n"
                           "v 1e308 -1e308 inf\nf 1 2 3\n");

    (void)state;
    assert_int_equal(l.report.entry_count, 0);
    check_close(l.scene.scale, 1, 0);
    check_close(l.scene.center[0], 0.5, 0);
    check_close(l.scene.bounds_hi[0], 1, 0);
    for (uint32_t i = 0; i < l.scene.position_count; i++) {
        assert_true(isfinite(l.scene.positions[i].x));
        assert_true(isfinite(l.scene.positions[i].y));
        assert_true(isfinite(l.scene.positions[i].z));
    }
    unload(&l);
}

static void scenes_without_faces_are_accepted(void **state)
{
    struct loaded l = load("v 1 2 3\np 1\n");
    struct view view;
    struct world world;

    (void)state;
    assert_int_equal(l.scene.tri_count, 0);
    assert_int_equal(l.report.entry_count, 0);
    check_close(l.scene.scale, 1, 0);
    check_close(l.scene.center[1], 0, 0);
    view_init(&view);
    scene_frame(&l.scene, &view);
    assert_true(world_lend(&l.world, &l.scene, &view, 0, &world, &l.err));
    assert_int_equal(world.settings.tri_count, 0);
    view_free(&view);
    unload(&l);
}

/* Copies of a face begin at the same corner, whichever is the first in the
 * file. Winding, texture coordinates and normals stay with their corners. */
static void copies_begin_at_the_same_corner(void **state)
{
    static const uint32_t expected[4][3] = {{1, 2, 0},
                                            {1, 2, 0},
                                            {1, 2, 0},
                                            {1, 0, 2}};
    struct loaded l = load("v 1 2 3\nv 0 5 1\nv 0 6 -1\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\n"
                           "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\n"
                           "f 1/1/1 2/2/2 3/3/3\nf 2/2/2 3/3/3 1/1/1\n"
                           "f 3/3/3 1/1/1 2/2/2\nf 3/3/3 2/2/2 1/1/1\n");

    (void)state;
    assert_int_equal(l.scene.tri_count, 4);
    for (int i = 0; i < 4; i++) {
        const struct tri *t = &l.scene.tris[i];

        assert_memory_equal(t->v, expected[i], sizeof t->v);
        assert_memory_equal(t->vt, expected[i], sizeof t->vt);
        assert_memory_equal(t->vn, expected[i], sizeof t->vn);
    }
    unload(&l);
}

static void z_up_turns_the_scene(void **state)
{
    struct loaded l = load_turned("v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 -1 0\n"
                                  "vn 0 1 0\nf 1//1 2//1 3//1\nf 1 2 4\n",
                                  SCENE_UP_Z);
    const struct vec3 *p = l.scene.positions;

    (void)state;
    check_close((double)(p[2].y - p[0].y), 1, 0);
    check_close((double)(p[3].z - p[0].z), 1, 0);
    check_close((double)(p[1].x - p[0].x), 1, 0);
    check_close((double)l.scene.normals[0].z, -1, 0);
    unload(&l);
}

static void textures_are_read_with_their_options(void **state)
{
    static const char mtl[] =
        "newmtl a\nKd .5 .5 .5\nmap_Kd two.png\nnewmtl b\nKd 0 0 0\n"
        "map_Kd two.png\nnewmtl c\nmap_Kd two.png\nmap_Ke two.png\n"
        "newmtl d\nmap_Kd lost.png\nKe 0 0 0\nmap_Ke lost.png\n"
        "newmtl e\nKd .5 .5 .5\nmap_Kd lost.png\nKe 2 2 2\nmap_Ke two.png\n"
        "newmtl f\nmap_Kd unused.png\n";
    static const float colors[] = {0.8f, 0.5f, 1, 1, 0.8f, 0.5f};
    static const float emissions[] = {0, 0, 0, 1, 0, 2};
    struct loaded l;

    (void)state;
    put_bytes("two.png", two_texels, sizeof two_texels);
    put_bytes("a.mtl", mtl, strlen(mtl));
    l = load("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"
             "usemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl d\nf 1 2 3\n"
             "usemtl e\nf 1 2 3\n");
    unlink("two.png");
    unlink("a.mtl");
    assert_int_equal(l.scene.texture_count, 3);
    assert_int_equal(l.world.textures[0].width, 2);
    assert_int_equal(l.world.textures[0].height, 1);
    assert_int_equal(l.world.textures[0].first, 0);
    assert_int_equal(l.world.textures[0].has_alpha, 1);
    assert_int_equal(l.world.texel_count, 2);
    assert_int_equal(l.world.texels[0], 0xff0080ffu);
    assert_int_equal(l.world.texels[1] & 0xff000000u, 0);
    for (uint32_t i = 1; i < 6; i++) {
        const struct material *m = &l.world.materials[i];

        check_close((double)m->color.y, (double)colors[i], 0);
        check_close((double)m->emission.y, (double)emissions[i], 0);
        assert_int_equal(m->color_texture, i <= 3 ? 0 : NO_INDEX);
        assert_int_equal(m->emission_texture, i == 3 || i == 5 ? 0 : NO_INDEX);
    }
    assert_int_equal(l.report.entry_count, 1);
    assert_int_equal(l.report.entries[0].count, 1);
    assert_non_null(strstr(l.report.entries[0].text, "lost.png"));
    assert_true(world_has_emitters(&l.world));
    unload(&l);
}

/* Materials may be used before they are defined. */
static void libraries_are_found_beside_the_scene(void **state)
{
    static const char one[] = "newmtl one\nKd 1 0 0\n";
    static const char two[] = "newmtl two\nKd 0 1 0\nKe 1 1 1\n";
    struct loaded l;

    (void)state;
    put_bytes("a b.mtl", one, strlen(one));
    put_bytes("c.mtl", two, strlen(two));
    l = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl two\nf 1 2 3\n"
             "mtllib a b.mtl c.mtl\nmtllib c.mtl\nmtllib a b.mtl\n"
             "usemtl one\nf 1 2 3\n");
    unlink("a b.mtl");
    unlink("c.mtl");
    assert_int_equal(l.report.entry_count, 0);
    assert_int_equal(l.scene.material_count, 3);
    check_close(l.world.materials[l.scene.tris[0].material].color.y, 1, 0);
    check_close(l.world.materials[l.scene.tris[1].material].color.x, 1, 0);
    assert_true(world_has_emitters(&l.world));
    assert_int_equal(l.world.lights.light_count, 1);
    assert_int_equal(l.world.lights.tri_lights[0], 0);
    assert_int_equal(l.world.lights.tri_lights[1], NO_INDEX);
    unload(&l);
    l = load("mtllib no such.mtl\nmtllib other\nv 0 0 0\n"
             "mtllib no such.mtl\n");
    assert_int_equal(l.report.entry_count, 2);
    assert_string_equal(l.report.entries[0].text,
                        "a.obj:1: found no file 'no such.mtl' for mtllib: its "
                        "materials are missing");
    assert_int_equal(l.report.entries[0].count, 2);
    unload(&l);
}

/* Projects a point of the file. Visible points are in [-1, 1]. */
static void project(const struct scene *s, const struct world *w,
                    const double point[3], double *x, double *y, double *z)
{
    const struct camera *c = &w->settings.camera;
    double d[3] = {(point[0] - s->center[0]) * s->scale - (double)c->eye.x,
                   (point[1] - s->center[1]) * s->scale - (double)c->eye.y,
                   (point[2] - s->center[2]) * s->scale - (double)c->eye.z};
    const struct vec3 *axes[3] = {&c->right, &c->up, &c->forward};
    double along[3];

    for (int i = 0; i < 3; i++) {
        double ax = (double)axes[i]->x;
        double ay = (double)axes[i]->y;
        double az = (double)axes[i]->z;

        along[i] =
            (d[0] * ax + d[1] * ay + d[2] * az) / (ax * ax + ay * ay + az * az);
    }
    *x = along[0] / along[2];
    *y = along[1] / along[2];
    *z = along[2];
}

static void framing_shows_everything(void **state)
{
    static const double fovys[] = {1, 20, 40, 90, 170};
    static const int sizes[][2] = {{100, 100}, {1600, 90}, {90, 1600}};
    struct loaded l = load("v 10 20 30\nv 14 20 30\nv 10 27 30\nv 10 20 31\n"
                           "f 1 2 3\nf 1 2 4\n");

    (void)state;
    for (size_t i = 0; i < 15; i++) {
        struct view view;
        struct world world;
        double most = 0;

        view_init(&view);
        view.pose.fovy_deg = fovys[i % 5];
        view.width_px = sizes[i / 5][0];
        view.height_px = sizes[i / 5][1];
        scene_frame(&l.scene, &view);
        assert_true(world_lend(&l.world, &l.scene, &view, 0, &world, &l.err));
        for (int corner = 0; corner < 8; corner++) {
            double p[3], x, y, z;

            for (int k = 0; k < 3; k++)
                p[k] = corner >> k & 1 ? l.scene.bounds_hi[k]
                                       : l.scene.bounds_lo[k];
            project(&l.scene, &world, p, &x, &y, &z);
            assert_true(z > 0);
            most = fmax(most, fmax(fabs(x), fabs(y)));
        }
        assert_true(most < 1);
        assert_true(most > 0.3 || view.pose.fovy_deg > 90);
        assert_true(view.pose.eye[2] > view.pose.at[2] &&
                    view.pose.eye[1] > view.pose.at[1]);
        view_free(&view);
    }
    unload(&l);
}

#define CUBE(a, b)                                                             \
    "v " a " " a " " a "\nv " b " " a " " a "\nv " b " " b " " a "\nv " a      \
    " " b " " a "\nv " a " " a " " b "\nv " b " " a " " b "\nv " b " " b " " b \
    "\nv " a " " b " " b "\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 4 3 7 8\n"

/* Finds the least and greatest x and y of a box in the picture. */
static void find_extent(const struct scene *scene, const struct world *world,
                        const double low[3], const double high[3], double lo[2],
                        double hi[2])
{
    for (int k = 0; k < 2; k++) {
        lo[k] = INFINITY;
        hi[k] = -INFINITY;
    }
    for (int corner = 0; corner < 8; corner++) {
        double p[3], xy[2], depth;

        for (int k = 0; k < 3; k++)
            p[k] = corner >> k & 1 ? high[k] : low[k];
        project(scene, world, p, &xy[0], &xy[1], &depth);
        for (int k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], xy[k]);
            hi[k] = fmax(hi[k], xy[k]);
        }
    }
}

/* A cube of half the side a = 1 fills CAMERA_FILL of the width or the height,
 * is in the middle, and the eye is at the distance that follows: with the slope
 * s of the sides, a / s + a (sin 20 + cos 20) where the width decides, and half
 * the sum of the distances for top and bottom where the height does. */
static void framed_cubes_fill_the_picture(void **state)
{
    static const int sizes[][2] = {{100, 100}, {1024, 576}, {800, 200},
                                   {200, 800}, {1600, 90},  {90, 1600}};
    static const double least[3] = {9, 9, 9}, most[3] = {11, 11, 11};
    const double up = sin(20 * M_PI / 180), level = cos(20 * M_PI / 180);
    struct loaded l = load(CUBE("9", "11"));

    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        double s = CAMERA_FILL * tan(20 * M_PI / 180);
        double side = s * sizes[i][0] / sizes[i][1];
        double across = 1 / side + up + level;
        double high = (level + s * up + fabs(up - s * level) + level - s * up +
                       up + s * level) /
                      (2 * s);
        double lo[2], hi[2];
        struct world world;
        struct view view;

        view_init(&view);
        view.pose.fovy_deg = 40;
        view.width_px = sizes[i][0];
        view.height_px = sizes[i][1];
        scene_frame(&l.scene, &view);
        check_close(pose_reach(&view.pose), fmax(across, high), 1e-6);
        assert_true(world_lend(&l.world, &l.scene, &view, 0, &world, &l.err));
        find_extent(&l.scene, &world, least, most, lo, hi);
        for (int k = 0; k < 2; k++)
            check_close(lo[k] + hi[k], 0, 1e-5);
        check_close(across > high ? hi[0] : hi[1], CAMERA_FILL, 1e-5);
        check_at_most(across > high ? hi[1] : hi[0], CAMERA_FILL + 1e-5);
        view_free(&view);
    }
    unload(&l);
}

/* A floor is low in the picture, and as far from its middle above as below. */
static void floors_are_in_the_middle(void **state)
{
    struct loaded l = load("v 1 0 1\nv 1 0 5\nv 9 0 5\nv 9 0 1\nf 1 2 3 4\n");
    static const double low[3] = {1, 0, 1}, high[3] = {9, 0, 5};
    double lo[2], hi[2];
    struct world world;
    struct view view;

    (void)state;
    view_init(&view);
    scene_frame(&l.scene, &view);
    assert_true(world_lend(&l.world, &l.scene, &view, 0, &world, &l.err));
    find_extent(&l.scene, &world, low, high, lo, hi);
    check_close(hi[0], CAMERA_FILL, 1e-5);
    check_at_most(hi[1], CAMERA_FILL / 2);
    for (int k = 0; k < 2; k++)
        check_close(lo[k] + hi[k], 0, 1e-5);
    view_free(&view);
    unload(&l);
}

/* The eye comes to the near end of a line along the view, and no nearer. */
static void lines_along_the_view_have_a_place(void **state)
{
    struct pose pose = {.eye = {0, 0, 5}, .up = {0, 1, 0}, .fovy_deg = 40};
    const double half[3] = {0, 0, 1}, center[3] = {2, 3, 4};
    const double eye[3] = {2, 3, 5}, at[3] = {2, 3, 4};
    struct pose_fit fit;

    (void)state;
    pose_fit_begin(&fit, &pose, 1.5);
    pose_fit_add_box(&fit, half);
    pose_fit_place(&fit, center, 1, 1, &pose);
    for (int k = 0; k < 3; k++) {
        check_close(pose.eye[k], eye[k], 1e-12);
        check_close(pose.at[k], at[k], 1e-12);
    }
}

#define OCTAHEDRON                                                    \
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\n"     \
    "property float y\nproperty float z\nelement face 8\n"            \
    "property list uchar int vertex_indices\nend_header\n"            \
    "1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n3 0 2 4\n3 2 1 4\n" \
    "3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n"

/* A wall in the plane x = 0 is not seen edge-on: the eye is 30 degrees beside
 * it, and 20 above. A wall of a hundredth of its length is thick enough. */
static void a_wall_along_the_view_is_seen(void **state)
{
    static const struct {
        const char *x;
        double side;
    } cases[] = {{"0", 0.5}, {"-0.02", 0}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *text = format_text("v 0 0 0\nv 0 0 2\nv 0 2 2\nv %s 2 0\n"
                                 "f 1 2 3 4\n",
                                 cases[i].x);
        struct loaded l = load(text);
        struct view view;

        view_init(&view);
        scene_frame(&l.scene, &view);
        check_close((view.pose.eye[0] - view.pose.at[0]) /
                        pose_reach(&view.pose),
                    cases[i].side * cos(20 * M_PI / 180), 1e-9);
        view_free(&view);
        unload(&l);
        free(text);
    }
}

/* A model's own corners fill CAMERA_FILL of the picture. The corners of the box
 * around an octahedron lie far outside of it, and would leave it smaller. */
static void models_fill_the_picture(void **state)
{
    static const int sizes[][2] = {{400, 100}, {100, 400}};
    struct loaded l = load_as("a.ply", OCTAHEDRON, SCENE_UP_OF_FILE);

    (void)state;
    for (int i = 0; i < 2; i++) {
        double most[2] = {0, 0};
        struct world world;
        struct view view;

        view_init(&view);
        view.width_px = sizes[i][0];
        view.height_px = sizes[i][1];
        scene_frame(&l.scene, &view);
        assert_true(world_lend(&l.world, &l.scene, &view, 0, &world, &l.err));
        for (int corner = 0; corner < 6; corner++) {
            double p[3] = {0, 0, 0}, xy[2], z;

            p[corner / 2] = corner % 2 == 0 ? 1 : -1;
            project(&l.scene, &world, p, &xy[0], &xy[1], &z);
            for (int k = 0; k < 2; k++)
                most[k] = fmax(most[k], fabs(xy[k]));
        }
        check_close(most[i == 0], CAMERA_FILL, 1e-5);
        check_at_most(most[i != 0], CAMERA_FILL);
        view_free(&view);
    }
    unload(&l);
}

static void check_vec(struct vec3 v, double x, double y, double z)
{
    check_close((double)v.x, x, 1e-6);
    check_close((double)v.y, y, 1e-6);
    check_close((double)v.z, z, 1e-6);
}

static void camera_is_in_scene_units(void **state)
{
    struct loaded l = load("v 0 0 0\nv 4 0 0\nv 0 2 0\nf 1 2 3\n");
    struct world w;
    struct view view;

    (void)state;
    view_init(&view);
    memcpy(view.pose.eye, (double[]){2, 1, 8}, sizeof view.pose.eye);
    memcpy(view.pose.at, (double[]){2, 1, 0}, sizeof view.pose.at);
    view.pose.fovy_deg = 90;
    view.width_px = 200;
    view.height_px = 100;
    assert_true(world_lend(&l.world, &l.scene, &view, 7, &w, &l.err));
    /* The centre is 2 1 0 and the extent 4: a scale of 1/4. */
    check_vec(w.settings.camera.eye, 0, 0, 2);
    check_vec(w.settings.camera.forward, 0, 0, -1);
    check_vec(w.settings.camera.right, 2, 0, 0);
    check_vec(w.settings.camera.up, 0, 1, 0);
    check_close((double)w.settings.camera.width, 200, 0);
    assert_int_equal(w.settings.seed, 7);
    assert_int_equal(w.settings.max_vertices, 1000);
    assert_int_equal(w.settings.features, 0);
    assert_true(w.settings.camera.lens_radius == 0);
    view.pose.aperture = 0.8; /* a radius of .4, and a focus distance of 8 */
    assert_true(world_lend(&l.world, &l.scene, &view, 7, &w, &l.err));
    check_close((double)w.settings.camera.lens_radius, 0.1, 1e-7);
    check_close((double)w.settings.camera.focus, 2, 1e-6);
    view.pose.focus = 12;
    assert_true(world_lend(&l.world, &l.scene, &view, 7, &w, &l.err));
    check_close((double)w.settings.camera.focus, 3, 1e-6);
    view.max_bounces = 0;
    memcpy(view.pose.up, (double[]){1e300, 1e300, 0}, sizeof view.pose.up);
    assert_true(world_lend(&l.world, &l.scene, &view, 7, &w, &l.err));
    check_vec(w.settings.camera.up, sqrt(.5), sqrt(.5), 0);
    assert_int_equal(w.settings.max_vertices, 1);
    view_free(&view);
    unload(&l);
}

/* A view straight down with +y up, or without up, gives a picture with upright
 * axes. */
static void up_along_the_view_is_replaced(void **state)
{
    static const double ups[][3] = {
        {0, 1, 0}, {0, -5, 0}, {0, 0, 0}, {1e-8, 1, 0}, {NAN, 1, 0}};
    struct loaded l = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");

    (void)state;
    for (size_t i = 0; i < sizeof ups / sizeof ups[0]; i++) {
        struct view view;
        struct world w;
        double dot;

        view_init(&view);
        view.pose.fovy_deg = 90;
        view.width_px = view.height_px = 100;
        memcpy(view.pose.eye, (double[]){.5, 9, 0}, sizeof view.pose.eye);
        memcpy(view.pose.at, (double[]){.5, 0, 0}, sizeof view.pose.at);
        memcpy(view.pose.up, ups[i], sizeof view.pose.up);
        if (world_lend(&l.world, &l.scene, &view, 0, &w, &l.err)) {
            struct vec3 r = w.settings.camera.right;
            struct vec3 u = w.settings.camera.up;

            dot = (double)(r.x * u.x + r.y * u.y + r.z * u.z);
            check_close(dot, 0, 1e-6);
            check_close((double)(r.x * r.x + r.y * r.y + r.z * r.z), 1, 1e-6);
            check_close((double)(u.x * u.x + u.y * u.y + u.z * u.z), 1, 1e-6);
            check_vec(w.settings.camera.forward, 0, -1, 0);
        } else {
            assert_true(i >= 2);
        }
        view_free(&view);
    }
    unload(&l);
}

static void impossible_cameras_are_refused(void **state)
{
    struct loaded l = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    struct world w;
    struct view view;

    (void)state;
    view_init(&view);
    memcpy(view.pose.eye, (double[]){1, 2, 3}, sizeof view.pose.eye);
    memcpy(view.pose.at, (double[]){1, 2, 3}, sizeof view.pose.at);
    assert_false(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    view.pose.eye[0] = NAN;
    assert_false(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    view.pose.eye[0] = 1e300;
    assert_false(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    view_free(&view);
    unload(&l);
}

static void skies_are_read(void **state)
{
    struct loaded l = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    struct view view;
    struct world w;

    (void)state;
    view_init(&view);
    memcpy(view.pose.eye, (double[]){0, 0, 3}, sizeof view.pose.eye);
    memcpy(view.lighting.background, (double[]){.25, .5, 8},
           sizeof view.lighting.background);
    assert_true(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    check_vec(w.settings.sky.color, .25, .5, 8);
    assert_int_equal(w.settings.sky.width, 0);
    assert_true(w.settings.sky_share == 1 && w.settings.light_share == 0);

    put_bytes("two.png", two_texels, sizeof two_texels);
    view.lighting.sky_path = strdup("two.png");
    view.lighting.sky_strength = 3;
    view.lighting.sky_rotation_deg = 90;
    assert_true(world_load_sky(&l.world, &view, &l.report, &l.err));
    unlink("two.png");
    assert_true(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    check_vec(w.settings.sky.color, 3, 3, 3);
    assert_int_equal(w.settings.sky.width, 2);
    assert_int_equal(w.settings.sky.height, 1);
    check_close((double)w.settings.sky.rotation_sin, 1, 1e-7);
    check_close((double)w.settings.sky.rotation_cos, 0, 1e-7);
    check_vec(w.sky_texels[0], 1, 0.21586050, 0);
    assert_true(w.sky_cdf != NULL && w.settings.sky_share == 1 &&
                w.settings.light_share == 0);
    view.lighting.sky_strength = 0;
    assert_true(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    assert_true(w.settings.sky_share == 0);

    assert_false(world_load_sky(&l.world, &view, &l.report, &l.err));
    free(view.lighting.sky_path);
    view.lighting.sky_path = NULL;
    assert_true(world_load_sky(&l.world, &view, &l.report, &l.err));
    assert_null(l.world.sky_texels);
    view_free(&view);
    unload(&l);
}

/* Lamps of a scene that is scaled by 1/8 and moved: lengths are scaled, an
 * intensity by the square, and radiance and irradiance stay. */
static void lamps_are_normalised(void **state)
{
    struct loaded l = load("v 2 0 0\nv 10 0 0\nv 2 0 8\nf 1 3 2\n");
    const struct point_light *points;
    const struct directional_light *d;
    struct lamp lamps[4];
    struct view view;
    struct world w;
    uint64_t version, generation;

    (void)state;
    view_init(&view);
    view.pose = (struct pose){.eye = {0, 0, 3}, .up = {0, 1}, .fovy_deg = 40};
    lamp_init(&lamps[0], LAMP_SPOT);
    memcpy(lamps[0].position, (double[]){6, 4, 4}, sizeof lamps[0].position);
    memcpy(lamps[0].at, (double[]){6, 0, 4}, sizeof lamps[0].at);
    memcpy(lamps[0].rgb, (double[]){16, 32, 64}, sizeof lamps[0].rgb);
    lamps[0].inner_deg = 60;
    lamps[0].outer_deg = 90;
    lamp_init(&lamps[1], LAMP_POINT);
    lamps[1].radius = 2;
    lamp_init(&lamps[2], LAMP_DIRECTIONAL);
    lamps[2].azimuth_deg = 90;
    lamps[2].elevation_deg = 30;
    lamps[2].angle_deg = 60;
    memcpy(lamps[2].rgb, (double[]){1, 2, 3}, sizeof lamps[2].rgb);
    lamp_init(&lamps[3], LAMP_POINT);
    memset(lamps[3].rgb, 0, sizeof lamps[3].rgb);
    for (int i = 0; i < 4; i++)
        assert_true(lamps_add(&view.lamps, &lamps[i]));
    assert_true(world_set_lamps(&l.world, &l.scene, &view, &l.err));
    assert_true(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
    assert_int_equal(w.settings.point_light_count, 2);
    assert_int_equal(w.settings.sphere_count, 1);
    assert_int_equal(w.settings.directional_light_count, 1);
    assert_true(w.settings.features ==
                (FEATURE_POINT_LIGHTS | FEATURE_DIRECTIONAL_LIGHTS));
    assert_true(w.settings.sky_share == 0.5f && w.settings.light_share == 0.5f);
    points = w.point_lights;
    check_vec(points[0].p, -.75, 0, -.5);
    check_close((double)points[0].radius, .25, 1e-7);
    check_close((double)points[0].emission.x, 1 / (4 * M_PI), 1e-7);
    check_vec(points[1].p, 0, .5, 0);
    check_vec(points[1].emission, .25, .5, 1);
    check_vec(points[1].axis, 0, -1, 0);
    check_close((double)points[1].cone_scale, 2, 1e-6);
    check_close((double)points[1].cone_offset, 0, 1e-6);
    d = w.directional_lights;
    check_vec(d->d, cos(M_PI / 6), .5, 0);
    check_close((double)d->size, 1 - cos(M_PI / 6), 1e-7);
    check_close((double)d->sine, .5, 1e-7);
    check_vec(d->emission, 4 / M_PI, 8 / M_PI, 12 / M_PI);
    check_close((double)d->power, 2, 1e-6);

    /* equal lamps are no change, and each kind has its own version */
    generation = l.world.generation;
    version = l.world.versions[WORLD_LIGHTS];
    assert_true(world_set_lamps(&l.world, &l.scene, &view, &l.err));
    assert_true(l.world.generation == generation);
    view.lamps.items[2].elevation_deg = 0;
    assert_true(world_set_lamps(&l.world, &l.scene, &view, &l.err));
    assert_true(l.world.generation > generation &&
                l.world.versions[WORLD_LIGHTS] == version);
    view.lamps.items[0].radius = 1;
    assert_true(world_set_lamps(&l.world, &l.scene, &view, &l.err));
    assert_true(l.world.versions[WORLD_LIGHTS] > version);
    lamps_free(&view.lamps);
    assert_true(world_set_lamps(&l.world, &l.scene, &view, &l.err));
    assert_int_equal(world_features(&l.world), 0);
    view_free(&view);
    unload(&l);
}

static void only_transparent_materials_have_coverage(void **state)
{
    static const char *const mtls[] = {"newmtl m\nKd .5\n", "newmtl m\nd .5\n",
                                       "newmtl m\nKd .5\nmap_Kd two.png\n",
                                       "newmtl m\nd .5\nillum 7\n"};

    (void)state;
    put_bytes("two.png", two_texels, sizeof two_texels);
    for (size_t i = 0; i < sizeof mtls / sizeof mtls[0]; i++) {
        struct loaded l;
        struct view view;
        struct world w;

        put_bytes("a.mtl", mtls[i], strlen(mtls[i]));
        l = load("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\n"
                 "f 1 2 3\n");
        view_init(&view);
        scene_frame(&l.scene, &view);
        assert_true(world_lend(&l.world, &l.scene, &view, 0, &w, &l.err));
        assert_int_equal(w.settings.features & FEATURE_COVERAGE,
                         i == 1 || i == 2 ? FEATURE_COVERAGE : 0);
        view_free(&view);
        unload(&l);
    }
    unlink("a.mtl");
    unlink("two.png");
}

/* Compares with the numbers of the standard. */
static void srgb_table_is_that_of_the_standard(void **state)
{
    struct loaded l = load("v 0 0 0\n");

    (void)state;
    check_close((double)l.world.linear_of_srgb[0], 0, 0);
    check_close((double)l.world.linear_of_srgb[255], 1, 0);
    check_close((double)l.world.linear_of_srgb[10], 0.0030352698, 1e-9);
    check_close((double)l.world.linear_of_srgb[11], 0.0033465358, 1e-9);
    check_close((double)l.world.linear_of_srgb[128], 0.2158605, 1e-7);
    check_close((double)l.world.linear_of_srgb[188], 0.50288646, 1e-7);
    unload(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_are_normalised),
        cmocka_unit_test(triangles_without_area_are_dropped),
        cmocka_unit_test(triangles_too_small_for_floats_are_dropped),
        cmocka_unit_test(needles_keep_their_normals),
        cmocka_unit_test(unused_vertices_have_no_effect),
        cmocka_unit_test(scenes_without_faces_are_accepted),
        cmocka_unit_test(copies_begin_at_the_same_corner),
        cmocka_unit_test(z_up_turns_the_scene),
        cmocka_unit_test(textures_are_read_with_their_options),
        cmocka_unit_test(libraries_are_found_beside_the_scene),
        cmocka_unit_test(framing_shows_everything),
        cmocka_unit_test(framed_cubes_fill_the_picture),
        cmocka_unit_test(a_wall_along_the_view_is_seen),
        cmocka_unit_test(floors_are_in_the_middle),
        cmocka_unit_test(lines_along_the_view_have_a_place),
        cmocka_unit_test(models_fill_the_picture),
        cmocka_unit_test(camera_is_in_scene_units),
        cmocka_unit_test(up_along_the_view_is_replaced),
        cmocka_unit_test(impossible_cameras_are_refused),
        cmocka_unit_test(skies_are_read),
        cmocka_unit_test(lamps_are_normalised),
        cmocka_unit_test(only_transparent_materials_have_coverage),
        cmocka_unit_test(srgb_table_is_that_of_the_standard),
    };

    return cmocka_run_group_tests(tests, enter_folder, leave_empty_folder);
}
