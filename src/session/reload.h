// SPDX-License-Identifier: MIT
/*
 * reload.h - loads the files of a session anew, in a thread of its own, while
 * the session renders on
 *
 * Ownership: reload_end() hands what was loaded over; reload_free() waits for
 *            a load that is on its way
 * Threads:   all functions from one thread
 * Errors:    with the result: what is wrong with which file
 */
#ifndef GLIM_RELOAD_H
#define GLIM_RELOAD_H

#include <pthread.h>
#include <stdbool.h>

#include "session/session.h"

struct reload {
    int event_fd; /* readable when it is done */
    bool is_busy; /* between reload_begin() and reload_end() */
    pthread_t thread;
    const struct options *options;
    /* the thread's until reload_end() joins it */
    struct session fresh;
    bool is_loaded;
    struct error error;
};

bool reload_init(struct reload *r, const struct options *options,
                 struct error *err);

/* False if a load is on its way, or no thread can start. */
bool reload_begin(struct reload *r, struct error *err);

/* Waits for the load. *fresh is for session_take_loaded() and session_close(),
 * also after an error. */
bool reload_end(struct reload *r, struct session *fresh, struct error *err);

void reload_free(struct reload *r);

#endif
