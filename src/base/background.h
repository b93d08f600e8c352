// SPDX-License-Identifier: MIT
/*
 * background.h - work in a background thread, of which a descriptor tells the
 * event loop when it is complete
 *
 * The work may first copy data that the main thread changes afterwards.
 *
 * Ownership: background_free() frees; no work is in progress then
 * Threads:   all functions from one thread, except background_has_copied(),
 *            which the work calls
 * Errors:    background_init() and background_begin() fail for the system's
 *            reasons
 */
#ifndef GLIM_BACKGROUND_H
#define GLIM_BACKGROUND_H

#include <pthread.h>
#include <stdbool.h>

#include "base/error.h"

struct background {
    int event_fd; /* readable when the work is complete */
    bool is_busy; /* between background_begin() and background_finish() */
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
bool background_init(struct background *b, const char *whose,
                     struct error *err);

/* Starts work(context). `what` begins the message. */
bool background_begin(struct background *b, void (*work)(void *context),
                      void *context, const char *what, struct error *err);

/* Says that the work needs no more than its copy. */
void background_has_copied(struct background *b);

/* Blocks until the work in progress, if any, has its copy. */
void background_wait_copied(struct background *b);

/* Blocks until the work is complete. */
void background_finish(struct background *b);

void background_free(struct background *b);

#endif
