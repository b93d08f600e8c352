// SPDX-License-Identifier: MIT
/*
 * import_child.h - reads a scene with libassimp, in a copy of the program, and
 * sends it as import_stream.h says
 *
 * Threads:   one
 * Errors:    those of libassimp, sent as a line; the limits end the process by
 *            a signal
 */
#ifndef GLIM_IMPORT_CHILD_H
#define GLIM_IMPORT_CHILD_H

#include <stdbool.h>
#include <stdio.h>

#include "base/library_child.h"

/* Sends the scene of the file, or returns false and sends the message. */
bool import_child(const char *path, struct library_limits limits, FILE *to);

#endif
