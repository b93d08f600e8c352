// SPDX-License-Identifier: MIT
#include "render/cluster/band_thread.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/thread_pool.h"

struct band_thread {
    pthread_t thread;
    bool is_busy; /* the owner's */
    pthread_mutex_t lock;
    pthread_cond_t begin, done;
    /* guarded by lock */
    bool has_work, is_done, is_ending;
    struct band_work work;
    enum pass_result result;
    struct error error;
};

static void *run(void *argument)
{
    struct band_thread *t = argument;

    pthread_mutex_lock(&t->lock);
    for (;;) {
        struct band_work w;
        enum pass_result result;
        struct error err = {""};

        while (!t->has_work && !t->is_ending)
            pthread_cond_wait(&t->begin, &t->lock);
        if (!t->has_work)
            break;
        t->has_work = false;
        w = t->work;
        pthread_mutex_unlock(&t->lock);
        result = band_render(w.band, w.backend, &w.whole, w.first_sample,
                             w.cancel, &err);
        pthread_mutex_lock(&t->lock);
        t->result = result;
        t->error = err;
        t->is_done = true;
        pthread_cond_signal(&t->done);
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

struct band_thread *band_thread_create(struct error *err)
{
    struct band_thread *t = alloc_array(1, sizeof *t);
    int reason;

    if (t == NULL) {
        fail(err, "out of memory for a thread");
        return NULL;
    }
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->begin, NULL);
    thread_condition_init(&t->done);
    reason = thread_start(&t->thread, run, t);
    if (reason == 0)
        return t;
    fail(err, "cannot start a thread: %s", strerror(reason));
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->begin);
    pthread_cond_destroy(&t->done);
    free(t);
    return NULL;
}

void band_thread_begin(struct band_thread *t, const struct band_work *work)
{
    pthread_mutex_lock(&t->lock);
    t->work = *work;
    t->has_work = true;
    t->is_busy = true;
    pthread_cond_signal(&t->begin);
    pthread_mutex_unlock(&t->lock);
}

struct band *band_thread_end(struct band_thread *t, enum pass_result *result,
                             struct error *err)
{
    struct band *band = NULL;

    pthread_mutex_lock(&t->lock);
    if (t->is_done) {
        band = t->work.band;
        *result = t->result;
        if (t->result == PASS_FAILED)
            *err = t->error;
        t->is_done = false;
        t->is_busy = false;
    }
    pthread_mutex_unlock(&t->lock);
    return band;
}

bool band_thread_is_busy(const struct band_thread *t)
{
    return t->is_busy;
}

void band_thread_wait(struct band_thread *t, long timeout_ns)
{
    struct timespec until = clock_time_after(timeout_ns);
    int reason = 0;

    pthread_mutex_lock(&t->lock);
    while (!t->is_done && reason == 0)
        reason = pthread_cond_timedwait(&t->done, &t->lock, &until);
    pthread_mutex_unlock(&t->lock);
}

void band_thread_destroy(struct band_thread *t)
{
    if (t == NULL)
        return;
    pthread_mutex_lock(&t->lock);
    t->is_ending = true;
    pthread_cond_signal(&t->begin);
    pthread_mutex_unlock(&t->lock);
    pthread_join(t->thread, NULL);
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->begin);
    pthread_cond_destroy(&t->done);
    free(t);
}
