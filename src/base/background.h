// SPDX-License-Identifier: MIT
/*
 * background.h - work in a background thread, and descriptors with which
 * threads and signal handlers wake an event loop
 *
 * Ownership: background_free() frees, when no work is in progress; a descriptor
 *            is the caller's to close()
 * Threads:   descriptors any; all functions of a background from one thread,
 *            except background_has_copied(), which the work calls
 * Errors:    the system's reasons for no thread and no descriptor
 */
#ifndef GLIM_BACKGROUND_H
#define GLIM_BACKGROUND_H

#include <pthread.h>
#include <stdbool.h>

#include "base/error.h"

/* ---- descriptors ---- */

/* Returns the descriptor, or -1 and a message that begins with `whose`. */
int event_fd_open(const char *whose, struct error *err);

/* Makes the descriptor readable until event_fd_clear(). Signal handlers that
 * restore errno may call it. */
void event_fd_set(int fd);
void event_fd_clear(int fd);

/* ---- work ---- */

/*
 * The work may first copy data that the main thread changes afterwards.
 */

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
