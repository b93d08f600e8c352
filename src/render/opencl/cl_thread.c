// SPDX-License-Identifier: MIT
#include "render/opencl/cl_thread.h"

#include <string.h>

#include "base/clock.h"

#define S_NS UINT64_C(1000000000)

/* Longest time without a sign of the driver: compilers take seconds. */
#define ANSWER_NS (60 * S_NS)

/* The same once somebody waits for a halt, which takes milliseconds, unless the
 * program computes meanwhile, as it does in a compiler. */
#define HALT_NS         (10 * S_NS)
#define COMPUTING_SHARE 0.1

/* Interval in which a cancel is looked for. */
#define LOOK_NS (S_NS / 10)

static void *run(void *context)
{
    struct cl_thread *t = context;

    pthread_mutex_lock(&t->lock);
    for (;;) {
        while (t->work == NULL && !t->is_ending)
            pthread_cond_wait(&t->begin, &t->lock);
        if (t->is_ending)
            break;
        pthread_mutex_unlock(&t->lock);
        t->work(t->context);
        pthread_mutex_lock(&t->lock);
        t->work = NULL;
        if (t->is_left)
            break;
        pthread_cond_signal(&t->end);
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

bool cl_thread_init(struct cl_thread *t, struct error *err)
{
    int reason;

    *t = (struct cl_thread){.work = NULL};
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->begin, NULL);
    thread_condition_init(&t->end);
    reason = thread_start(&t->thread, run, t);
    return reason == 0 ||
           fail(err, "OpenCL: cannot start a thread: %s", strerror(reason));
}

bool cl_thread_run(struct cl_thread *t, void (*work)(void *context),
                   void *context, const struct cancel *cancel)
{
    uint64_t halt_ns = 0, computed_ns = 0, now_ns;
    bool is_left;

    pthread_mutex_lock(&t->lock);
    if (!t->is_left) {
        t->work = work;
        t->context = context;
        t->beat_ns = clock_ns();
        pthread_cond_signal(&t->begin);
    }
    while (!t->is_left && t->work != NULL) {
        struct timespec until = clock_time_after(LOOK_NS);

        pthread_cond_timedwait(&t->end, &t->lock, &until);
        now_ns = clock_ns();
        if (halt_ns == 0 && cancel != NULL && cancel_requested(cancel)) {
            halt_ns = now_ns + HALT_NS;
            computed_ns = clock_cpu_ns();
        }
        t->is_left = t->work != NULL && now_ns > t->beat_ns + ANSWER_NS;
        if (t->work != NULL && halt_ns != 0 && now_ns > halt_ns &&
            now_ns > t->beat_ns + HALT_NS) {
            if (clock_cpu_ns() - computed_ns < HALT_NS * COMPUTING_SHARE)
                t->is_left = true;
            halt_ns = now_ns + HALT_NS;
            computed_ns = clock_cpu_ns();
        }
        if (t->is_left)
            pthread_detach(t->thread);
    }
    is_left = t->is_left;
    pthread_mutex_unlock(&t->lock);
    return !is_left;
}

bool cl_thread_beat(struct cl_thread *t)
{
    bool is_left;

    pthread_mutex_lock(&t->lock);
    t->beat_ns = clock_ns();
    is_left = t->is_left;
    pthread_mutex_unlock(&t->lock);
    return !is_left;
}

bool cl_thread_is_left(struct cl_thread *t)
{
    bool is_left;

    pthread_mutex_lock(&t->lock);
    is_left = t->is_left;
    pthread_mutex_unlock(&t->lock);
    return is_left;
}

void cl_thread_end(struct cl_thread *t)
{
    pthread_mutex_lock(&t->lock);
    t->is_ending = true;
    pthread_cond_signal(&t->begin);
    pthread_mutex_unlock(&t->lock);
    pthread_join(t->thread, NULL);
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->begin);
    pthread_cond_destroy(&t->end);
}
