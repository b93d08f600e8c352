// SPDX-License-Identifier: MIT
/*
 * test_clearance.c - distances around an eye against closed forms; how far keys
 * move it
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

#include "load/scene_load.h"
#include "studio/camera_input.h"
#include "studio/clearance.h"

#define ASPECT (1024.0 / 576) /* of the picture */

#define MS UINT64_C(1000000)

struct obj {
    FILE *to;
    double scale;
};

static void begin(struct obj *o, double scale)
{
    *o = (struct obj){fopen("a.obj", "w"), scale};
    assert_non_null(o->to);
}

static void corner(struct obj *o, double x, double y, double z)
{
    fprintf(o->to, "v %.17g %.17g %.17g\n", x * o->scale, y * o->scale,
            z * o->scale);
}

/* Adds a box of six faces with mixed winding. `without` is the number of an
 * omitted face, in the order of low and high x, y, z. */
static void box(struct obj *o, const double lo[3], const double hi[3],
                int without)
{
    for (int face = 0; face < 6; face++) {
        int k = face / 2, i = (k + 1) % 3, j = (k + 2) % 3;
        double p[3];

        if (face == without)
            continue;
        for (int c = 0; c < 4; c++) {
            p[k] = face % 2 ? hi[k] : lo[k];
            p[i] = c == 1 || c == 2 ? hi[i] : lo[i];
            p[j] = c >= 2 ? hi[j] : lo[j];
            corner(o, p[0], p[1], p[2]);
        }
        fprintf(o->to, "f -4 -3 -2 -1\n");
    }
}

static struct host_world host; /* of the scene that was loaded last */

static void load(struct obj *o, struct scene *scene)
{
    struct warnings report = {0};
    struct world world;
    struct error err;

    assert_int_equal(fclose(o->to), 0);
    *scene = (struct scene){0};
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

static struct pose pose_from(double x, double y, double z)
{
    struct pose v = {.up = {0, 1, 0}, .fovy_deg = 40};

    v.eye[0] = v.at[0] = x;
    v.eye[1] = v.at[1] = y;
    v.eye[2] = z;
    v.at[2] = z - fmax(1, fabs(z));
    return v;
}

/* At height h above a plane, the share of directions that meet it within r is
 * that of a spherical cap, (1 - h/r)/2. */
static void a_floor_is_as_near_as_its_height(void **state)
{
    static const double lo[3] = {-1e4, 0, -1e4}, hi[3] = {1e4, 0.001, 1e4};

    (void)state;
    for (double scale = 1e-6; scale < 1e7; scale *= 1e3) {
        struct scene scene;
        struct obj o;

        begin(&o, scale);
        box(&o, lo, hi, -1);
        load(&o, &scene);
        for (double h = 1; h < 100; h *= 3) {
            struct pose v = pose_from(0, (0.001 + h) * scale, 0);
            struct surfaces surfaces = {&scene, &host};
            struct clearance c = clearance_of(&surfaces, v.eye);

            assert_true(c.near > h * scale / (1 - 2 * 0.09));
            assert_true(c.near < h * scale / (1 - 2 * 0.12));
            check_close(c.hit_share, 0.5, 0.04);
            check_close(c.box_distance / scale, h, 1e-6 * h);
        }
        unload(&scene);
    }
}

/* Presses a key: the surroundings are measured before each step. */
static void press(struct camera_input *s, const struct scene *scene,
                  struct pose *v, uint64_t at_ns)
{
    struct surfaces surfaces = {scene, &host};
    uint64_t next;

    held_keys_press(&s->motion, HELD_KEYS_FORWARD, -1, at_ns);
    while ((next = held_keys_next_ns(&s->motion)) != UINT64_MAX) {
        struct clearance c = clearance_of(&surfaces, v->eye);

        camera_input_adapt(s, c.near, c.box_distance);
        camera_input_step(s, v, next);
    }
}

/* Returns how far this many taps, a second apart, move back from z, relative to
 * the room. */
static double distance_of_taps(double scale, const double room[2][3], double z,
                               int count)
{
    struct pose v = pose_from(0, 1.6 * scale, z * scale);
    struct scene scene;
    struct camera_input s;
    struct obj o;

    begin(&o, scale);
    box(&o, room[0], room[1], -1);
    load(&o, &scene);
    camera_input_init(&s, scene.bounds_lo, scene.bounds_hi);
    for (int i = 0; i < count; i++) {
        uint64_t at_ns = (uint64_t)(1 + i) * 1000 * MS;

        camera_input_begin(&s, at_ns);
        press(&s, &scene, &v, at_ns);
    }
    unload(&scene);
    return v.eye[2] / scale - z;
}

/* From half a step before the wall, ten taps do not reach it; in a hall of
 * length 200, twenty taps cross a tenth; and the unit of the model does not
 * matter. */
static void taps_follow_the_size_of_the_place(void **state)
{
    static const double room[2][3] = {{-2.5, 0, 0}, {2.5, 3, 6}};
    static const double hall[2][3] = {{-100, 0, -100}, {100, 50, 100}};
    double tap = distance_of_taps(1, room, 5.7, 1),
           walk = distance_of_taps(1, hall, 0, 20);

    (void)state;
    assert_true(tap > 0.03 && tap < 0.15);
    assert_true(distance_of_taps(1, room, 5.7, 10) < 0.3);
    assert_true(walk > 5 && walk < 50);
    for (double scale = 1e-6; scale < 1e7; scale *= 1e3) {
        check_close(distance_of_taps(scale, room, 5.7, 1), tap, 1e-3 * tap);
        check_close(distance_of_taps(scale, hall, 0, 20), walk, 1e-3 * walk);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_floor_is_as_near_as_its_height),
        cmocka_unit_test(taps_follow_the_size_of_the_place),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
