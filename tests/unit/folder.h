// SPDX-License-Identifier: MIT
/*
 * folder.h - a folder of its own for a test program
 *
 * make_folder() and remove_folder() are for cmocka_run_group_tests().
 *
 * Ownership: remove_folder() removes it with all that is in it
 * Threads:   one
 * Errors:    -1 ends the program's tests
 */
#ifndef TESTS_FOLDER_H
#define TESTS_FOLDER_H

#include <stdio.h>
#include <stdlib.h>

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/glim-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[128];

    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) == 0 ? 0 : -1;
}

#endif
