// SPDX-License-Identifier: MIT
/*
 * copy_thread.h - a background thread that first copies data which the main
 * thread may change afterwards, and then works with the copy
 *
 * Ownership: copy_thread_free() frees; no work is in progress then
 * Threads:   all functions from one thread, except copy_thread_has_copied(),
 *            which the work calls
 * Errors:    copy_thread_init() and copy_thread_begin() fail for the system's
 *            reasons
 */
#ifndef GLIM_COPY_THREAD_H
#define GLIM_COPY_THREAD_H

#include <pthread.h>
#include <stdbool.h>

#include "base/error.h"

struct copy_thread {
    int event_fd; /* readable when the work is complete */
    bool is_busy; /* between copy_thread_begin() and copy_thread_finish() */
    pthread_t thread;
    /* set before the thread starts */
    void (*work)(void *context);
    void *context;
    /* guarded by lock */
    pthread_mutex_t lock;
    pthread_cond_t copied;
    bool has_copied;
};

/* `whose` is for messages. */
bool copy_thread_init(struct copy_thread *t, const char *whose,
                      struct error *err);

/* Starts work(context), which calls copy_thread_has_copied(). `what` is for
 * the message. */
bool copy_thread_begin(struct copy_thread *t, void (*work)(void *context),
                       void *context, const char *what, struct error *err);

/* Says that the work needs no more than its copy. */
void copy_thread_has_copied(struct copy_thread *t);

/* Blocks until the work in progress, if any, has its copy. */
void copy_thread_wait_copied(struct copy_thread *t);

/* Blocks until the work is complete. */
void copy_thread_finish(struct copy_thread *t);

void copy_thread_free(struct copy_thread *t);

#endif
