// SPDX-License-Identifier: MIT
/*
 * thread_pool.h - threads with signals blocked, worker threads and cancellation
 *
 * A pool runs one job at a time: a function over the numbers 0..count-1. Each
 * worker owns a range of them and steals half of another's when its own is
 * done.
 *
 * Ownership: a started thread is the caller's to join; pool_create() returns a
 *            pool for pool_destroy(); a job's context stays the caller's and
 *            must outlive pool_run()
 * Threads:   pool_run() from one thread at a time; the rest from any
 * Errors:    those of pthread_create(); pool_create() fails when no thread can
 *            start; nothing else fails
 */
#ifndef GLIM_THREAD_POOL_H
#define GLIM_THREAD_POOL_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/clock.h"
#include "base/error.h"

/* ---- threads ---- */

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

/* ---- pools ---- */

/* Request to stop, at once or at a time. OpenCL kernels read `requested` as one
 * 32-bit word. */
struct cancel {
    atomic_uint requested;
    /* set while no job runs: clock_ns() at which a stop is requested; 0: never
     */
    uint64_t deadline_ns;
    /* asked from the deadline on whether a stop is requested; NULL: it is */
    bool (*is_due)(void);
};

static inline void cancel_request(struct cancel *c)
{
    atomic_store_explicit(&c->requested, 1, memory_order_release);
}

static inline void cancel_reset(struct cancel *c)
{
    atomic_store_explicit(&c->requested, 0, memory_order_relaxed);
}

/* True if a stop is requested at once, not at a time. */
static inline bool cancel_requested_at_once(const struct cancel *c)
{
    return atomic_load_explicit(&c->requested, memory_order_relaxed) != 0;
}

static inline bool cancel_requested(const struct cancel *c)
{
    return cancel_requested_at_once(c) ||
           (c->deadline_ns != 0 && clock_ns() >= c->deadline_ns &&
            (!c->is_due || c->is_due()));
}

typedef void pool_job(void *context, uint32_t item, int worker);

struct pool;

/* Starts thread_count workers with all signals blocked. */
struct pool *pool_create(int thread_count, struct error *err);
int pool_thread_count(const struct pool *pool);

/* Returns the processor time that a worker has used so far, in nanoseconds. */
uint64_t pool_cpu_ns(const struct pool *pool, int worker);

/* Runs job(context, i, worker) for all i below count, and returns when every
 * worker is parked. After a request to cancel no further item is started.
 * Returns true if all items were run. Without a pool it runs in the caller's
 * thread as worker 0. */
bool pool_run(struct pool *pool, uint32_t count, pool_job *job, void *context,
              const struct cancel *cancel);

/* Runs all items without cancellation. Without a pool, or for a single item, it
 * runs in the caller's thread as worker 0. */
void pool_each(struct pool *pool, uint32_t count, pool_job *job, void *context);

void pool_destroy(struct pool *pool);

#endif
