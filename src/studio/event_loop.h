// SPDX-License-Identifier: MIT
/*
 * event_loop.h - the screen: live picture, status line, keys, help
 *
 * Units:     terminal cells
 * Ownership: the session stays the caller's
 * Threads:   main only; alone may include curses
 * Errors:    by the text when no terminal can be opened
 */
#ifndef GLIM_EVENT_LOOP_H
#define GLIM_EVENT_LOOP_H

#include <stdbool.h>

#include "session/session.h"

/* Runs until the person quits or a signal comes. `lost` is the picture of a
 * lost session to tell of, or NULL. *status becomes the exit status; false only
 * if the screen could not be opened. */
bool event_loop_run(struct session *s, const char *lost, int *status,
                    struct error *err);

#endif
