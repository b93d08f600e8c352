// SPDX-License-Identifier: MIT
/*
 * cl_thread.h - a thread for the calls of a driver, which may never return
 *
 * A driver whose device hangs does not return from a call, or its commands
 * never end. Whoever waits for the thread leaves it alone then.
 *
 * Ownership: a thread that was left keeps its context, and ends by itself if
 *            the driver ever returns
 * Threads:   cl_thread_run() from one thread at a time; the rest from any
 * Errors:    those of pthread_create(); a driver that does not answer
 */
#ifndef GLIM_CL_THREAD_H
#define GLIM_CL_THREAD_H

#include <stdatomic.h>
#include <stdbool.h>

#include "base/error.h"
#include "base/thread_pool.h"

struct cl_thread {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t begin, end;
    /* guarded by lock */
    void (*work)(void *context); /* NULL: none */
    void *context;
    bool is_ending;
    bool is_left;
    uint64_t beat_ns; /* time of the last sign of the driver */
};

bool cl_thread_init(struct cl_thread *t, struct error *err);

/* Runs work(context) on the thread. Returns false if the driver shows no sign
 * for a minute, or for ten seconds after a cancel, which may be NULL, in which
 * the program does not compute either: then the thread is left, and later calls
 * return false at once. */
bool cl_thread_run(struct cl_thread *t, void (*work)(void *context),
                   void *context, const struct cancel *cancel);

/* Notes a sign of the driver: a call that has returned, or a command that has
 * ended. Returns false if the thread was left: then its memory is no longer
 * what it was, and the work ends at once. */
bool cl_thread_beat(struct cl_thread *t);

/* Returns true if the thread was left. */
bool cl_thread_is_left(struct cl_thread *t);

/* Ends the thread, which was not left. */
void cl_thread_end(struct cl_thread *t);

#endif
