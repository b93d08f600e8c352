// SPDX-License-Identifier: MIT
/*
 * render_rates.h - how busy the threads of a backend are: processor time over
 * time
 *
 * Units:     nanoseconds; a share of 1 is a processor all the time
 * Ownership: thread_load_free() frees; a zeroed struct knows no thread
 * Threads:   one at a time; the backend may render
 * Errors:    threads of a device are not known, nor any when memory is out
 */
#ifndef GLIM_RENDER_RATES_H
#define GLIM_RENDER_RATES_H

#include <stdint.h>

#include "render/backend.h"

struct thread_load {
    uint64_t *cpu_ns; /* of each thread at the last thread_load_begin() */
    int count;        /* 0: a device renders */
};

/* Begins to measure this backend's threads. */
void thread_load_begin(struct thread_load *l, const struct backend *b);

/* What a thread has used since thread_load_begin() of `time_ns`; 0 to 1. */
double thread_load_share(const struct thread_load *l, const struct backend *b,
                         int thread, uint64_t time_ns);

void thread_load_free(struct thread_load *l);

#endif
