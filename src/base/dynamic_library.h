// SPDX-License-Identifier: MIT
/*
 * dynamic_library.h - finds functions of a library that is loaded on request
 *
 * Ownership: a library is never unloaded, as drivers do not survive that
 * Threads:   any, with tables of their own
 * Errors:    the result: texts of dlerror(), or the name of a function
 */
#ifndef GLIM_DYNAMIC_LIBRARY_H
#define GLIM_DYNAMIC_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

struct library_function {
    const char *name;
    size_t offset; /* of the pointer in the table of functions */
};

/* Loads the library and fills the table. Returns false if there is no library,
 * with *missing NULL, or no such function, with its name in *missing. */
bool dynamic_library_load(const char *file,
                          const struct library_function *functions,
                          size_t count, void *table, const char **missing);

#endif
