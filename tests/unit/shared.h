// SPDX-License-Identifier: MIT
/*
 * shared.h - files that tests use where they are: below ../shared, or below the
 * folder that GLIM_SHARED names
 *
 * Threads:   one
 */
#ifndef TESTS_SHARED_H
#define TESTS_SHARED_H

#include <stdlib.h>
#include <unistd.h>

#include "tests/unit/check.h"

static inline const char *shared_folder(void)
{
    const char *given = getenv("GLIM_SHARED");

    return given != NULL ? given : "../shared";
}

/* Returns the path of a shared file or folder, for free(). Without it the test
 * is skipped, and a line gives the reason. */
static inline char *shared_path(const char *name)
{
    char path[1000];

    snprintf(path, sizeof path, "%s/%s", shared_folder(), name);
    if (access(path, R_OK) != 0) {
        print_message("skipped: there is no %s\n", path);
        skip();
    }
    return strdup(path);
}

#endif
