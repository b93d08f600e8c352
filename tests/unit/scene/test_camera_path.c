// SPDX-License-Identifier: MIT
/* Turns and paths of the camera against closed forms. */
#include "tests/unit/check.h"

#include <math.h>

#include "base/geometry.h"
#include "scene/camera_path.h"

static struct pose pose_of(double x, double y, double z, double azimuth_deg)
{
    double a = angle_rad(azimuth_deg);

    return (struct pose){.eye = {x, y, z},
                         .at = {x + sin(a), y, z - cos(a)},
                         .up = {0, 1, 0},
                         .fovy_deg = 40};
}

/* Returns the azimuth of the view, clockwise from -z, as pose_of() takes it. */
static double azimuth_of(const struct pose *p)
{
    return angle_deg(atan2(p->at[0] - p->eye[0], p->eye[2] - p->at[2]));
}

static void quarters_of_a_turn_are_exact(void **state)
{
    const double want[4][2] = {{0, 3}, {3, 0}, {0, -3}, {-3, 0}};

    (void)state;
    for (int i = -8; i <= 8; i++) {
        struct pose p = {.eye = {1, 3, 5},
                         .at = {1, 1, 2},
                         .up = {0, 2, 0},
                         .fovy_deg = 40};
        int k = ((i % 4) + 4) % 4;

        pose_turn(&p, 90 * i);
        /* the eye is 3 units from the axis x = 1, z = 2 */
        assert_true(p.eye[0] == 1 + want[k][0]);
        assert_true(p.eye[2] == 2 + want[k][1]);
        assert_true(p.eye[1] == 3 && p.at[0] == 1 && p.up[1] == 2);
    }
}

/* A turn is a rotation: distances stay, and so does the height along up. */
static void turns_keep_distance_and_height(void **state)
{
    uint64_t seed = 7;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct pose p = {.fovy_deg = 40}, before;
        double angle = 720 * check_random(&seed) - 360, a[3], b[3];

        for (int k = 0; k < 3; k++) {
            p.eye[k] = 20 * check_random(&seed) - 10;
            p.at[k] = 20 * check_random(&seed) - 10;
            p.up[k] = 2 * check_random(&seed) - 1;
        }
        before = p;
        pose_turn(&p, angle);
        vec3d_sub(before.eye, p.at, a);
        vec3d_sub(p.eye, p.at, b);
        check_close(vec3d_length(b), vec3d_length(a), 1e-12);
        check_close(vec3d_dot(b, p.up), vec3d_dot(a, p.up), 1e-12);
        pose_turn(&p, -angle);
        for (int k = 0; k < 3; k++)
            check_close(p.eye[k], before.eye[k], 1e-12);
    }
}

static void a_path_goes_through_its_keys(void **state)
{
    struct pose keys[5];
    uint64_t seed = 5;

    (void)state;
    for (int i = 0; i < 5; i++) {
        keys[i] = pose_of(9 * check_random(&seed), 9 * check_random(&seed),
                          9 * check_random(&seed), 360 * check_random(&seed));
        keys[i].fovy_deg = 10 + 150 * check_random(&seed);
        keys[i].aperture = check_random(&seed);
    }
    keys[2].focus = 3;
    for (int i = 0; i < 5; i++) {
        struct pose at = camera_path_at(keys, 5, i);

        assert_memory_equal(&at, &keys[i], sizeof at);
    }
    /* place and speed are continuous at the inner keys */
    for (int i = 1; i < 4; i++) {
        struct pose a = camera_path_at(keys, 5, i - 1e-4);
        struct pose b = camera_path_at(keys, 5, i + 1e-4);

        for (int k = 0; k < 3; k++) {
            check_close(a.eye[k], keys[i].eye[k], 1e-2);
            check_close(a.at[k], keys[i].at[k], 1e-2);
            check_close(keys[i].eye[k] - a.eye[k], b.eye[k] - keys[i].eye[k],
                        1e-6);
            check_close(keys[i].at[k] - a.at[k], b.at[k] - keys[i].at[k], 1e-6);
        }
        check_close(keys[i].fovy_deg - a.fovy_deg,
                    b.fovy_deg - keys[i].fovy_deg, 1e-4);
    }
}

/* Two keys give a straight line and an even turn, in degrees by the short
 * way. */
static void two_keys_give_even_motion(void **state)
{
    const struct pose keys[2] = {pose_of(0, 0, 0, 170), pose_of(2, 4, 6, 230)};

    (void)state;
    for (int i = 0; i <= 16; i++) {
        double t = i / 16.0;
        struct pose p = camera_path_at(keys, 2, t);

        check_close(p.eye[0], 2 * t, 1e-12);
        check_close(p.eye[1], 4 * t, 1e-12);
        check_close(p.eye[2], 6 * t, 1e-12);
        check_close(remainder(azimuth_of(&p) - (170 + 60 * t), 360), 0, 1e-9);
        check_close(p.up[1], 1, 1e-12);
        check_close(p.fovy_deg, 40, 1e-9);
    }
}

/* Keys with even steps give even motion, also of the direction, beyond a whole
 * turn. */
static void even_keys_give_even_motion(void **state)
{
    struct pose keys[9];

    (void)state;
    for (int i = 0; i < 9; i++)
        keys[i] = pose_of(i, 0, -2.0 * i, 80.0 * i);
    for (int i = 0; i <= 80; i++) {
        double u = i / 10.0;
        struct pose p = camera_path_at(keys, 9, u);

        check_close(p.eye[0], u, 1e-12);
        check_close(p.eye[2], -2 * u, 1e-12);
        check_close(remainder(azimuth_of(&p) - 80 * u, 360), 0, 1e-9);
    }
}

/* A level camera that looks up and aside does not roll between its keys. */
static void the_horizon_stays_level(void **state)
{
    struct pose keys[3] = {pose_of(0, 0, 0, 0), pose_of(0, 0, 1, 80),
                           pose_of(0, 0, 2, 200)};

    (void)state;
    keys[1].at[1] = 1.5;
    keys[2].at[1] = -0.7;
    for (int i = 0; i <= 40; i++) {
        struct pose p = camera_path_at(keys, 3, i / 20.0);
        struct axes axes;

        pose_axes(&p, &axes);
        check_close(axes.right[1], 0, 1e-12);
        check_close(axes.pole[1], 1, 1e-12);
    }
}

/* Between opposite ups there is none, so that of a key stays. */
static void opposite_ups_leave_a_direction(void **state)
{
    struct pose keys[2] = {pose_of(0, 0, 0, 0), pose_of(1, 0, 0, 0)};
    struct error err;
    struct pose p;

    (void)state;
    keys[1].up[1] = -1;
    p = camera_path_at(keys, 2, 0.5);
    assert_true(pose_check(&p, "half way", &err));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quarters_of_a_turn_are_exact),
        cmocka_unit_test(turns_keep_distance_and_height),
        cmocka_unit_test(a_path_goes_through_its_keys),
        cmocka_unit_test(two_keys_give_even_motion),
        cmocka_unit_test(even_keys_give_even_motion),
        cmocka_unit_test(the_horizon_stays_level),
        cmocka_unit_test(opposite_ups_leave_a_direction),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
