// SPDX-License-Identifier: MIT
/*
 * session_save.h - writes what was changed of a session into its files
 *
 * Ownership: the session stays the caller's
 * Threads:   main only
 * Errors:    files that cannot be written; those of another's at the same time
 */
#ifndef GLIM_SESSION_SAVE_H
#define GLIM_SESSION_SAVE_H

#include <stdbool.h>

#include "session/session.h"

/* Writes changed materials into their MTL files, and if assignments or light
 * have changed, these into the view file, the rest of which stays. The watch is
 * told of it. *what is a line about it, for free(). What was written before an
 * error is saved. */
bool session_save_edit(struct session *s, struct file_watch *watch, char **what,
                       struct error *err);

/* Writes view and light into the view file. What the command line says of this
 * run, size and bounces, is not written: the file keeps its own. */
bool session_save_view(struct session *s, struct file_change *change,
                       struct error *err);

#endif
