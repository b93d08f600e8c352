// SPDX-License-Identifier: MIT
/*
 * test_edit.c - changes of camera, materials, objects and light are undone and
 * redone in one order, and counted if they need a new render
 */
#include "tests/unit/edits.h"

#define MS UINT64_C(1000000)

/* ---- undo and redo ---- */

static void steps_have_names_in_order_of_time(void **state)
{
    static const char *const names[] = {
        "camera", "material wall", "camera", "material of an object",
        "light",  "copy wall.2",   "view 3", "camera",
    };
    const int count = sizeof names / sizeof names[0];
    struct edit e;

    (void)state;
    open_edit(&e);
    assert_null(edit_undo(&e));
    assert_null(edit_redo(&e));
    for (int i = 0; i < count; i++) {
        edit_end_step(&e);
        switch (i) {
        case 1: put_kd(&e, WALL, .25); break;
        case 3: edit_assign(&e, BALL_OBJECT, LAMP); break;
        case 4: put_background(&e, .25); break;
        case 5: assert_int_equal(edit_duplicate(&e, WALL), 3); break;
        case 6: edit_shot(&e, 2); break;
        default: put_eye(&e, i + 1); break;
        }
    }
    for (int round = 0; round < 2; round++) {
        for (int i = count - 1; i >= 0; i--)
            assert_string_equal(edit_undo(&e), names[i]);
        assert_null(edit_undo(&e));
        assert_false(edit_has_unsaved_materials(&e));
        assert_false(edit_has_unsaved_view(&e));
        assert_true(e.now.view.pose.eye[0] == e.saved.view.pose.eye[0]);
        assert_false(e.now.view.has_shot[2]);
        for (int i = 0; i < count; i++)
            assert_string_equal(edit_redo(&e), names[i]);
        assert_null(edit_redo(&e));
        assert_true(e.now.view.pose.eye[0] == count);
        assert_true(e.now.view.shots[2].eye[0] == 3);
        assert_true(e.now.sources[WALL].base_color.rgb[0] == .25);
        assert_true(e.now.sources[3].base_color.rgb[0] == .25);
        assert_int_equal(e.now.assigned[BALL_OBJECT], LAMP);
        assert_true(e.now.view.lighting.background[0] == .25);
    }
    edit_free(&e);
}

static void a_copy_and_its_assignment_are_one_step(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    edit_end_step(&e);
    edit_assign(&e, BALL_OBJECT, edit_duplicate(&e, WALL));
    edit_end_step(&e);
    assert_string_equal(e.names[3], "wall.2");
    assert_string_equal(edit_undo(&e), "copy wall.2");
    assert_int_equal(e.now.assigned[BALL_OBJECT], NO_INDEX);
    assert_false(e.now.is_there[3]);
    assert_null(edit_undo(&e));
    assert_string_equal(edit_redo(&e), "copy wall.2");
    assert_int_equal(e.now.assigned[BALL_OBJECT], 3);
    assert_true(e.now.is_there[3]);
    assert_int_equal(edit_duplicate(&e, 3), 4);
    assert_string_equal(e.names[4], "wall.3");
    edit_free(&e);
}

/* Calls of a gesture are one step until it pauses, another one begins, or
 * another thing is changed. */
static void a_gesture_is_one_step(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    assert_true(edit_begin_gesture(&e, 1, 0));
    put_eye(&e, 1);
    assert_false(edit_begin_gesture(&e, 1, 700 * MS));
    put_eye(&e, 2);
    assert_false(edit_begin_gesture(&e, 1, 1400 * MS));
    put_eye(&e, 3);
    assert_true(edit_begin_gesture(&e, 1, 2101 * MS)); /* after a pause */
    put_eye(&e, 4);
    assert_true(edit_begin_gesture(&e, 2, 2102 * MS)); /* another key */
    put_eye(&e, 5);
    put_kd(&e, WALL, .25); /* another thing */
    put_kd(&e, WALL, .75);
    put_kd(&e, LAMP, .75);
    assert_string_equal(edit_undo(&e), "material lamp");
    assert_string_equal(edit_undo(&e), "material wall");
    assert_true(e.now.sources[WALL].base_color.rgb[0] == .5);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 4);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 3);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == e.saved.view.pose.eye[0]);
    assert_null(edit_undo(&e));
    assert_true(edit_begin_gesture(&e, 2, 2103 * MS)); /* undo ends a gesture */
    edit_free(&e);
}

static void a_change_drops_undone_steps(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    for (int i = 1; i <= 3; i++) {
        edit_end_step(&e);
        put_eye(&e, i);
        edit_end_step(&e);
        put_kd(&e, WALL, i / 4.);
    }
    for (int i = 0; i < 4; i++)
        edit_undo(&e);
    put_eye(&e, 1); /* as it is: no change */
    assert_non_null(edit_redo(&e));
    edit_undo(&e);
    put_background(&e, 1);
    assert_null(edit_redo(&e));
    assert_string_equal(edit_undo(&e), "light");
    assert_string_equal(edit_undo(&e), "material wall");
    assert_string_equal(edit_undo(&e), "camera");
    assert_null(edit_undo(&e));
    edit_free(&e);
}

static void a_gesture_without_effect_is_no_step(void **state)
{
    struct edit e;
    double x;

    (void)state;
    open_edit(&e);
    x = e.now.view.pose.eye[0];
    edit_begin_gesture(&e, 1, 0);
    put_eye(&e, x + 1);
    put_eye(&e, x);
    put_kd(&e, WALL, .75);
    put_kd(&e, WALL, .5);
    put_sky(&e, "a.hdr");
    put_sky(&e, NULL);
    edit_assign(&e, BALL_OBJECT, LAMP);
    edit_assign(&e, BALL_OBJECT, NO_INDEX);
    assert_null(edit_undo(&e));
    edit_shot(&e, 0);
    edit_shot(&e, 0);
    assert_string_equal(edit_undo(&e), "view 1");
    assert_null(edit_undo(&e));
    edit_free(&e);
}

/* ---- versions ---- */

static void version_counts_new_renders(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    COUNTS(put_eye(&e, 1), 1);
    COUNTS(put_eye(&e, 1), 0);
    COUNTS(put_kd(&e, WALL, .25), 1);
    COUNTS(put_kd(&e, WALL, .25), 0);
    COUNTS(edit_assign(&e, BALL_OBJECT, LAMP), 1);
    COUNTS(edit_assign(&e, BALL_OBJECT, LAMP), 0);
    COUNTS(put_background(&e, 1), 1);
    COUNTS(put_sky(&e, "a.hdr"), 1);
    COUNTS(put_sky(&e, "a.hdr"), 0);
    COUNTS(put_exposure(&e, 1), 0);
    COUNTS(put_tone(&e, TONE_ACES), 0);
    COUNTS(edit_shot(&e, 0), 0);
    COUNTS(edit_duplicate(&e, WALL), 0);
    for (int i = 0; i < 4; i++)
        COUNTS(edit_undo(&e), 0); /* copy, view, tone, exposure */
    for (int i = 0; i < 5; i++)
        COUNTS(edit_undo(&e), 1);
    COUNTS(edit_undo(&e), 0); /* nothing to undo */
    edit_free(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_have_names_in_order_of_time),
        cmocka_unit_test(a_copy_and_its_assignment_are_one_step),
        cmocka_unit_test(a_gesture_is_one_step),
        cmocka_unit_test(a_change_drops_undone_steps),
        cmocka_unit_test(a_gesture_without_effect_is_no_step),
        cmocka_unit_test(version_counts_new_renders),
    };

    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
