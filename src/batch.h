// SPDX-License-Identifier: MIT
/*
 * batch.h - renders to a file without a terminal
 *
 * Ownership: the session stays the caller's
 * Threads:   main only
 * Errors:    unwritable output, memory, a failing backend
 */
#ifndef GLIM_BATCH_H
#define GLIM_BATCH_H

#include <stdbool.h>

#include "session/session.h"

/* Renders, shows progress on stderr if that is a terminal, writes the picture
 * and the statistics. *status becomes 0, or 128 + signal after saving the
 * picture so far. */
bool batch_run(struct session *s, int *status, struct error *err);

#endif
