// SPDX-License-Identifier: MIT
/*
 * clock.h - monotonic time, for measuring
 *
 * Units:     nanoseconds
 * Threads:   any
 */
#ifndef GLIM_CLOCK_H
#define GLIM_CLOCK_H

#include <stdint.h>

/* Reads the monotonic clock. */
uint64_t clock_ns(void);

/* Seconds between two readings of clock_ns(). */
double seconds_between(uint64_t begin_ns, uint64_t end_ns);

#endif
