// SPDX-License-Identifier: MIT
/*
 * Tests the rules of the XDG base directory specification: the variable counts
 * if it names an absolute folder, otherwise a folder in the home.
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/xdg.h"

static void is_folder(const char *variable, const char *home,
                      const char *expected)
{
    char *found;

    if (variable)
        setenv("XDG_STATE_HOME", variable, 1);
    else
        unsetenv("XDG_STATE_HOME");
    if (home)
        setenv("HOME", home, 1);
    else
        unsetenv("HOME");
    found = xdg_folder("XDG_STATE_HOME", ".local/state");
    if (expected)
        assert_string_equal(found, expected);
    else
        assert_null(found);
    free(found);
}

static void folders_follow_the_specification(void **state)
{
    (void)state;
    is_folder("/a/b", "/home/c", "/a/b/glim");
    is_folder("/a/b", NULL, "/a/b/glim");
    is_folder(NULL, "/home/c", "/home/c/.local/state/glim");
    is_folder("", "/home/c", "/home/c/.local/state/glim");
    is_folder("relative", "/home/c", "/home/c/.local/state/glim");
    is_folder("relative", "home", NULL);
    is_folder(NULL, "", NULL);
    is_folder(NULL, NULL, NULL);
}

static void state_folders_are_made(void **state)
{
    char home[256], expected[320];
    struct stat st;
    char *path;

    (void)state;
    unsetenv("XDG_STATE_HOME");
    snprintf(home, sizeof home, "%s/home", folder);
    setenv("HOME", home, 1);
    for (int i = 0; i < 2; i++) {
        path = xdg_state_path("x");
        snprintf(expected, sizeof expected, "%s/.local/state/glim/x", home);
        assert_string_equal(path, expected);
        path[strlen(path) - 2] = '\0';
        assert_int_equal(stat(path, &st), 0);
        assert_true(S_ISDIR(st.st_mode));
        assert_int_equal(st.st_mode & 077, 0);
        free(path);
    }
}

static void folder_that_cannot_be_made_gives_no_path(void **state)
{
    char file[256];
    FILE *to;

    (void)state;
    snprintf(file, sizeof file, "%s/file", folder);
    to = fopen(file, "w");
    assert_non_null(to);
    fclose(to);
    setenv("XDG_STATE_HOME", file, 1);
    assert_null(xdg_state_path("x"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folders_follow_the_specification),
        cmocka_unit_test(state_folders_are_made),
        cmocka_unit_test(folder_that_cannot_be_made_gives_no_path),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
