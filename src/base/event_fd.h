// SPDX-License-Identifier: MIT
/*
 * event_fd.h - descriptor with which a thread or a signal handler wakes poll()
 *
 * Ownership: the descriptor is the caller's to close()
 * Threads:   any
 * Errors:    event_fd_open() fails when no descriptor is left
 */
#ifndef GLIM_EVENT_FD_H
#define GLIM_EVENT_FD_H

#include "base/error.h"

/* Returns the descriptor, or -1 and a message that begins with `whose`. */
int event_fd_open(const char *whose, struct error *err);

/* Makes the descriptor readable until event_fd_clear(). Signal handlers that
 * restore errno may call it. */
void event_fd_set(int fd);
void event_fd_clear(int fd);

#endif
