// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "studio/camera_history.h"

static struct pose pose_at(double x)
{
    return (struct pose){.eye = {x}};
}

static void starts_empty(void **state)
{
    struct camera_history h = {0};
    struct pose pose = pose_at(1);

    (void)state;
    assert_false(camera_history_undo(&h, &pose));
    assert_false(camera_history_redo(&h, &pose));
    assert_true(pose.eye[0] == 1);
    camera_history_free(&h);
}

/* 1000 steps back and forth again, through every pose. */
static void goes_all_the_way(void **state)
{
    struct camera_history h = {0};
    struct pose pose = pose_at(0);

    (void)state;
    for (int i = 1; i <= 1000; i++) {
        camera_history_add(&h, &pose);
        pose = pose_at(i);
    }
    for (int round = 0; round < 2; round++) {
        for (int i = 999; i >= 0; i--) {
            assert_true(camera_history_undo(&h, &pose));
            assert_true(pose.eye[0] == i);
        }
        assert_false(camera_history_undo(&h, &pose));
        for (int i = 1; i <= 1000; i++) {
            assert_true(camera_history_redo(&h, &pose));
            assert_true(pose.eye[0] == i);
        }
        assert_false(camera_history_redo(&h, &pose));
    }
    camera_history_free(&h);
}

/* From where one has gone back to, another way begins. */
static void another_way_forgets_the_first(void **state)
{
    struct camera_history h = {0};
    struct pose pose = pose_at(0);

    (void)state;
    camera_history_add(&h, &pose);
    pose = pose_at(1);
    camera_history_add(&h, &pose);
    pose = pose_at(2);
    assert_true(camera_history_undo(&h, &pose));
    camera_history_add(&h, &pose);
    pose = pose_at(7);
    assert_false(camera_history_redo(&h, &pose));
    assert_true(camera_history_undo(&h, &pose));
    assert_true(pose.eye[0] == 1);
    assert_true(camera_history_undo(&h, &pose));
    assert_true(pose.eye[0] == 0);
    assert_true(camera_history_redo(&h, &pose));
    assert_true(camera_history_redo(&h, &pose));
    assert_true(pose.eye[0] == 7);
    camera_history_free(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_empty),
        cmocka_unit_test(goes_all_the_way),
        cmocka_unit_test(another_way_forgets_the_first),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
