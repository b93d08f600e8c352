// SPDX-License-Identifier: MIT
/*
 * test_edit_history.c - steps of one group are undone together; gestures begin
 * groups by number and by time
 */
#include "session/edit.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"

#define MS UINT64_C(1000000)

static const struct edit_step *add(struct edit_history *h,
                                   enum edit_step_kind kind, uint32_t index)
{
    struct edit_step step = {.kind = kind, .index = index};

    if (kind == STEP_MATERIAL)
        step.value.source = xcalloc(1, sizeof *step.value.source);
    return edit_history_add(h, step);
}

static void add_eye(struct edit_history *h, double x)
{
    edit_history_add(h, (struct edit_step){.kind = STEP_POSE,
                                           .value.pose = {.eye = {x, 0, 0}}});
}

static void a_gesture_ends_by_number_or_pause(void **state)
{
    struct edit_history h = {.steps = NULL};

    (void)state;
    assert_true(edit_history_begin_gesture(&h, 1, 0));
    assert_false(edit_history_begin_gesture(&h, 1, 700 * MS));
    assert_false(
        edit_history_begin_gesture(&h, 1, 1400 * MS)); /* since the last */
    assert_true(edit_history_begin_gesture(&h, 1, 2100 * MS + 1));
    assert_true(edit_history_begin_gesture(&h, 2, 2101 * MS));
    assert_true(edit_history_begin_gesture(&h, 1, 2102 * MS));
    edit_history_end_step(&h);
    assert_true(edit_history_begin_gesture(&h, 1, 2103 * MS));
    edit_history_free(&h);
}

static void equal_changes_of_a_group_merge(void **state)
{
    struct edit_history h = {.steps = NULL};

    (void)state;
    edit_history_end_step(&h);
    for (int i = 0; i < 10; i++)
        add_eye(&h, i);
    assert_int_equal(h.step_count, 1);
    assert_true(h.steps[0].value.pose.eye[0] == 0); /* before the first one */
    add(&h, STEP_MATERIAL, 1);
    add(&h, STEP_MATERIAL, 2);
    add(&h, STEP_MATERIAL, 2);
    assert_int_equal(h.step_count, 3);
    assert_int_equal(h.steps[2].group, h.steps[0].group);
    edit_history_end_step(&h);
    add(&h, STEP_MATERIAL, 2);
    assert_int_equal(h.step_count, 4);
    assert_int_not_equal(h.steps[3].group, h.steps[2].group);
    edit_history_free(&h);
    assert_int_equal(h.step_count, 0);
}

static void a_gesture_has_a_group_for_each_thing(void **state)
{
    struct edit_history h = {.steps = NULL};

    (void)state;
    edit_history_begin_gesture(&h, 1, 0);
    add(&h, STEP_ASSIGN, 1);
    edit_history_begin_gesture(&h, 1, MS);
    add(&h, STEP_ASSIGN, 2);
    edit_history_begin_gesture(&h, 1, 2 * MS);
    add(&h, STEP_ASSIGN, 2);
    assert_int_equal(h.step_count, 2);
    assert_int_not_equal(h.steps[0].group, h.steps[1].group);
    edit_history_free(&h);
}

static void back_and_forward_stay_in_the_group(void **state)
{
    struct edit_history h = {.steps = NULL};
    const struct edit_step *first;

    (void)state;
    assert_null(edit_history_back(&h, NULL));
    assert_null(edit_history_forward(&h, NULL));
    add(&h, STEP_ASSIGN, 0);
    edit_history_end_step(&h);
    add(&h, STEP_ASSIGN, 1);
    add(&h, STEP_ASSIGN, 2);
    first = edit_history_back(&h, NULL);
    assert_int_equal(first->index, 2);
    assert_int_equal(edit_history_back(&h, first)->index, 1);
    assert_null(edit_history_back(&h, first)); /* of another group */
    assert_int_equal(h.done_count, 1);
    first = edit_history_forward(&h, NULL);
    assert_int_equal(first->index, 1);
    assert_int_equal(edit_history_forward(&h, first)->index, 2);
    assert_null(edit_history_forward(&h, first));
    edit_history_back(&h, NULL);
    edit_history_end_step(&h);
    add(&h, STEP_ASSIGN, 7); /* drops 2, which was undone */
    assert_int_equal(h.step_count, 3);
    assert_null(edit_history_forward(&h, NULL));
    assert_int_equal(edit_history_back(&h, NULL)->index, 7);
    edit_history_forward(&h, NULL);
    edit_history_drop_last(&h);
    assert_int_equal(edit_history_back(&h, NULL)->index, 1);
    edit_history_free(&h);
}

/* The steps that were taken do not depend on the other history. */
static void camera_steps_stay_in_order(void **state)
{
    struct edit_history from = {.steps = NULL}, h = {.steps = NULL};

    (void)state;
    add_eye(&from, 1);
    for (uint32_t i = 0; i < 5; i++) {
        edit_history_end_step(&from);
        add(&from, STEP_MATERIAL, i);
        edit_history_end_step(&from);
        add(&from, STEP_SHOT, i);
    }
    for (int i = 0; i < 4; i++)
        edit_history_back(&from, NULL);
    edit_history_take_camera(&h, &from);
    edit_history_free(&from);
    assert_int_equal(h.step_count, 6);
    assert_int_equal(h.done_count, 4);
    assert_int_equal(edit_history_forward(&h, NULL)->index, 3);
    assert_int_equal(edit_history_back(&h, NULL)->index, 3);
    for (int i = 2; i >= 0; i--)
        assert_int_equal(edit_history_back(&h, NULL)->index, i);
    assert_true(edit_history_back(&h, NULL)->value.pose.eye[0] == 1);
    assert_null(edit_history_back(&h, NULL));
    edit_history_free(&h);
}

/* A camera that moves for an hour is one step; 100,000 moves take 16 MB. */
static void memory_is_small(void **state)
{
    struct edit_history h = {.steps = NULL};

    (void)state;
    for (uint64_t i = 0; i < 60 * 3600; i++) {
        edit_history_begin_gesture(&h, 1, i * 16 * MS);
        add_eye(&h, (double)i);
    }
    assert_int_equal(h.step_count, 1);
    assert_true(h.step_capacity * sizeof *h.steps < 4096);
    for (int i = 0; i < 100000; i++) {
        edit_history_end_step(&h);
        add_eye(&h, i);
    }
    assert_int_equal(h.step_count, 100001);
    check_at_most((double)(h.step_capacity * sizeof *h.steps), 16e6);
    edit_history_free(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gesture_ends_by_number_or_pause),
        cmocka_unit_test(equal_changes_of_a_group_merge),
        cmocka_unit_test(a_gesture_has_a_group_for_each_thing),
        cmocka_unit_test(back_and_forward_stay_in_the_group),
        cmocka_unit_test(camera_steps_stay_in_order),
        cmocka_unit_test(memory_is_small),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
