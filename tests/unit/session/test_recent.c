// SPDX-License-Identifier: MIT
/*
 * test_recent.c - the list of scenes: the most recent first, each once, none
 * that is gone, at most twenty
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "session/state_list.h"

static void make_scene(int number)
{
    char name[32];
    FILE *to;

    snprintf(name, sizeof name, "%d.obj", number);
    to = fopen(name, "w");
    assert_non_null(to);
    fclose(to);
    recent_add(name);
}

/* Checks whether entry i is N.obj in the folder. */
static void is_scene(const struct state_list *r, int i, int number)
{
    char path[256];

    assert_true(i < r->count);
    snprintf(path, sizeof path, "%s/%d.obj", folder, number);
    assert_string_equal(r->lines[i], path);
}

static void forget(void)
{
    char path[256];

    state_list_finish();
    snprintf(path, sizeof path, "%s/state/glim/recent", folder);
    unlink(path);
}

static void most_recent_scene_is_first_and_once(void **state)
{
    struct state_list r;

    (void)state;
    forget();
    recent_read(&r);
    assert_int_equal(r.count, 0);
    for (int i = 0; i < 3; i++)
        make_scene(i);
    make_scene(1);
    recent_read(&r);
    assert_int_equal(r.count, 3);
    is_scene(&r, 0, 1);
    is_scene(&r, 1, 2);
    is_scene(&r, 2, 0);
    state_list_free(&r);
    unlink("2.obj");
    recent_read(&r);
    assert_int_equal(r.count, 2);
    is_scene(&r, 1, 0);
    state_list_free(&r);
}

static void the_oldest_are_forgotten(void **state)
{
    struct state_list r;

    (void)state;
    forget();
    for (int i = 0; i < RECENT_MAX + 5; i++)
        make_scene(i);
    recent_read(&r);
    assert_int_equal(r.count, RECENT_MAX);
    is_scene(&r, 0, RECENT_MAX + 4);
    is_scene(&r, RECENT_MAX - 1, 5);
    state_list_free(&r);
}

static void unusable_names_are_left_out(void **state)
{
    struct state_list r;
    FILE *to = fopen("a\nb.obj", "w");

    (void)state;
    assert_non_null(to);
    fclose(to);
    forget();
    recent_add("a\nb.obj");
    recent_add("not there.obj");
    recent_read(&r);
    assert_int_equal(r.count, 0);
}

static void without_a_folder_nothing_is_remembered(void **state)
{
    struct state_list r;

    (void)state;
    setenv("XDG_STATE_HOME", "/dev/null/no", 1);
    make_scene(1);
    recent_read(&r);
    assert_int_equal(r.count, 0);
    setenv("XDG_STATE_HOME", "state", 1); /* relative, so it is ignored */
    setenv("HOME", "", 1);
    recent_read(&r);
    assert_int_equal(r.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_recent_scene_is_first_and_once),
        cmocka_unit_test(the_oldest_are_forgotten),
        cmocka_unit_test(unusable_names_are_left_out),
        cmocka_unit_test(without_a_folder_nothing_is_remembered),
    };

    return cmocka_run_group_tests(tests, enter_folder_with_state,
                                  remove_folder);
}
