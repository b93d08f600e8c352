// SPDX-License-Identifier: MIT
#include "base/stop.h"

#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/min_max.h"
#include "base/thread_pool.h"

#define MS_NS UINT64_C(1000000)

/* Interval in which the thread looks. */
#define LOOK_NS (20 * MS_NS)

/* A shell or a user may send several signals at once, and one of them counts.
 */
#define AGAIN_NS (1000 * MS_NS)

/* Functions that stop_at_end() keeps. */
#define LASTS_MAX 4

static sem_t asked;
static atomic_int asked_status;
static _Atomic uint64_t asked_ns; /* 0: never */
static atomic_bool is_impatient;
static atomic_bool is_ending;

static atomic_int holds, allows;
static _Atomic uint64_t allow_ns, release_ns; /* the latest of each */

static void (*_Atomic lasts[LASTS_MAX])(void);
static atomic_int last_count;

static void (*_Atomic wait_said)(void); /* may be NULL */

/* Returns true if the program has had its time to end by itself. */
static bool is_over(void)
{
    bool is_held = atomic_load(&holds) > 0;
    uint64_t since_ns =
        u64_max(atomic_load(&asked_ns),
                is_held ? atomic_load(&allow_ns) : atomic_load(&release_ns));

    if (atomic_load(&is_impatient))
        return true;
    if (is_held && atomic_load(&allows) == 0)
        return false;
    return clock_ns() >= since_ns + STOP_MS * MS_NS;
}

/* Says once that the end is held for long. */
static void say_wait(void)
{
    void (*say)(void) = atomic_load(&wait_said);

    if (say == NULL || clock_ns() < atomic_load(&asked_ns) + AGAIN_NS)
        return;
    atomic_store(&wait_said, NULL);
    say();
}

static void *watch(void *unused)
{
    const struct timespec look = {.tv_nsec = LOOK_NS};

    while (sem_wait(&asked) != 0)
        continue; /* interrupted */
    while (!is_over()) {
        nanosleep(&look, NULL);
        say_wait();
    }
    atomic_store(&is_ending, true);
    for (int i = atomic_load(&last_count); i-- > 0;)
        atomic_load (&lasts[i])();
    _exit(atomic_load(&asked_status));
    return unused;
}

bool stop_begin(struct error *err)
{
    static bool is_begun;
    pthread_t thread;
    int reason = 0;

    if (is_begun)
        return true;
    sem_init(&asked, 0, 0);
    reason = thread_start(&thread, watch, NULL);
    is_begun = reason == 0;
    if (is_begun)
        pthread_detach(thread);
    return is_begun ||
           fail(err, "signals: cannot start a thread: %s", strerror(reason));
}

void stop_request(int status, bool may_be_impatient)
{
    uint64_t first_ns = 0, now_ns = clock_ns();

    if (atomic_compare_exchange_strong(&asked_ns, &first_ns, now_ns)) {
        atomic_store(&asked_status, status);
        sem_post(&asked);
    } else if (may_be_impatient && now_ns - first_ns >= AGAIN_NS) {
        int done = 0;

        atomic_compare_exchange_strong(&asked_status, &done, status);
        atomic_store(&is_impatient, true);
    }
}

void stop_hold(void)
{
    atomic_fetch_add(&holds, 1);
}

void stop_release(void)
{
    atomic_store(&release_ns, clock_ns());
    atomic_fetch_sub(&holds, 1);
}

void stop_allow_begin(void)
{
    atomic_store(&allow_ns, clock_ns());
    atomic_fetch_add(&allows, 1);
}

void stop_allow_end(void)
{
    atomic_fetch_sub(&allows, 1);
}

void stop_at_end(void (*last)(void))
{
    int i = atomic_fetch_add(&last_count, 1);

    if (i < LASTS_MAX)
        atomic_store(&lasts[i], last);
    else
        atomic_fetch_sub(&last_count, 1);
}

void stop_when_waiting(void (*say)(void))
{
    atomic_store(&wait_said, say);
}

void stop_stay(void)
{
    while (atomic_load(&is_ending))
        pause();
}
