// SPDX-License-Identifier: MIT
#include "base/thread_pool.h"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/machine.h"
#include "base/memory.h"

/* ---- threads ---- */

/* Limit above the number of processors in any kernel configuration. */
#define PROCESSORS_MAX (1 << 16)

int thread_start(pthread_t *thread, void *(*run)(void *), void *argument)
{
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    sigset_t blocked, before;
    int reason;

    sigfillset(&blocked);
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++)
        sigdelset(&blocked, faults[i]);
    pthread_sigmask(SIG_SETMASK, &blocked, &before);
    reason = pthread_create(thread, NULL, run, argument);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return reason;
}

void thread_condition_init(pthread_cond_t *condition)
{
    pthread_condattr_t monotonic;

    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(condition, &monotonic);
    pthread_condattr_destroy(&monotonic);
}

/* Returns the number of processors in the affinity mask, or 1 if unknown. The
 * kernel refuses a mask smaller than its own, so larger ones are tried. */
static int processors_of_affinity(void)
{
    for (int count = CPU_SETSIZE; count <= PROCESSORS_MAX; count *= 2) {
        size_t size_bytes = CPU_ALLOC_SIZE((size_t)count);
        cpu_set_t *set = alloc_array(1, size_bytes);
        int usable = set && sched_getaffinity(0, size_bytes, set) == 0
                         ? CPU_COUNT_S(size_bytes, set)
                         : 0;

        free(set);
        if (usable > 0)
            return usable;
    }
    return 1;
}

int usable_threads(void)
{
    int usable = processors_of_affinity();
    int quota = cgroup_quota_processors("");

    return quota > 0 && quota < usable ? quota : usable;
}

/* ---- pools ---- */

/* Range of items that a worker owns, packed as first << 32 | end: owner and
 * thieves take items by an atomic exchange. Each range has its own cache line
 * to avoid false sharing. */
struct share {
    _Alignas(64) _Atomic uint64_t items;
};

struct worker {
    struct pool *pool;
    int index;
    pthread_t thread;
};

struct pool {
    int thread_count;
    struct worker *workers;
    struct share *shares;

    pthread_mutex_t lock;
    pthread_cond_t begin; /* a job has come or the pool ends */
    pthread_cond_t end;   /* the last worker has parked */
    /* guarded by lock */
    uint64_t job_number;
    int busy_count;
    bool ending;
    /* set before the workers wake */
    pool_job *job;
    void *context;
    const struct cancel *cancel;
};

static uint64_t share_pack(uint32_t first, uint32_t end)
{
    return (uint64_t)first << 32 | end;
}

/* Takes the first item of a worker's range. Returns false if it is empty. */
static bool share_take(struct share *s, uint32_t *item)
{
    uint64_t old = atomic_load(&s->items);

    for (;;) {
        uint32_t first = (uint32_t)(old >> 32);
        uint32_t end = (uint32_t)old;

        if (first >= end)
            return false;
        if (atomic_compare_exchange_weak(&s->items, &old,
                                         share_pack(first + 1, end))) {
            *item = first;
            return true;
        }
    }
}

/* Moves the upper half of the largest range to worker `thief`. Returns false if
 * all ranges are empty. */
static bool share_steal(struct pool *p, int thief)
{
    for (;;) {
        int victim = -1;
        uint32_t most = 0;
        uint64_t seen = 0;

        for (int i = 0; i < p->thread_count; i++) {
            uint64_t items = atomic_load(&p->shares[i].items);
            uint32_t first = (uint32_t)(items >> 32);
            uint32_t end = (uint32_t)items;

            if (first < end && end - first > most) {
                most = end - first;
                victim = i;
                seen = items;
            }
        }
        if (victim < 0)
            return false;

        uint32_t first = (uint32_t)(seen >> 32);
        uint32_t end = (uint32_t)seen;
        uint32_t middle = first + (end - first) / 2;

        if (atomic_compare_exchange_strong(&p->shares[victim].items, &seen,
                                           share_pack(first, middle))) {
            atomic_store(&p->shares[thief].items, share_pack(middle, end));
            return true;
        }
    }
}

static void work(struct pool *p, int index)
{
    uint32_t item;

    do {
        while (!cancel_requested(p->cancel) &&
               share_take(&p->shares[index], &item))
            p->job(p->context, item, index);
    } while (!cancel_requested(p->cancel) && share_steal(p, index));
}

static void *worker_main(void *argument)
{
    struct worker *w = argument;
    struct pool *p = w->pool;
    uint64_t done = 0;

    pthread_mutex_lock(&p->lock);
    for (;;) {
        while (!p->ending && p->job_number == done)
            pthread_cond_wait(&p->begin, &p->lock);
        if (p->ending)
            break;
        done = p->job_number;
        pthread_mutex_unlock(&p->lock);
        work(p, w->index);
        pthread_mutex_lock(&p->lock);
        if (--p->busy_count == 0)
            pthread_cond_signal(&p->end);
    }
    pthread_mutex_unlock(&p->lock);
    return NULL;
}

struct pool *pool_create(int thread_count, struct error *err)
{
    struct pool *p = alloc_array(1, sizeof *p);
    int started = 0;
    int reason = ENOMEM;

    if (p == NULL) {
        fail(err, "threads: out of memory");
        return NULL;
    }
    p->workers = alloc_array((size_t)thread_count, sizeof *p->workers);
    p->shares = aligned_alloc(64, (size_t)thread_count * sizeof *p->shares);
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->begin, NULL);
    pthread_cond_init(&p->end, NULL);
    if (p->workers != NULL && p->shares != NULL) {
        memset(p->shares, 0, (size_t)thread_count * sizeof *p->shares);
        for (; started < thread_count; started++) {
            struct worker *w = &p->workers[started];

            w->pool = p;
            w->index = started;
            reason = thread_start(&w->thread, worker_main, w);
            if (reason != 0)
                break;
        }
    }
    p->thread_count = started;
    if (started == 0) {
        fail(err, "threads: none of %d could be started: %s", thread_count,
             strerror(reason));
        pool_destroy(p);
        return NULL;
    }
    return p;
}

int pool_thread_count(const struct pool *pool)
{
    return pool->thread_count;
}

uint64_t pool_cpu_ns(const struct pool *pool, int worker)
{
    struct timespec used;
    clockid_t clock;

    if (pthread_getcpuclockid(pool->workers[worker].thread, &clock) != 0 ||
        clock_gettime(clock, &used) != 0)
        return 0;
    return (uint64_t)used.tv_sec * UINT64_C(1000000000) +
           (uint64_t)used.tv_nsec;
}

/* Runs all items in the caller's thread. */
static bool run_here(uint32_t count, pool_job *job, void *context,
                     const struct cancel *cancel)
{
    for (uint32_t i = 0; i < count; i++) {
        if (cancel != NULL && cancel_requested(cancel))
            return false;
        job(context, i, 0);
    }
    return true;
}

bool pool_run(struct pool *p, uint32_t count, pool_job *job, void *context,
              const struct cancel *cancel)
{
    uint64_t threads = p != NULL ? (uint64_t)p->thread_count : 0;
    bool is_done = true;

    if (p == NULL)
        return run_here(count, job, context, cancel);
    p->job = job;
    p->context = context;
    p->cancel = cancel;
    for (uint64_t i = 0; i < threads; i++)
        atomic_store(&p->shares[i].items,
                     share_pack((uint32_t)(count * i / threads),
                                (uint32_t)(count * (i + 1) / threads)));
    pthread_mutex_lock(&p->lock);
    p->busy_count = p->thread_count;
    p->job_number++;
    pthread_cond_broadcast(&p->begin);
    while (p->busy_count > 0)
        pthread_cond_wait(&p->end, &p->lock);
    pthread_mutex_unlock(&p->lock);
    for (uint64_t i = 0; i < threads; i++) {
        uint64_t items = atomic_load(&p->shares[i].items);

        is_done = is_done && (uint32_t)(items >> 32) >= (uint32_t)items;
    }
    return is_done;
}

void pool_each(struct pool *p, uint32_t count, pool_job *job, void *context)
{
    const struct cancel never = {0};

    if (p != NULL && count > 1)
        pool_run(p, count, job, context, &never);
    else
        for (uint32_t i = 0; i < count; i++)
            job(context, i, 0);
}

void pool_destroy(struct pool *p)
{
    if (p == NULL)
        return;
    pthread_mutex_lock(&p->lock);
    p->ending = true;
    pthread_cond_broadcast(&p->begin);
    pthread_mutex_unlock(&p->lock);
    for (int i = 0; i < p->thread_count; i++)
        pthread_join(p->workers[i].thread, NULL);
    pthread_cond_destroy(&p->begin);
    pthread_cond_destroy(&p->end);
    pthread_mutex_destroy(&p->lock);
    free(p->shares);
    free(p->workers);
    free(p);
}
