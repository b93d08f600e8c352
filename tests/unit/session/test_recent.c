// SPDX-License-Identifier: MIT
/*
 * test_recent.c - the list of scenes: the most recent first, each once, none
 * that is gone, at most twenty; answers of a person
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

/* Checks the scene for this answer; "" is none. */
static void check_answer(const char *answer, const char *expected)
{
    static char first[] = "/tmp/a\033.obj", second[] = "/tmp/b.obj";
    const struct state_list r = {.lines = {first, second}, .count = 2};
    char copy[64], shown[512] = "";
    FILE *in, *out = fmemopen(shown, sizeof shown, "w");
    char *path;

    snprintf(copy, sizeof copy, "%s", answer);
    in = fmemopen(copy, strlen(copy), "r");
    assert_true(in && out);
    path = recent_choose(&r, in, out);
    fclose(in);
    fclose(out);
    assert_string_equal(path ? path : "", expected);
    assert_non_null(strstr(shown, "  1  /tmp/a?.obj\n  2  /tmp/b.obj\n"));
    free(path);
}

static void answers_select_a_scene(void **state)
{
    (void)state;
    check_answer("\n", "/tmp/a\033.obj");
    check_answer("1\n", "/tmp/a\033.obj");
    check_answer("2", "/tmp/b.obj");
    check_answer("3\n0\n-1\n2 x\n2\n", "/tmp/b.obj");
    check_answer("q\n2\n", "");
    check_answer("/dev/null\n", "/dev/null");
    check_answer("not there\n", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_recent_scene_is_first_and_once),
        cmocka_unit_test(the_oldest_are_forgotten),
        cmocka_unit_test(unusable_names_are_left_out),
        cmocka_unit_test(without_a_folder_nothing_is_remembered),
        cmocka_unit_test(answers_select_a_scene),
    };

    return cmocka_run_group_tests(tests, enter_folder_with_state,
                                  remove_folder);
}
