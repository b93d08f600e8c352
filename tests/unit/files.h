// SPDX-License-Identifier: MIT
/*
 * files.h - small files in a folder of their own, by the C library alone
 *
 * enter_folder() and leave_folder() are for cmocka_run_group_tests().
 *
 * Ownership: leave_folder() removes all that is in the folder
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_FILES_H
#define TESTS_FILES_H

#include <dirent.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/unit/check.h"

static char folder[64];

static int enter_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/glim-test-XXXXXX");
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    char command[256];

    (void)state;
    snprintf(command, sizeof command, "chmod -R u+w %s; rm -rf %s", folder,
             folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

/* By the C library alone. */
static void put(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");

    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

static void has(const char *path, const char *expected)
{
    char text[256] = "";
    FILE *f = fopen(path, "r");

    assert_non_null(f);
    size_t length = fread(text, 1, sizeof text - 1, f);
    text[length] = '\0';
    fclose(f);
    assert_string_equal(text, expected);
}

static int count_files(const char *path)
{
    DIR *d = opendir(path);
    int count = -2; /* . and .. */

    assert_non_null(d);
    while (readdir(d))
        count++;
    closedir(d);
    return count;
}

#endif
