// SPDX-License-Identifier: MIT
/*
 * spent.h - time by the clock and by the processor
 *
 * Units:     seconds
 * Threads:   any; processor time is the sum of all threads
 */
#ifndef RAYS_SPENT_H
#define RAYS_SPENT_H

#include <time.h>

struct spent {
    double s, cpu_s;
};

static inline double spent_read(clockid_t clock)
{
    struct timespec t;

    clock_gettime(clock, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static inline struct spent spent_now(void)
{
    return (struct spent){spent_read(CLOCK_MONOTONIC),
                          spent_read(CLOCK_PROCESS_CPUTIME_ID)};
}

static inline struct spent spent_since(struct spent begin)
{
    struct spent now = spent_now();

    return (struct spent){now.s - begin.s, now.cpu_s - begin.cpu_s};
}

#endif
