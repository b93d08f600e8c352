// SPDX-License-Identifier: MIT
#include "check.h"

#include <math.h>
#include <string.h>

#include "glim/camera.h"

#define RAD 0.017453292519943295

static struct view make_view(double ex, double ey, double ez, double ax,
                             double ay, double az)
{
    struct view v = {.eye = {ex, ey, ez}, .at = {ax, ay, az}, .up = {0, 1, 0}};

    return v;
}

static void check_point(const double got[3], double x, double y, double z)
{
    check_close(got[0], x, 1e-9);
    check_close(got[1], y, 1e-9);
    check_close(got[2], z, 1e-9);
}

static double distance(const struct view *v)
{
    return sqrt(pow(v->at[0] - v->eye[0], 2) + pow(v->at[1] - v->eye[1], 2) +
                pow(v->at[2] - v->eye[2], 2));
}

/* Looking along -z with y up, x is to the right. */
static void moves_along_its_axes(void **state)
{
    struct view v = make_view(1, 2, 3, 1, 2, -7);

    (void)state;
    camera_move(&v, 0.5, 0.25, 2);
    check_point(v.eye, 1.5, 2.25, 1);
    check_point(v.at, 1.5, 2.25, -9);
    assert_true(v.has_camera);
}

/* Looking down at 45 degrees, up is the camera's, not the world's. */
static void up_is_the_cameras(void **state)
{
    struct view v = make_view(0, 0, 0, 0, -1, -1);

    (void)state;
    camera_move(&v, 0, sqrt(2), 0);
    check_point(v.eye, 0, 1, -1);
}

static void turns_about_up(void **state)
{
    struct view v = make_view(0, 0, 0, 0, 0, -5);

    (void)state;
    camera_turn(&v, 90 * RAD, 0);
    check_point(v.eye, 0, 0, 0);
    check_point(v.at, 5, 0, 0);
    camera_turn(&v, -180 * RAD, 0);
    check_point(v.at, -5, 0, 0);
    camera_turn(&v, 90 * RAD, 30 * RAD);
    check_point(v.at, 0, 2.5, -5 * cos(30 * RAD));
    /* the turn to the side keeps the height, wherever it looks */
    camera_turn(&v, 77 * RAD, 0);
    check_close(v.at[1], 2.5, 1e-9);
    check_close(distance(&v), 5, 1e-9);
}

static void stops_at_the_poles(void **state)
{
    struct view v = make_view(0, 0, 0, 0, 0, -1);
    struct view w;

    (void)state;
    for (int i = 0; i < 100; i++)
        camera_turn(&v, 0, 10 * RAD);
    check_close(v.at[1], 1, 1e-3);
    assert_true(v.at[2] < 0); /* not over the top */
    camera_turn(&v, 0, -90 * RAD);
    assert_true(v.at[1] < 0.02 && v.at[2] < -0.99);
    w = v;
    for (int i = 0; i < 100; i++)
        camera_turn(&w, 3 * RAD, -10 * RAD);
    check_close(w.at[1], -1, 1e-3);
}

/* Any up vector: turning a whole round comes back, forward and back too. */
static void random_views_come_back(void **state)
{
    uint64_t seed = 4;

    (void)state;
    for (int i = 0; i < 2000; i++) {
        double p[9];
        struct view v, w;

        for (int k = 0; k < 9; k++)
            p[k] = 200 * check_random(&seed) - 100;
        v = make_view(p[0], p[1], p[2], p[3], p[4], p[5]);
        memcpy(v.up, p + 6, sizeof v.up);
        camera_turn(&v, 0.3,
                    0); /* away from the poles, where clamping begins */
        w = v;
        camera_move(&w, 3, -2, 5);
        camera_move(&w, -3, 2, -5);
        check_close(distance(&w), distance(&v), 1e-9);
        for (int k = 0; k < 36; k++)
            camera_turn(&w, 10 * RAD, 0);
        for (int k = 0; k < 3; k++) {
            check_close(w.eye[k], v.eye[k], 1e-9);
            check_close(w.at[k], v.at[k], 1e-8);
        }
    }
}

static void impossible_cameras_stay_finite(void **state)
{
    static const double ups[][3] = {
        {0, 1, 0}, {0, 0, 0}, {0, -1, 0}, {1e-300, 0, 0}, {0, 1e300, 0}};
    static const double ats[][3] = {{0, 0, 0},
                                    {0, 5, 0},
                                    {0, -5, 0},
                                    {1, 0, 0}};

    (void)state;
    for (int u = 0; u < 5; u++) {
        for (int a = 0; a < 4; a++) {
            struct view v = make_view(0, 0, 0, ats[a][0], ats[a][1], ats[a][2]);

            memcpy(v.up, ups[u], sizeof v.up);
            for (int i = 0; i < 5; i++) {
                camera_move(&v, 0.1, 0.2, 0.3);
                camera_turn(&v, 0.1, 0.2);
                for (int k = 0; k < 3; k++)
                    assert_true(isfinite(v.eye[k]) && isfinite(v.at[k]));
                assert_true(distance(&v) > 0.9);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moves_along_its_axes),
        cmocka_unit_test(up_is_the_cameras),
        cmocka_unit_test(turns_about_up),
        cmocka_unit_test(stops_at_the_poles),
        cmocka_unit_test(random_views_come_back),
        cmocka_unit_test(impossible_cameras_stay_finite),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
