// SPDX-License-Identifier: MIT
#include "base/thread.h"

#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

#include "base/cgroup_quota.h"
#include "base/memory.h"

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
