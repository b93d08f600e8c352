// SPDX-License-Identifier: MIT
/*
 * event_fd.h - a descriptor by which a thread or a signal's handler tells a
 * poll() that something is done
 *
 * Ownership: the descriptor is the caller's to close()
 * Threads:   any
 * Errors:    event_fd_open() fails when no descriptor is left
 */
#ifndef GLIM_EVENT_FD_H
#define GLIM_EVENT_FD_H

#include "base/error.h"

/* -1: none; the text begins with `whose`. */
int event_fd_open(const char *whose, struct error *err);

/* Makes it readable until event_fd_clear(). Handlers may, if they put errno
 * back. */
void event_fd_set(int fd);
void event_fd_clear(int fd);

#endif
