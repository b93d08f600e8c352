// SPDX-License-Identifier: MIT
/*
 * render_rates.h - samples a second over the time of a render, and how busy the
 * threads of its backend are
 *
 * A few spans of equal length cover the whole time: when they are used up, each
 * two become one of double length.
 *
 * Units:     nanoseconds of rendering, samples of all pixels together; a share
 *            of 1 is a processor all the time
 * Ownership: thread_load_free() frees; zeroed structs have seen nothing yet
 * Threads:   one at a time; the backend may render
 * Errors:    threads of a device are not known, nor any when memory is out
 */
#ifndef GLIM_RENDER_RATES_H
#define GLIM_RENDER_RATES_H

#include <stdint.h>

#include "render/backend.h"

/* ---- speeds ---- */

/* Two a column of a small diagram. Even. */
#define SPEEDS_MAX 72

struct speeds {
    double samples[SPEEDS_MAX]; /* of each span */
    int count;                  /* the last one may have just begun */
    uint64_t span_ns;
    uint64_t time_ns; /* of the last look */
    uint64_t sample_count;
};

/* So many samples are there after so much time: what has come since the last
 * look belongs to the time since then, evenly. Begins anew where either is less
 * than before. */
void speeds_look(struct speeds *s, uint64_t time_ns, uint64_t sample_count);

/* Samples a second in span i below count. */
double speeds_at(const struct speeds *s, int i);

/* ---- threads ---- */

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
