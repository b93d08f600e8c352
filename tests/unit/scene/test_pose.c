// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>

#include "base/geometry.h"
#include "scene/pose.h"

static void impossible_cameras_are_refused(void **state)
{
    struct pose pose = {.at = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 40};
    struct error err;

    (void)state;
    assert_true(pose_check(&pose, "here", &err));
    pose.fovy_deg = NAN;
    assert_false(pose_check(&pose, "here", &err));
    pose.fovy_deg = 180;
    assert_false(pose_check(&pose, "here", &err));
    assert_string_equal(err.text, "here: found a fovy of 180 degrees, "
                                  "expected one above 0 and below 180");
    pose.fovy_deg = 40;
    pose.eye[0] = INFINITY;
    assert_false(pose_check(&pose, "here", &err));
    pose.eye[0] = 0;
    pose.eye[2] = -1;
    assert_false(pose_check(&pose, "here", &err));
    assert_string_equal(err.text,
                        "here: found eye and at in one point, expected two");
    pose.eye[2] = 0;
    pose.up[1] = 0;
    assert_false(pose_check(&pose, "here", &err));
    assert_string_equal(err.text,
                        "here: found 0 0 0, expected a direction for up");
}

static void check_orthonormal(const struct axes *axes)
{
    double across[3];

    check_close(vec3d_length(axes->right), 1, 1e-12);
    check_close(vec3d_length(axes->up), 1, 1e-12);
    check_close(vec3d_length(axes->forward), 1, 1e-12);
    check_close(vec3d_length(axes->pole), 1, 1e-12);
    vec3d_cross(axes->right, axes->up, across);
    /* The axis points backwards: a right-handed system. */
    for (int k = 0; k < 3; k++)
        check_close(across[k], -axes->forward[k], 1e-12);
}

/* Tests cameras of all sizes, from the largest numbers to the smallest. */
static void axes_are_orthonormal(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        double scale = pow(10, 600 * check_random(&seed) - 300);
        struct pose pose = {.fovy_deg = 40};
        struct axes axes;

        for (int k = 0; k < 3; k++) {
            pose.eye[k] = scale * (check_random(&seed) - 0.5);
            pose.at[k] = scale * (check_random(&seed) - 0.5);
            pose.up[k] = (check_random(&seed) - 0.5) / scale;
        }
        pose_axes(&pose, &axes);
        check_orthonormal(&axes);
        check_close(vec3d_dot(axes.right, axes.pole), 0, 1e-9);
        assert_true(vec3d_dot(axes.up, axes.pole) > 0);
        assert_false(pose_up_is_parallel(&pose));
    }
}

/* The threshold is a sine of 1e-6, for any length of up. */
static void up_along_the_view_is_replaced(void **state)
{
    static const double sines[] = {0, 1e-9, 0.9e-6, 1.1e-6, 1e-3};

    (void)state;
    for (size_t i = 0; i < sizeof sines / sizeof sines[0]; i++) {
        struct pose pose = {.at = {0, -5, 0}, .up = {1e9 * sines[i], 1e9, 0}};
        struct axes axes;

        pose_axes(&pose, &axes);
        check_orthonormal(&axes);
        assert_int_equal(pose_up_is_parallel(&pose), sines[i] < 1e-6);
    }
}

static void zero_vectors_give_axes(void **state)
{
    struct pose pose = {.fovy_deg = 40};
    struct axes axes;

    (void)state;
    pose_axes(&pose, &axes);
    check_orthonormal(&axes);
    check_close(axes.forward[2], -1, 0);
    check_close(axes.pole[1], 1, 0);
    check_close(pose_reach(&pose), 1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impossible_cameras_are_refused),
        cmocka_unit_test(axes_are_orthonormal),
        cmocka_unit_test(up_along_the_view_is_replaced),
        cmocka_unit_test(zero_vectors_give_axes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
