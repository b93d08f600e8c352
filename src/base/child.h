// SPDX-License-Identifier: MIT
/*
 * child.h - runs another program, such as a copy of this one, and reads what it
 * writes
 *
 * Code of others may crash or hang: it runs in a child, which is killed at a
 * limit. The process itself does not fork, as drivers do not survive that.
 *
 * Units:     nanoseconds, bytes
 * Ownership: the output is the caller's, for free()
 * Threads:   any
 * Errors:    enum child_end
 */
#ifndef GLIM_CHILD_H
#define GLIM_CHILD_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct child_task {
    const char *program;          /* path of the program */
    const char *const *arguments; /* with its name, and NULL at the end */
    const void *input;            /* standard input; may be NULL */
    size_t input_bytes;
    bool has_errors; /* standard error is read, too; else it is lost */
    bool is_cut;     /* output beyond the limit is skipped */
    /* Limit of the child's processor time, and of time without any. Ten times
     * as much passes at most, so that a busy machine does not end it. */
    uint64_t time_ns;
    size_t size_bytes;              /* limit of the output */
    const atomic_bool *is_unwanted; /* ends the child if true; may be NULL */
};

enum child_end {
    CHILD_ENDED,    /* by itself or by a signal: see status */
    CHILD_UNKNOWN,  /* its status is lost: errno */
    CHILD_NOT_RUN,  /* it could not be started: errno */
    CHILD_LATE,     /* killed at a limit of time, or as unwanted */
    CHILD_TOO_LONG, /* killed at the limit of its output */
    CHILD_NO_MEMORY /* killed, as there was no memory for its output */
};

struct child_result {
    int status;   /* of waitpid(), with CHILD_ENDED */
    int reason;   /* errno */
    char *output; /* NULL unless it ended; a NUL follows */
    size_t size_bytes;
};

/* Runs the program with the signal handling that this one was started with, and
 * waits for its end. */
enum child_end child_run(const struct child_task *task,
                         struct child_result *result);

#endif
