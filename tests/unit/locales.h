// SPDX-License-Identifier: MIT
/*
 * locales.h - a locale of other habits, made where the system has none
 *
 * For programs whose groups have folder.h's make_folder().
 *
 * Ownership: the folder of the tests holds what is made
 * Threads:   one
 * Errors:    false: neither is it there, nor is what it is made of
 */
#ifndef TESTS_LOCALES_H
#define TESTS_LOCALES_H

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/unit/folder.h"

/* Sets the category to language "de_DE", ... in UTF-8. */
static inline bool set_language(int category, const char *language)
{
    char name[32], command[320];

    snprintf(name, sizeof name, "%s.UTF-8", language);
    unsetenv("LOCPATH"); /* where nothing was found is not searched again */
    if (setlocale(category, name) != NULL)
        return true;
    snprintf(command, sizeof command,
             "localedef -i %s -f UTF-8 %s/%s >/dev/null 2>&1", language, folder,
             name);
    (void)!system(command); /* a warning is a failure to it */
    return setenv("LOCPATH", folder, 1) == 0 &&
           setlocale(category, name) != NULL;
}

#endif
