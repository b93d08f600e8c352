// SPDX-License-Identifier: MIT
/*
 * test_edit_saved.c - the present state beside that of the files: comparing and
 * reloading
 */
#include "tests/unit/edits.h"

/* ---- comparing with the saved state ---- */

static void comparing_shows_saved_values_and_the_present_camera(void **state)
{
    struct edit e;
    struct view view;

    (void)state;
    open_edit(&e);
    put_eye(&e, 1);
    put_exposure(&e, 1);
    COUNTS(edit_compare(&e, true), 0); /* the picture differs by exposure */
    COUNTS(edit_compare(&e, false), 0);
    put_kd(&e, WALL, .25);
    edit_assign(&e, BALL_OBJECT, LAMP);
    put_background(&e, 1);
    COUNTS(edit_compare(&e, true), 1);
    COUNTS(edit_compare(&e, true), 0);
    assert_true(edit_shown(&e)->sources[WALL].base_color.rgb[0] == .5);
    assert_int_equal(edit_shown(&e)->assigned[BALL_OBJECT], NO_INDEX);
    view = edit_view(&e);
    assert_true(view.lighting.background[0] == 0);
    assert_true(view.lighting.exposure == 0);
    assert_true(view.pose.eye[0] == 1);
    COUNTS(put_eye(&e, 2), 1); /* the camera goes on moving */
    assert_true(edit_view(&e).pose.eye[0] == 2);
    COUNTS(edit_shot(&e, 0), 0);
    edit_undo(&e);
    edit_undo(&e);
    assert_true(e.is_comparing);
    assert_true(edit_view(&e).pose.eye[0] == 1);
    COUNTS(edit_compare(&e, false), 1);
    assert_true(edit_shown(&e)->sources[WALL].base_color.rgb[0] == .25);
    assert_true(edit_view(&e).lighting.background[0] == 1);
    edit_free(&e);
}

/* A change of materials or light, its undo and its saving end the comparison,
 * with a new render if the picture was another one. */
static void changes_end_comparing(void **state)
{
    struct edit e;

    (void)state;
    open_edit(&e);
    for (int i = 0; i < 6; i++) {
        struct view view = {.width_px = 0};

        edit_end_step(&e);
        put_kd(&e, WALL, .25 + i);
        edit_end_step(&e);
        put_exposure(&e, 1 + i);
        edit_compare(&e, true);
        switch (i) {
        case 0: COUNTS(put_kd(&e, LAMP, .25), 1); break;
        case 1: COUNTS(edit_undo(&e), 1); break; /* of the exposure */
        case 2:
            edit_undo(&e);
            COUNTS(edit_redo(&e), 0);
            break;
        case 3: COUNTS(put_exposure(&e, 9), 1); break;
        case 4:
            xcheck(view_copy(&view, &e.now.view));
            COUNTS(edit_saved_view(&e, &view), 1);
            view_free(&view);
            break;
        case 5: COUNTS(edit_saved_material(&e, WALL), 1); break;
        }
        assert_false(e.is_comparing);
        assert_true(edit_shown(&e) == &e.now);
    }
    edit_free(&e);
}

/* ---- reloading ---- */

/* Loads the files anew. `file_eye` is the eye's x in the changed view file; 0:
 * the file is unchanged. */
static void reload(struct edit *e, struct edit *before, double file_eye)
{
    struct view view;

    view_init(&view);
    view.has_camera = true;
    if (file_eye > 0)
        view.pose.eye[0] = file_eye;
    edit_init(e, &scene, &view, &report);
    edit_keep_camera(e, before);
    edit_free(before);
    view_free(&view);
}

static void move_and_edit(struct edit *e)
{
    struct view view;

    view_init(&view);
    view.has_camera = true;
    edit_init(e, &scene, &view, &report);
    view_free(&view);
    put_eye(e, 1);
    edit_end_step(e);
    put_kd(e, WALL, .25);
    edit_end_step(e);
    put_eye(e, 2);
    edit_shot(e, 0);
    put_background(e, 1);
}

static void a_reload_keeps_camera_steps(void **state)
{
    struct edit before, e;
    uint32_t version;

    (void)state;
    move_and_edit(&before);
    version = before.version;
    reload(&e, &before, 0);
    assert_true(e.version != version);
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_true(e.now.view.shots[0].eye[0] == 2);
    assert_true(e.now.sources[WALL].base_color.rgb[0] == .5);
    assert_true(e.now.view.lighting.background[0] == 0);
    put_eye(&e, 3); /* a step of its own */
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_string_equal(edit_undo(&e), "view 1");
    assert_false(e.now.view.has_shot[0]);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 1);
    /* undone steps are there after a reload, too */
    before = e;
    reload(&e, &before, 0);
    assert_true(e.now.view.pose.eye[0] == 1);
    assert_string_equal(edit_redo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_string_equal(edit_undo(&e), "camera");
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == e.saved.view.pose.eye[0]);
    assert_null(edit_undo(&e));
    edit_free(&e);
}

static void the_camera_of_a_changed_file_is_a_step(void **state)
{
    struct edit before, e;

    (void)state;
    move_and_edit(&before);
    reload(&e, &before, 7);
    assert_true(e.now.view.pose.eye[0] == 7);
    assert_string_equal(edit_undo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 2);
    assert_string_equal(edit_redo(&e), "camera");
    assert_true(e.now.view.pose.eye[0] == 7);
    edit_free(&e);
}

/* Statements that make the material of the file are no change: illum 1 of a
 * material without Ks, as the types of the panel leave it. */
static void equal_materials_are_saved(void **state)
{
    struct edit e;
    struct material_values source;

    (void)state;
    open_edit(&e);
    source = e.now.sources[WALL];
    source.illum = (struct mtl_number){.value = 1, .line = 1};
    edit_material(&e, WALL, &source);
    assert_true(edit_is_saved(&e, WALL));
    assert_false(edit_has_unsaved_materials(&e));
    source.illum.value = 7; /* solid glass */
    edit_material(&e, WALL, &source);
    assert_false(edit_is_saved(&e, WALL));
    assert_true(edit_has_unsaved_materials(&e));
    edit_free(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comparing_shows_saved_values_and_the_present_camera),
        cmocka_unit_test(changes_end_comparing),
        cmocka_unit_test(a_reload_keeps_camera_steps),
        cmocka_unit_test(the_camera_of_a_changed_file_is_a_step),
        cmocka_unit_test(equal_materials_are_saved),
    };

    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
