// SPDX-License-Identifier: MIT
/*
 * studio.h - the interactive program: its parts, the commands of actions,
 * questions in the last line, and the event loop
 *
 * Threads:   main only
 */
#ifndef GLIM_STUDIO_H
#define GLIM_STUDIO_H

#include <stdbool.h>

#include "session/session.h"

/* Runs until the person quits or a signal ends the program. *status becomes the
 * exit status. Returns false if the screen cannot be opened, or the file of
 * --stats cannot be written. */
bool studio_loop(struct session *s, int *status, struct error *err);

#endif
