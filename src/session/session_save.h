// SPDX-License-Identifier: MIT
/*
 * session_save.h - writes changed materials, assignments, light and view into
 * the files of a session
 *
 * Threads:   main only
 * Errors:    files that cannot be written, or that another program has changed
 */
#ifndef GLIM_SESSION_SAVE_H
#define GLIM_SESSION_SAVE_H

#include <stdbool.h>

#include "session/session.h"

/* Writes changed materials into their MTL files. If assignments or light have
 * changed, writes them into the view file, whose other values stay. Tells the
 * watch of both. *what is a line about the files, for free(). After an error,
 * files that were already written count as saved. */
bool session_save_edit(struct session *s, struct file_watch *watch, char **what,
                       struct error *err);

/* Makes the view that would be saved now, for view_free(), with the size and
 * the bounces of this run. Materials that objects are given keep their order in
 * the saved view. */
void session_view_to_save(const struct session *s, struct view *view);

/* Writes view and light into the view file. Size and bounces stay those of the
 * file, since the command line sets them for one run. */
bool session_save_view(struct session *s, struct file_change *change,
                       struct error *err);

#endif
