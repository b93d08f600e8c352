// SPDX-License-Identifier: MIT
/*
 * rows.h - prints a line for each check of a list
 *
 * The lines are "ok NAME: ...", "FAIL NAME: ..." or "todo NAME: needs ...";
 * run.sh counts the first two.
 *
 * Threads:   one
 * Errors:    rows_status() is the program's exit status
 */
#ifndef TESTS_ROWS_H
#define TESTS_ROWS_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

static int rows_failed;

__attribute__((format(printf, 3, 4))) static inline void
row(bool is_ok, const char *name, const char *format, ...)
{
    va_list list;

    rows_failed += !is_ok;
    printf("%s %s: ", is_ok ? "ok" : "FAIL", name);
    va_start(list, format);
    vprintf(format, list);
    va_end(list);
    printf("\n");
    fflush(stdout);
}

static inline int rows_status(void)
{
    return rows_failed > 0 ? 1 : 0;
}

#endif
