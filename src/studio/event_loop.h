// SPDX-License-Identifier: MIT
/*
 * event_loop.h - the loop of the interactive program: it waits for keys,
 * signals and the render, and draws
 *
 * Ownership: the session stays the caller's
 * Threads:   main only
 */
#ifndef GLIM_EVENT_LOOP_H
#define GLIM_EVENT_LOOP_H

#include <stdbool.h>

#include "session/session.h"

/* Runs until the person quits or a signal ends the program. *status becomes the
 * exit status. Returns false if the screen cannot be opened, or the file of
 * --stats cannot be written. */
bool event_loop_run(struct session *s, int *status, struct error *err);

#endif
