// SPDX-License-Identifier: MIT
/*
 * library_child.h - libraries that are loaded on request, and copies of the
 * program in which a library of others reads a file that may be hostile
 *
 * Such a library may crash, hang or fill the memory. Its copy has limits of
 * time and memory, which grow with the bytes that it reads. The copy writes
 * what it has read to its standard output, or one line that says why it could
 * not, with another status than 0.
 *
 * Units:     seconds, bytes
 * Ownership: a library is never unloaded, as drivers do not survive that; the
 *            output is the caller's, for free()
 * Threads:   any, with tables of their own
 * Errors:    texts of dlerror(), or the name of a function; the message of the
 *            library, a crash, a limit: without the file's name, which the
 *            caller adds
 */
#ifndef GLIM_LIBRARY_CHILD_H
#define GLIM_LIBRARY_CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/child.h"
#include "base/error.h"

/* ---- functions ---- */

struct library_function {
    const char *name;
    size_t offset; /* of the pointer in the table of functions */
};

/* Loads the library and fills the table. Returns false if there is no library,
 * with *missing NULL, or no such function, with its name in *missing. */
bool dynamic_library_load(const char *file,
                          const struct library_function *functions,
                          size_t count, void *table, const char **missing);

/* ---- copies ---- */

/* Most that a copy may use, and the time of the processor. */
struct library_limits {
    unsigned time_s;
    uint64_t memory_bytes;
};

struct library_task {
    const char *library;       /* its name, for messages */
    const char *program;       /* NULL: there is no program to copy */
    const char *option;        /* of the program, whose value are the limits */
    const char *path;          /* NULL: the copy reads standard input */
    const void *input;         /* without a path */
    const char *words;         /* standard input beside a path; NULL: none */
    size_t size_bytes;         /* of the file or the input */
    unsigned bytes_a_second;   /* at least, beyond the start */
    unsigned memory_of_a_byte; /* at most, beyond the start */
    uint64_t memory_most;      /* 0: what the machine holds */
};

/* Runs the copy and waits for its end. After a failure the output is what the
 * copy had written, or NULL. */
bool library_child_run(const struct library_task *task,
                       struct child_result *result, struct error *err);

/* Limits this process, which is a copy. */
void library_child_limit(struct library_limits limits);

/* Sends an error in place of the answer. Returns false. */
bool library_child_fail(FILE *to, const struct error *err);

#endif
