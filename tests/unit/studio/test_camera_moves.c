// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>
#include <string.h>

#include "studio/camera/camera_input.h"

#define ASPECT 1.25 /* of the picture */

#define RAD 0.017453292519943295

static struct pose make_pose(double ex, double ey, double ez, double ax,
                             double ay, double az)
{
    struct pose v = {.eye = {ex, ey, ez}, .at = {ax, ay, az}, .up = {0, 1, 0}};

    return v;
}

static void check_point(const double got[3], double x, double y, double z)
{
    check_close(got[0], x, 1e-9);
    check_close(got[1], y, 1e-9);
    check_close(got[2], z, 1e-9);
}

static double distance(const struct pose *v)
{
    return sqrt(pow(v->at[0] - v->eye[0], 2) + pow(v->at[1] - v->eye[1], 2) +
                pow(v->at[2] - v->eye[2], 2));
}

/* Looking along -z with y up, x is to the right. */
static void camera_moves_along_its_axes(void **state)
{
    struct pose v = make_pose(1, 2, 3, 1, 2, -7);

    (void)state;
    camera_move(&v, 0.5, 0.25, 2);
    check_point(v.eye, 1.5, 2.25, 1);
    check_point(v.at, 1.5, 2.25, -9);
}

/* For a view down at 45 degrees, up is the camera's axis, not the world's. */
static void up_is_the_camera_s_axis(void **state)
{
    struct pose v = make_pose(0, 0, 0, 0, -1, -1);

    (void)state;
    camera_move(&v, 0, sqrt(2), 0);
    check_point(v.eye, 0, 1, -1);
}

static void camera_turns_about_up(void **state)
{
    struct pose v = make_pose(0, 0, 0, 0, 0, -5);

    (void)state;
    camera_turn(&v, 90 * RAD, 0);
    check_point(v.eye, 0, 0, 0);
    check_point(v.at, 5, 0, 0);
    camera_turn(&v, -180 * RAD, 0);
    check_point(v.at, -5, 0, 0);
    camera_turn(&v, 90 * RAD, 30 * RAD);
    check_point(v.at, 0, 2.5, -5 * cos(30 * RAD));
    /* Turning to the side keeps the height of the view. */
    camera_turn(&v, 77 * RAD, 0);
    check_close(v.at[1], 2.5, 1e-9);
    check_close(distance(&v), 5, 1e-9);
}

static void camera_stops_at_the_poles(void **state)
{
    struct pose v = make_pose(0, 0, 0, 0, 0, -1);
    struct pose w;

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

/* For any up vector a full turn restores the pose, as does a move forward and
 * back. */
static void full_turns_restore_the_pose(void **state)
{
    uint64_t seed = 4;

    (void)state;
    for (int i = 0; i < 2000; i++) {
        double p[9];
        struct pose v, w;

        for (int k = 0; k < 9; k++)
            p[k] = 200 * check_random(&seed) - 100;
        v = make_pose(p[0], p[1], p[2], p[3], p[4], p[5]);
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

/* Projects a point to [-1, 1] in the picture, by rows of a new matrix. Returns
 * its depth. */
static double project(const struct pose *v, const double p[3], double *x,
                      double *y)
{
    double f[3], r[3], u[3], d[3], tangent = tan(v->fovy_deg / 2 * RAD);
    double length = distance(v), depth, across;

    for (int k = 0; k < 3; k++) {
        f[k] = (v->at[k] - v->eye[k]) / length;
        d[k] = p[k] - v->eye[k];
    }
    for (int k = 0; k < 3; k++)
        r[k] = f[(k + 1) % 3] * v->up[(k + 2) % 3] -
               f[(k + 2) % 3] * v->up[(k + 1) % 3];
    across = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int k = 0; k < 3; k++)
        r[k] /= across;
    for (int k = 0; k < 3; k++)
        u[k] =
            r[(k + 1) % 3] * f[(k + 2) % 3] - r[(k + 2) % 3] * f[(k + 1) % 3];
    depth = d[0] * f[0] + d[1] * f[1] + d[2] * f[2];
    *x = (d[0] * r[0] + d[1] * r[1] + d[2] * r[2]) / (depth * tangent * ASPECT);
    *y = (d[0] * u[0] + d[1] * u[1] + d[2] * u[2]) / (depth * tangent);
    return depth;
}

static struct pose random_pose(uint64_t *seed)
{
    double p[6];
    struct pose v;

    for (int k = 0; k < 6; k++)
        p[k] = 20 * check_random(seed) - 10;
    v = make_pose(p[0], p[1], p[2], p[3], p[4], p[5]);
    v.fovy_deg = 5 + 120 * check_random(seed);
    return v;
}

static void orbits_keep_the_distance(void **state)
{
    static const double origin[3] = {0, 0, 0};
    struct pose v = make_pose(0, 0, 5, 0, 0, 0);

    (void)state;
    camera_orbit(&v, origin, 90 * RAD, 0);
    check_point(v.eye, 5, 0, 0);
    check_point(v.at, 0, 0, 0);
    camera_orbit(&v, origin, -90 * RAD, 30 * RAD);
    check_point(v.eye, 0, 2.5, 5 * cos(30 * RAD));
    check_point(v.at, 0, 0, 0);
    for (int i = 0; i < 100; i++)
        camera_orbit(&v, origin, 0, 10 * RAD);
    check_close(v.eye[1], 5, 1e-3);
    assert_true(v.eye[2] > 0); /* not over the top */
}

/* The picked point keeps its place in the picture and its distance. */
static void orbits_keep_the_point_in_its_place(void **state)
{
    uint64_t seed = 11;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct pose v = random_pose(&seed);
        double p[3], x, y, depth, after_x, after_y;

        for (int k = 0; k < 3; k++)
            p[k] = v.at[k] + check_random(&seed);
        depth = project(&v, p, &x, &y);
        check_close(camera_depth(&v, p), depth, 1e-9);
        camera_orbit(&v, p, 6 * check_random(&seed) - 3,
                     2 * check_random(&seed) - 1);
        check_close(project(&v, p, &after_x, &after_y), depth, 1e-9);
        check_close(after_x, x, 1e-7);
        check_close(after_y, y, 1e-7);
    }
}

/* All corners are within the margin, and the camera is as near as possible: the
 * box touches two opposite sides, unless it is close enough. */
static void framing_is_as_near_as_possible(void **state)
{
    uint64_t seed = 12;
    uint32_t tight_count = 0;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct pose v = random_pose(&seed);
        struct pose before = v;
        double lo[3], hi[3], radius, most[4] = {-9, -9, -9, -9};

        for (int k = 0; k < 3; k++) {
            lo[k] = 20 * check_random(&seed) - 10;
            hi[k] = lo[k] + 5 * check_random(&seed);
        }
        camera_frame(&v, ASPECT, lo, hi);
        for (int corner = 0; corner < 8; corner++) {
            double p[3], x, y;

            for (int k = 0; k < 3; k++)
                p[k] = corner >> k & 1 ? hi[k] : lo[k];
            assert_true(project(&v, p, &x, &y) > 0);
            most[0] = fmax(most[0], x);
            most[1] = fmax(most[1], -x);
            most[2] = fmax(most[2], y);
            most[3] = fmax(most[3], -y);
        }
        for (int k = 0; k < 4; k++)
            check_at_most(most[k], CAMERA_FILL + 1e-9);
        radius = sqrt(pow(hi[0] - lo[0], 2) + pow(hi[1] - lo[1], 2) +
                      pow(hi[2] - lo[2], 2)) /
                 2;
        check_at_most(radius, distance(&v) + 1e-9);
        if (distance(&v) > radius + 1e-9) {
            check_close(fmax(fmin(most[0], most[1]), fmin(most[2], most[3])),
                        CAMERA_FILL, 1e-9);
            tight_count++;
        }
        for (int k = 0; k < 3; k++)
            check_close((v.at[k] - v.eye[k]) / distance(&v),
                        (before.at[k] - before.eye[k]) / distance(&before),
                        1e-9);
    }
    assert_in_range(tight_count, 500, 1000);
}

/* A point has no extent that could fill the picture, so the distance stays. */
static void framing_a_point_keeps_the_distance(void **state)
{
    static const double point[3] = {1, 2, 3};
    struct pose v = make_pose(0, 0, 5, 0, 0, 1);

    (void)state;
    v.fovy_deg = 40;
    camera_frame(&v, 1, point, point);
    check_point(v.at, 1, 2, 3);
    check_point(v.eye, 1, 2, 7);
}

static void zoom_changes_the_field_of_view(void **state)
{
    struct pose v = make_pose(0, 0, 5, 0, 0, 0);

    (void)state;
    v.fovy_deg = 90;
    camera_widen(&v, 0.5);
    check_close(v.fovy_deg, 2 * atan(0.5) / RAD, 1e-9);
    camera_widen(&v, 2);
    check_close(v.fovy_deg, 90, 1e-9);
    camera_widen(&v, 1e9);
    check_close(v.fovy_deg, FOVY_MAX_DEG, 1e-9);
    camera_widen(&v, 1e-9);
    check_close(v.fovy_deg, FOVY_MIN_DEG, 1e-9);
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
            struct pose v = make_pose(0, 0, 0, ats[a][0], ats[a][1], ats[a][2]);

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

/* The edge of a picture of 1024 x 576 is 32 degrees from its middle. */
static void boxes_out_of_the_picture_are_noticed(void **state)
{
    static const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};
    const double aspect = 1024.0 / 576;
    struct pose v = make_pose(0, 1, 9, 0, 1, 0);

    (void)state;
    v.fovy_deg = 40;
    assert_true(camera_sees_box(&v, aspect, lo, hi));
    v.at[2] = 10; /* turned around */
    assert_false(camera_sees_box(&v, aspect, lo, hi));
    v.at[0] = 9;
    v.at[2] = 9 - 9 / tan((31 + 5) * RAD);
    assert_true(camera_sees_box(&v, aspect, lo, hi)); /* it is 7 wide there */
    v.at[2] = 9 - 9 / tan((33 + 9) * RAD);
    assert_false(camera_sees_box(&v, aspect, lo, hi));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_moves_along_its_axes),
        cmocka_unit_test(up_is_the_camera_s_axis),
        cmocka_unit_test(camera_turns_about_up),
        cmocka_unit_test(camera_stops_at_the_poles),
        cmocka_unit_test(full_turns_restore_the_pose),
        cmocka_unit_test(orbits_keep_the_distance),
        cmocka_unit_test(orbits_keep_the_point_in_its_place),
        cmocka_unit_test(framing_is_as_near_as_possible),
        cmocka_unit_test(framing_a_point_keeps_the_distance),
        cmocka_unit_test(boxes_out_of_the_picture_are_noticed),
        cmocka_unit_test(zoom_changes_the_field_of_view),
        cmocka_unit_test(impossible_cameras_stay_finite),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
