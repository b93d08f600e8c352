// SPDX-License-Identifier: MIT
/*
 * assign.h - which objects have another material than their file says: the
 * `assign OBJECT MATERIAL` lines of a view file
 *
 * A name with blanks, quotes, # or \ in it, or an empty one, stands in double
 * quotes; a quote in there is doubled.
 *
 * Ownership: names are copied; assigns_free() frees; a zeroed struct is empty
 * Threads:   one thread at a time
 * Errors:    false when memory is out
 */
#ifndef GLIM_ASSIGN_H
#define GLIM_ASSIGN_H

#include <stdbool.h>
#include <stdio.h>

#include "base/lexer.h"

struct assign {
    char *object, *material;
};

struct assigns {
    struct assign *items;
    size_t count;
};

/* Reads what follows the key `assign`. *has_names: those two, and no more. */
bool assigns_read(struct assigns *assigns, struct lexer *lex, bool *has_names);

/* A line each, in order. */
void assigns_write(const struct assigns *assigns, FILE *to);

/* The later of two for one object counts; NULL: what its file says. */
bool assigns_set(struct assigns *assigns, const char *object,
                 const char *material);

bool assigns_copy(struct assigns *to, const struct assigns *from);
void assigns_free(struct assigns *assigns);

#endif
