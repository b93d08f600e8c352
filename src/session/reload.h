// SPDX-License-Identifier: MIT
/*
 * reload.h - loads the files of a session again, in a thread of its own, while
 * the session continues to render
 *
 * Ownership: reload_end() returns a session, which the caller closes;
 *            reload_free() waits for a load in progress
 * Threads:   all functions from one thread
 * Errors:    reload_end() returns those of the load, which name the file
 */
#ifndef GLIM_RELOAD_H
#define GLIM_RELOAD_H

#include <stdbool.h>

#include "base/background.h"
#include "session/session.h"

struct reload {
    struct background loading;
    const struct options *options;
    /* owned by the thread until reload_end() joins it */
    struct session fresh;
    bool is_loaded;
    struct error error;
};

bool reload_init(struct reload *r, const struct options *options,
                 struct error *err);

/* Starts a load. Returns false if one is in progress or no thread can start. */
bool reload_begin(struct reload *r, struct error *err);

/* Waits for the load. *fresh is for session_take_loaded() and then
 * session_close(), also after an error. */
bool reload_end(struct reload *r, struct session *fresh, struct error *err);

void reload_free(struct reload *r);

#endif
