// SPDX-License-Identifier: MIT
/*
 * stop.h - the end of the program by a signal, whatever it is doing
 *
 * A signal asks the program to end. Usually it ends by itself within a few
 * milliseconds. A thread ends it if it has not done so after STOP_MS: while it
 * reads a scene, builds a tree, or waits for a program that takes none of its
 * output. Work on a file holds that end off, so that no picture is lost and no
 * file is half written. A second signal, a second after the first or later,
 * ends such work too.
 *
 * Threads:   any
 * Errors:    stop_begin() fails when no thread can be started
 */
#ifndef GLIM_STOP_H
#define GLIM_STOP_H

#include <stdbool.h>

#include "base/error.h"

/* Time in which the program ends by itself, less than a second in all. */
#define STOP_MS 600

/* Starts the thread, once for the program. */
bool stop_begin(struct error *err);

/* Asks for the end with this exit status. Later calls change nothing, except
 * that an impatient one ends work on files as well, with its own status if the
 * first was 0. Signal handlers that restore errno may call it. */
void stop_request(int status, bool may_be_impatient);

/* Holds the end off until the matching stop_release(). Calls may nest. */
void stop_hold(void);
void stop_release(void);

/* Surround what may take long and is not worth it: a call that waits for
 * another program, such as write() to a pipe, or the build of a tree. Within
 * them the end comes after STOP_MS, also if it is held. */
void stop_allow_begin(void);
void stop_allow_end(void);

/* Registers what the thread calls before it ends the program, the last function
 * first. Other threads still run, and may hold any lock. */
void stop_at_end(void (*last)(void));

/* Registers what the thread calls, once, when a second signal would end the
 * program at once, which goes on with work on files. */
void stop_when_waiting(void (*say)(void));

/* Returns unless those of stop_at_end() are called: whatever fails meanwhile
 * fails because of them, and must not end the program with another status. */
void stop_stay(void);

#endif
