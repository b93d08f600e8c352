// SPDX-License-Identifier: MIT
/*
 * progress.h - how far a render is: the time that is left, its rates, and its
 * errors so far
 *
 * Units:     nanoseconds or seconds of rendering, samples of all pixels
 *            together; a load of 1 is one processor all the time
 * Ownership: thread_load_free() frees; zeroed structs are empty
 * Threads:   one at a time; the backend may render
 * Errors:    loads are 0 for the threads of a device, and when memory is out
 */
#ifndef GLIM_PROGRESS_H
#define GLIM_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"
#include "render/render_loop.h"

/* ---- what is left ---- */

struct render_left {
    /* the limit that is reached, or the nearest one; none without limits, or
     * while the time to none of them is known */
    enum render_limit limit;
    double ns;
    double part; /* part of the way to that limit, 0 to 1 */
};

struct render_left render_left(const struct render_progress *p);

/* Finds the time until the upper end of the error is at the target. Returns
 * false while the error is unknown or unresolved. */
bool render_left_to_error(const struct render_progress *p, double target,
                          double *ns);

/*
 * A fixed number of spans of equal length covers the whole time. When they are
 * used up, pairs are merged into spans of double length.
 */

/* ---- speeds ---- */

/* Greatest number of spans, which is even. */
#define SPEEDS_MAX 72

struct speeds {
    double samples[SPEEDS_MAX]; /* samples of each span */
    int count;                  /* spans so far; the last one is incomplete */
    uint64_t span_ns;
    uint64_t time_ns; /* time of the last update */
    uint64_t sample_count;
};

/* Adds a measurement: the number of samples after `time_ns`. The samples since
 * the last measurement are distributed evenly over the time since then. Begins
 * anew if the time or the number is less than before. */
void speeds_update(struct speeds *s, uint64_t time_ns, uint64_t sample_count);

/* Returns the samples per second in span i, which is below count. */
double speeds_at(const struct speeds *s, int i);

/* ---- threads ---- */

struct thread_load {
    /* processor time of each thread at the last thread_load_begin() */
    uint64_t *cpu_ns;
    int count; /* 0 if a device renders */
};

/* Begins a measurement of the backend's threads. */
void thread_load_begin(struct thread_load *l, const struct backend *b);

/* Returns the load of a thread, 0 to 1, since thread_load_begin(), which was
 * `time_ns` ago. */
double thread_load_share(const struct thread_load *l, const struct backend *b,
                         int thread, uint64_t time_ns);

void thread_load_free(struct thread_load *l);

/* ---- ranks ---- */

/* Returns the samples of a rank in each second in which it had work. */
double rank_rate(const struct rank_progress *p);

/* Returns true if a rank has been silent for much longer than it usually is. */
bool rank_is_late(const struct rank_progress *p);

/* ---- errors so far ---- */

/* Times grow by a tenth at least, so that this is enough for a year. */
#define ERROR_HISTORY_MAX 256

struct error_history {
    struct error_then {
        double time_s, error;
    } points[ERROR_HISTORY_MAX];
    int count;
};

/* Adds the present error, if it is known and the time has grown enough. Begins
 * anew if the time is less than before. */
void error_history_update(struct error_history *history,
                          const struct render_progress *progress);

#endif
