// SPDX-License-Identifier: MIT
/*
 * tty_events.h - the events of the terminal's input, with the times after which
 * an incomplete sequence is taken as it is
 *
 * Units:     nanoseconds of clock_ns()
 * Threads:   main only
 */
#ifndef GLIM_TTY_EVENTS_H
#define GLIM_TTY_EVENTS_H

#include <stdint.h>

#include "terminal/tty_input.h"

struct tty_events {
    struct tty_input input;
    uint64_t byte_ns;  /* time of the last byte of input */
    uint64_t paste_ns; /* time of the last character of pasted text */
};

/* Takes an event. Returns false if no others are wanted. */
typedef bool tty_take_event(void *context, const struct event *event);

/* Reads all input that waits, for a frame's time at most, and takes its events.
 * Returns false if the terminal is gone. */
bool tty_events_read(struct tty_events *e, tty_take_event *take, void *context);

/* Takes what is incomplete if its time is over. */
void tty_events_expire(struct tty_events *e, tty_take_event *take,
                       void *context);

/* When that time is over; UINT64_MAX if nothing is incomplete. */
uint64_t tty_events_deadline_ns(const struct tty_events *e);

#endif
