// SPDX-License-Identifier: MIT
/*
 * batch.h - renders to a file without a terminal
 *
 * Units:     none
 * Ownership: the session stays the caller's
 * Threads:   main only
 * Errors:    by the result: an exit status
 */
#ifndef GLIM_BATCH_H
#define GLIM_BATCH_H

#include "glim/session.h"

/* Renders, shows progress on stderr if that is a terminal, writes the picture
 * and the statistics. 0, 1, or 128 + signal after saving the picture so far. */
int batch_run(struct session *s);

#endif
