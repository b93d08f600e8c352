// SPDX-License-Identifier: MIT
/*
 * assign.h - materials that replace those of the OBJ file, object by object:
 * the `assign OBJECT MATERIAL` lines of a view file
 *
 * A name that is empty or contains blanks, quotes, # or \ is written in double
 * quotes; a quote inside them is doubled.
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

/* Reads the rest of a line after the key `assign`. *has_names becomes true if
 * the line has exactly two names; only then the assignment is added. */
bool assigns_read(struct assigns *assigns, struct lexer *lex, bool *has_names);

/* Writes one `assign` line for each assignment, in order. */
void assigns_write(const struct assigns *assigns, FILE *to);

/* Assigns a material to an object and removes its earlier assignment. With
 * material NULL the object has the material of its file again. */
bool assigns_set(struct assigns *assigns, const char *object,
                 const char *material);

/* Replaces the contents of `to`; leaves them unchanged when memory is out. */
bool assigns_copy(struct assigns *to, const struct assigns *from);
void assigns_free(struct assigns *assigns);

#endif
