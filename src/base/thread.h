// SPDX-License-Identifier: MIT
/*
 * thread.h - starts threads with signals blocked, and finds how many to start
 *
 * Ownership: the thread is the caller's to join
 * Threads:   any
 * Errors:    those of pthread_create()
 */
#ifndef GLIM_THREAD_H
#define GLIM_THREAD_H

#include <pthread.h>

/* Starts run(argument) with signals blocked: a worker that took SIGWINCH would
 * leave the main thread waiting for a key. Fault signals stay open, for the
 * handler that restores the terminal. Returns 0 or an error number. */
int thread_start(pthread_t *thread, void *(*run)(void *), void *argument);

/* Initialises a condition whose timed waits end by the monotonic clock, as
 * clock_time_after() gives it. */
void thread_condition_init(pthread_cond_t *condition);

/* Returns the number of threads that this process may run at once, at least 1,
 * by its affinity mask and the quota of its control group. */
int usable_threads(void);

#endif
