// SPDX-License-Identifier: MIT
#include "session/copy_thread.h"

#include <string.h>
#include <unistd.h>

#include "base/event_fd.h"
#include "base/stop.h"
#include "base/thread_pool.h"

bool copy_thread_init(struct copy_thread *t, const char *whose,
                      struct error *err)
{
    *t = (struct copy_thread){.event_fd = event_fd_open(whose, err)};
    if (t->event_fd < 0)
        return false;
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->copied, NULL);
    return true;
}

static void *run(void *argument)
{
    struct copy_thread *t = argument;

    stop_hold();
    t->work(t->context);
    stop_release();
    event_fd_set(t->event_fd);
    return NULL;
}

bool copy_thread_begin(struct copy_thread *t, void (*work)(void *context),
                       void *context, const char *what, struct error *err)
{
    int reason;

    t->work = work;
    t->context = context;
    t->has_copied = false;
    reason = thread_start(&t->thread, run, t);
    t->is_busy = reason == 0;
    return t->is_busy || fail(err, "%s: cannot start a thread to save it: %s",
                              what, strerror(reason));
}

void copy_thread_has_copied(struct copy_thread *t)
{
    pthread_mutex_lock(&t->lock);
    t->has_copied = true;
    pthread_cond_signal(&t->copied);
    pthread_mutex_unlock(&t->lock);
}

void copy_thread_wait_copied(struct copy_thread *t)
{
    if (!t->is_busy)
        return;
    pthread_mutex_lock(&t->lock);
    while (!t->has_copied)
        pthread_cond_wait(&t->copied, &t->lock);
    pthread_mutex_unlock(&t->lock);
}

void copy_thread_finish(struct copy_thread *t)
{
    pthread_join(t->thread, NULL);
    t->is_busy = false;
    event_fd_clear(t->event_fd);
}

void copy_thread_free(struct copy_thread *t)
{
    pthread_cond_destroy(&t->copied);
    pthread_mutex_destroy(&t->lock);
    close(t->event_fd);
}
