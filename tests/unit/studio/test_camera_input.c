// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>

#include "studio/camera/camera_input.h"

#define MS UINT64_C(1000000)

static const double lo[3] = {0, 0, 0};
static const double hi[3] = {3, 4, 0}; /* a diagonal of 5 */

static struct pose make_pose(void)
{
    struct pose v = {.at = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 40};

    return v;
}

/* The speed is this distance per second, for the first step of a key. */
static void speed_follows_the_distance(void **state)
{
    struct camera_input s;

    (void)state;
    for (double near = 0.1; near < 1; near *= 2) {
        struct pose v = make_pose();

        camera_input_init(&s, lo, hi);
        check_close(s.scene_size, 5, 1e-12);
        camera_input_adapt(&s, near, 0);
        check_close(camera_input_speed(&s), near, 1e-12);
        camera_input_begin(&s, 1000 * MS);
        held_keys_press(&s.motion, HELD_KEYS_FORWARD, 1, 1000 * MS);
        assert_true(camera_input_step(&s, &v, 1000 * MS));
        check_close(v.eye[2], -near / 60, 1e-6);
        assert_false(camera_input_step(&s, &v, 1000 * MS));
    }
    camera_input_init(&s, lo, lo); /* a point */
    assert_true(s.scene_size > 0 && camera_input_speed(&s) > 0);
}

/* At a wall and in empty space the eye still moves. From far away it returns
 * within seconds, and it never moves away faster than a number can hold. */
static void speed_is_never_zero(void **state)
{
    struct camera_input s;
    double open, far;

    (void)state;
    camera_input_init(&s, lo, hi);
    camera_input_adapt(&s, 0, 0);
    assert_true(camera_input_speed(&s) > 1e-3 * 5 &&
                camera_input_speed(&s) < 1e-2 * 5);
    camera_input_adapt(&s, INFINITY, 0);
    open = camera_input_speed(&s);
    assert_true(open > 0.1 * 5 && open < 5);
    camera_input_adapt(&s, INFINITY, 5);
    check_close(camera_input_speed(&s), open, 1e-12);
    camera_input_adapt(&s, INFINITY, 20);
    far = camera_input_speed(&s);
    assert_true(far > open);
    camera_input_adapt(&s, INFINITY, 40);
    check_close(camera_input_speed(&s), 2 * far, 1e-12);
    camera_input_adapt(&s, INFINITY, 1e17);
    far = camera_input_speed(&s);
    camera_input_adapt(&s, INFINITY, INFINITY);
    assert_true(isfinite(camera_input_speed(&s)));
    check_close(camera_input_speed(&s), far, 1e-12);
}

static double held(double seconds)
{
    struct camera_input s;
    struct pose v = make_pose();
    uint64_t end = 1000 * MS + (uint64_t)(1e9 * seconds);

    camera_input_init(&s, lo, hi);
    camera_input_adapt(&s, 0.5, 0);
    camera_input_begin(&s, 1000 * MS);
    for (uint64_t t = 1000 * MS; t < end; t += 30 * MS) {
        held_keys_press(&s.motion, HELD_KEYS_FORWARD, 1, t);
        camera_input_step(&s, &v, t);
    }
    return -v.eye[2];
}

/* The second second moves further than the first, up to a limit, with the
 * person's factor too. */
static void held_keys_get_faster(void **state)
{
    double one = held(1), two = held(2), ten = held(10), eleven = held(11);

    (void)state;
    assert_true(two - one > 1.5 * one);
    assert_true(eleven - ten > two - one);
    check_close(held(21) - held(20), eleven - ten, 0.1 * (eleven - ten));
}

static void speed_has_ends(void **state)
{
    struct camera_input s;
    double start;

    (void)state;
    camera_input_init(&s, lo, hi);
    start = s.speed;
    camera_input_change_speed(&s, 3);
    assert_true(s.speed > start);
    camera_input_change_speed(&s, -3);
    check_close(s.speed, start, 1e-12);
    for (int i = 0; i < 1000; i++)
        camera_input_change_speed(&s, 1);
    assert_true(isfinite(s.speed));
    for (int i = 0; i < 1000; i++)
        camera_input_change_speed(&s, -1);
    assert_true(s.speed > 0);
}

/* A drag over the height of the picture turns by the field of view. */
static void drags_turn_by_the_field_of_view(void **state)
{
    struct camera_input s;
    struct pose v = make_pose();
    struct cells_rect fit = {0, 0, 80, 20};
    struct event e = {.kind = EVENT_MOUSE,
                      .mouse = MOUSE_DRAG,
                      .x = 10,
                      .y = 20};

    (void)state;
    camera_input_init(&s, lo, hi);
    assert_false(
        camera_input_mouse(&s, &v, &e, &fit, 200, 100)); /* no press yet */
    e.mouse = MOUSE_PRESS;
    assert_false(camera_input_mouse(&s, &v, &e, &fit, 200, 100));
    e.mouse = MOUSE_DRAG;
    e.y -= 20; /* upwards by all 20 rows */
    assert_true(camera_input_mouse(&s, &v, &e, &fit, 200, 100));
    check_close(v.at[1], sin(40 * 0.017453292519943295), 1e-9);
    assert_false(
        camera_input_mouse(&s, &v, &e, &fit, 200, 100)); /* no motion */
    e.x += 80; /* right by the whole width */
    assert_true(camera_input_mouse(&s, &v, &e, &fit, 200, 100));
    check_close(atan2(v.at[0], -v.at[2]), 80 * 0.017453292519943295, 1e-9);
    e.mouse = MOUSE_RELEASE;
    camera_input_mouse(&s, &v, &e, &fit, 200, 100);
    e.mouse = MOUSE_DRAG;
    e.x += 3;
    assert_false(camera_input_mouse(&s, &v, &e, &fit, 200, 100));
}

/* A held key turns by this angle per second, at a constant distance from the
 * pivot. */
static void held_keys_orbit(void **state)
{
    struct camera_input s;
    struct pose v = make_pose();
    double begin, angle;

    (void)state;
    camera_input_init(&s, lo, hi);
    v.at[2] = -4;
    s.pivot[2] = -4;
    s.is_orbiting = true;
    held_keys_press(&s.motion, HELD_KEYS_LOOK_RIGHT, 1, 1000 * MS);
    assert_true(camera_input_step(&s, &v, 1000 * MS));
    begin = atan2(v.eye[0], v.eye[2] + 4);
    assert_true(begin > 0); /* to the right of its start */
    for (uint64_t t = 1010; t <= 1100; t += 10)
        camera_input_step(&s, &v, t * MS);
    angle = atan2(v.eye[0], v.eye[2] + 4);
    check_close(angle / begin, (100 + 1000. / 60) / (1000. / 60), 1e-5);
    check_close(hypot(v.eye[0], v.eye[2] + 4), 4, 1e-12);
    check_close(v.at[2], -4, 1e-12);
    check_close(v.eye[1], 0, 1e-12);
}

/* A scene that is loaded again at twice its size is crossed in the same time,
 * at the chosen speed. */
static void speeds_follow_the_scene(void **state)
{
    const double far[3] = {2 * hi[0] - lo[0], 2 * hi[1] - lo[1],
                           2 * hi[2] - lo[2]};
    double moved[2];

    (void)state;
    for (int i = 0; i < 2; i++) {
        struct camera_input s;
        struct pose v = make_pose();

        camera_input_init(&s, lo, hi);
        camera_input_change_speed(&s, 3);
        if (i == 1)
            camera_input_resize(&s, lo, far);
        held_keys_press(&s.motion, HELD_KEYS_FORWARD, 1, 1000 * MS);
        camera_input_step(&s, &v, 1000 * MS);
        moved[i] = -v.eye[2];
    }
    assert_true(moved[0] > 0);
    check_close(moved[1] / moved[0], 2, 1e-12);
}

static void hold(struct camera_input *s, struct pose *v,
                 enum held_keys_axis axis, int sign, int taps)
{
    for (uint64_t t = 1000; taps > 0; t += 1000, taps--) {
        held_keys_press(&s->motion, axis, sign, t * MS);
        camera_input_step(s, v, t * MS);
        camera_input_step(s, v, (t + 100) * MS);
        camera_input_step(s, v, (t + 200) * MS);
    }
}

/* As many taps back restore the field of view. */
static void zoom_is_symmetric(void **state)
{
    struct camera_input s;
    struct pose v = make_pose();

    (void)state;
    camera_input_init(&s, lo, hi);
    hold(&s, &v, HELD_KEYS_WIDEN, 1, 3);
    assert_true(v.fovy_deg > 45 && v.fovy_deg < 70);
    hold(&s, &v, HELD_KEYS_WIDEN, -1, 3);
    check_close(v.fovy_deg, 40, 1e-9);
    assert_true(v.aperture == 0);
}

static void aperture_opens_from_a_pinhole_and_closes(void **state)
{
    struct camera_input s;
    struct pose v = make_pose();
    double once;

    (void)state;
    camera_input_init(&s, lo, hi);
    hold(&s, &v, HELD_KEYS_OPEN, -1, 1);
    assert_true(v.aperture == 0);
    hold(&s, &v, HELD_KEYS_OPEN, 1, 1);
    once = v.aperture;
    assert_true(once > 0 && once < 0.01);
    hold(&s, &v, HELD_KEYS_OPEN, 1, 1);
    check_close(v.aperture, once * sqrt(2), 1e-4 * once); /* one stop */
    hold(&s, &v, HELD_KEYS_OPEN, -1, 1);
    check_close(v.aperture, once, 1e-12);
    hold(&s, &v, HELD_KEYS_OPEN, -1, 1);
    assert_true(v.aperture == 0);
    hold(&s, &v, HELD_KEYS_OPEN, 1, 200);
    check_close(v.aperture, 1, 1e-12); /* the limit is the focus distance */
    v.focus = 3;
    hold(&s, &v, HELD_KEYS_OPEN, 1, 200);
    check_close(v.aperture, 3, 1e-12);
}

/* A drag over the height turns half around; a point in the middle follows the
 * pointer. */
static void modified_drags_orbit(void **state)
{
    struct camera_input s;
    struct pose v = make_pose();
    struct cells_rect fit = {0, 0, 80, 20};
    struct event e = {.kind = EVENT_MOUSE,
                      .mouse = MOUSE_PRESS,
                      .button = 2,
                      .x = 30,
                      .y = 10};

    (void)state;
    camera_input_init(&s, lo, hi);
    v.at[2] = -4;
    s.pivot[2] = -4;
    assert_true(camera_input_orbits(&s, &e));
    camera_input_mouse(&s, &v, &e, &fit, 200, 100);
    assert_false(s.has_dragged);
    e.mouse = MOUSE_DRAG;
    e.x -= 20; /* a quarter of the width is half the height */
    assert_true(camera_input_mouse(&s, &v, &e, &fit, 200, 100));
    assert_true(s.has_dragged);
    check_close(v.eye[0], 4, 1e-9);
    check_close(v.eye[2], -4, 1e-9);
    e.y += 5; /* downwards: the view is from above */
    assert_true(camera_input_mouse(&s, &v, &e, &fit, 200, 100));
    check_close(v.eye[1], 4 * sin(0.25 * 3.141592653589793), 1e-9);
    e = (struct event){.kind = EVENT_MOUSE, .is_modified = true};
    assert_true(camera_input_orbits(&s, &e));
    e.is_modified = false;
    assert_false(camera_input_orbits(&s, &e));
    s.is_orbiting = true;
    assert_true(camera_input_orbits(&s, &e));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(speed_follows_the_distance),
        cmocka_unit_test(speed_is_never_zero),
        cmocka_unit_test(held_keys_get_faster),
        cmocka_unit_test(speed_has_ends),
        cmocka_unit_test(speeds_follow_the_scene),
        cmocka_unit_test(drags_turn_by_the_field_of_view),
        cmocka_unit_test(held_keys_orbit),
        cmocka_unit_test(zoom_is_symmetric),
        cmocka_unit_test(aperture_opens_from_a_pinhole_and_closes),
        cmocka_unit_test(modified_drags_orbit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
