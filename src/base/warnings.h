// SPDX-License-Identifier: MIT
/*
 * warnings.h - warnings of a load: the first of each kind in full, then counts
 *
 * Ownership: warnings_free() frees what a report holds; texts are copied
 * Threads:   one thread at a time
 * Errors:    has_lost says that memory was out
 */
#ifndef GLIM_WARNINGS_H
#define GLIM_WARNINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct warnings_entry {
    char *kind;
    char *text; /* text of the first warning: one finished line */
    uint64_t count;
};

/* List of warnings. A zeroed struct is empty. */
struct warnings {
    struct warnings_entry *entries;
    int entry_count;
    size_t capacity;
    bool has_lost; /* true if a warning was lost because memory was out */
};

/* Counts one warning of this kind, and keeps its text if it is the first.
 * `kind` is a short phrase that reads well after a number: "faces with a bad
 * index". */
void warnings_add(struct warnings *r, const char *kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Counts one warning about a named object of the file; the first of each kind
 * and name is kept in full. After WARNINGS_NAMES_MAX names of a kind the others
 * are counted together, so that no file can fill the screen. */
#define WARNINGS_NAMES_MAX 20
void warnings_add_named(struct warnings *r, const char *kind, const char *name,
                        const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Returns true if there is a warning of this kind. */
bool warnings_have(const struct warnings *r, const char *kind);

/* Returns "TEXT", or "TEXT (in all N KIND)" if there were more, for free(), or
 * NULL when memory is out. */
char *warnings_line(const struct warnings_entry *entry);

/* Writes a line for each kind: "glim: warning: TEXT", followed by " (in all N
 * KIND)" if there were more. */
void warnings_print(const struct warnings *r, FILE *to);

void warnings_free(struct warnings *r);

#endif
