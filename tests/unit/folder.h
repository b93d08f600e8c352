// SPDX-License-Identifier: MIT
/*
 * folder.h - a temporary folder for each test program, in $TMPDIR or /tmp
 *
 * The functions can be the setup and teardown of cmocka_run_group_tests().
 *
 * Threads:   one
 * Errors:    -1 ends the program's tests
 */
#ifndef TESTS_FOLDER_H
#define TESTS_FOLDER_H

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[160];

/* Makes the folder, for remove_folder() or leave_empty_folder(). */
static inline int make_folder(void **state)
{
    const char *parent = getenv("TMPDIR");
    int length = snprintf(folder, sizeof folder, "%s/glim-test-XXXXXX",
                          parent != NULL && parent[0] == '/' ? parent : "/tmp");

    (void)state;
    return length < (int)sizeof folder && mkdtemp(folder) != NULL ? 0 : -1;
}

/* Makes the folder and makes it the current one. */
static inline int enter_folder(void **state)
{
    return make_folder(state) == 0 && chdir(folder) == 0 ? 0 : -1;
}

/* Enters the folder, whose sub-folder "state" has the state of the user. */
static inline int enter_folder_with_state(void **state)
{
    char path[sizeof folder + 16];

    if (enter_folder(state) != 0)
        return -1;
    snprintf(path, sizeof path, "%s/state", folder);
    return setenv("XDG_STATE_HOME", path, 1);
}

/* Removes the folder with everything in it. */
static inline int remove_folder(void **state)
{
    char command[2 * sizeof folder + 64];

    (void)state;
    snprintf(command, sizeof command, "chmod -R u+w '%s'; rm -rf '%s'", folder,
             folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

/* Removes the folder; fails if a file was left in it. */
static inline int leave_empty_folder(void **state)
{
    (void)state;
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

#endif
