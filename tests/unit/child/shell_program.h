// SPDX-License-Identifier: MIT
/*
 * shell_program.h - a program of the shell in place of a copy of glim
 *
 * Errors:    ends the test
 */
#ifndef TESTS_SHELL_PROGRAM_H
#define TESTS_SHELL_PROGRAM_H

#include <sys/stat.h>

#include "tests/unit/files.h"

/* Writes the program and returns its path. */
static inline const char *shell_program(const char *script)
{
    char text[256];

    snprintf(text, sizeof text, "#!/bin/sh\n%s\n", script);
    put("child", text);
    chmod("child", 0700);
    return "./child";
}

#endif
