// SPDX-License-Identifier: MIT
/*
 * clock.h - monotonic time and processor time, for measuring
 *
 * Units:     nanoseconds
 * Threads:   any
 */
#ifndef GLIM_CLOCK_H
#define GLIM_CLOCK_H

#include <stdint.h>
#include <sys/types.h>
#include <time.h>

/* Reads the monotonic clock. */
uint64_t clock_ns(void);

/* Returns the time of the monotonic clock so many nanoseconds from now. */
struct timespec clock_time_after(int64_t ns);

/* Reads the processor time of the process, of all threads together, which other
 * programs hardly disturb. */
uint64_t clock_cpu_ns(void);

/* Returns the processor time of another process, 0 if it is not known. */
uint64_t clock_process_ns(pid_t process);

/* Seconds between two readings of the same clock. */
double seconds_between(uint64_t begin_ns, uint64_t end_ns);

#endif
