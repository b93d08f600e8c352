// SPDX-License-Identifier: MIT
#include "check.h"

#include <math.h>

#include "glim/steer.h"

#define MS UINT64_C(1000000)

static const double lo[3] = {0, 0, 0};
static const double hi[3] = {3, 4, 0}; /* a diagonal of 5 */

static struct view make_view(void)
{
    struct view v = {.at = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 40};

    return v;
}

static void speed_is_a_part_of_the_scene(void **state)
{
    struct steer s;
    struct view v = make_view();

    (void)state;
    steer_init(&s, lo, hi);
    check_close(s.scene_size, 5, 1e-12);
    motion_press(&s.motion, MOTION_FORWARD, 1, 1000 * MS);
    assert_true(steer_step(&s, &v, 1000 * MS));
    check_close(v.eye[2], -5 * s.speed / 60, 1e-6);
    assert_false(steer_step(&s, &v, 1000 * MS));
    steer_init(&s, lo, lo); /* a point */
    assert_true(s.scene_size > 0);
}

static void speed_has_ends(void **state)
{
    struct steer s;
    double start;

    (void)state;
    steer_init(&s, lo, hi);
    start = s.speed;
    steer_change_speed(&s, 3);
    assert_true(s.speed > start);
    steer_change_speed(&s, -3);
    check_close(s.speed, start, 1e-12);
    for (int i = 0; i < 1000; i++)
        steer_change_speed(&s, 1);
    assert_true(isfinite(s.speed));
    for (int i = 0; i < 1000; i++)
        steer_change_speed(&s, -1);
    assert_true(s.speed > 0);
}

/* Over the whole height of the picture: by its field of view. */
static void drag_turns_by_what_is_seen(void **state)
{
    struct steer s;
    struct view v = make_view();
    struct fit fit = {0, 0, 80, 20};
    struct event e = {.kind = EVENT_MOUSE,
                      .mouse = MOUSE_DRAG,
                      .x = 10,
                      .y = 20};

    (void)state;
    steer_init(&s, lo, hi);
    assert_false(steer_mouse(&s, &v, &e, &fit, 200, 100)); /* no press yet */
    e.mouse = MOUSE_PRESS;
    assert_false(steer_mouse(&s, &v, &e, &fit, 200, 100));
    e.mouse = MOUSE_DRAG;
    e.y -= 20; /* upwards by all 20 rows */
    assert_true(steer_mouse(&s, &v, &e, &fit, 200, 100));
    check_close(v.at[1], sin(40 * 0.017453292519943295), 1e-9);
    assert_false(steer_mouse(&s, &v, &e, &fit, 200, 100)); /* stands still */
    e.x += 80; /* to the right by the whole width */
    assert_true(steer_mouse(&s, &v, &e, &fit, 200, 100));
    check_close(atan2(v.at[0], -v.at[2]), 80 * 0.017453292519943295, 1e-9);
    e.mouse = MOUSE_RELEASE;
    steer_mouse(&s, &v, &e, &fit, 200, 100);
    e.mouse = MOUSE_DRAG;
    e.x += 3;
    assert_false(steer_mouse(&s, &v, &e, &fit, 200, 100));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(speed_is_a_part_of_the_scene),
        cmocka_unit_test(speed_has_ends),
        cmocka_unit_test(drag_turns_by_what_is_seen),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
