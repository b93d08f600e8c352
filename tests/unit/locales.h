// SPDX-License-Identifier: MIT
/*
 * locales.h - a locale with other conventions, compiled if the system lacks it
 *
 * For programs whose groups have folder.h's make_folder().
 *
 * Ownership: the locale is in the folder of the tests
 * Threads:   one
 * Errors:    false: neither the locale nor its sources exist
 */
#ifndef TESTS_LOCALES_H
#define TESTS_LOCALES_H

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/unit/folder.h"

/* Sets the category to a language such as "de_DE", in UTF-8. */
static inline bool set_language(int category, const char *language)
{
    char name[32], command[320];

    snprintf(name, sizeof name, "%s.UTF-8", language);
    /* The C library remembers folders that lack a locale. */
    unsetenv("LOCPATH");
    if (setlocale(category, name) != NULL)
        return true;
    snprintf(command, sizeof command,
             "localedef -i %s -f UTF-8 %s/%s >/dev/null 2>&1", language, folder,
             name);
    (void)!system(command); /* localedef returns failure for warnings */
    return setenv("LOCPATH", folder, 1) == 0 &&
           setlocale(category, name) != NULL;
}

#endif
