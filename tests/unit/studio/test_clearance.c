// SPDX-License-Identifier: MIT
/*
 * test_clearance.c - distances around an eye against closed forms; how far keys
 * move it
 */
#include <math.h>

#include "studio/camera/camera_input.h"
#include "tests/unit/folder.h"
#include "tests/unit/room.h"

#define MS UINT64_C(1000000)

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
        struct room r;

        room_open_box(&r, lo, hi, scale);
        for (double h = 1; h < 100; h *= 3) {
            struct pose v = pose_from(0, (0.001 + h) * scale, 0);
            struct clearance c = surfaces_clearance(&r.surfaces, v.eye);

            assert_true(c.near > h * scale / (1 - 2 * 0.09));
            assert_true(c.near < h * scale / (1 - 2 * 0.12));
            check_close(c.hit_share, 0.5, 0.04);
            check_close(c.box_distance / scale, h, 1e-6 * h);
        }
        room_close(&r);
    }
}

/* Presses a key: the surroundings are measured before each step. */
static void press(struct camera_input *s, const struct room *r, struct pose *v,
                  uint64_t at_ns)
{
    uint64_t next;

    held_keys_press(&s->motion, HELD_KEYS_FORWARD, -1, at_ns);
    while ((next = held_keys_next_ns(&s->motion)) != UINT64_MAX) {
        struct clearance c = surfaces_clearance(&r->surfaces, v->eye);

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
    struct camera_input s;
    struct room r;

    room_open_box(&r, room[0], room[1], scale);
    camera_input_init(&s, r.scene.bounds_lo, r.scene.bounds_hi);
    for (int i = 0; i < count; i++) {
        uint64_t at_ns = (uint64_t)(1 + i) * 1000 * MS;

        camera_input_begin(&s, at_ns);
        press(&s, &r, &v, at_ns);
    }
    room_close(&r);
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
