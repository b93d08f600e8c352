// SPDX-License-Identifier: MIT
#include "base/background.h"

#include <errno.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "base/thread_pool.h"

/* ---- descriptors ---- */

int event_fd_open(const char *whose, struct error *err)
{
    int fd = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);

    if (fd < 0)
        fail(err, "%s: cannot open an event descriptor: %s", whose,
             strerror(errno));
    return fd;
}

void event_fd_set(int fd)
{
    const uint64_t one = 1;

    if (write(fd, &one, sizeof one) < 0) {
        /* the counter is full, so the descriptor is readable anyway */
    }
}

void event_fd_clear(int fd)
{
    uint64_t count;

    if (read(fd, &count, sizeof count) < 0) {
        /* the counter was zero already */
    }
}

/* ---- work ---- */

bool background_init(struct background *b, const char *whose, struct error *err)
{
    *b = (struct background){.event_fd = event_fd_open(whose, err)};
    if (b->event_fd < 0)
        return false;
    pthread_mutex_init(&b->lock, NULL);
    pthread_cond_init(&b->copied, NULL);
    return true;
}

static void *run(void *argument)
{
    struct background *b = argument;

    b->work(b->context);
    event_fd_set(b->event_fd);
    return NULL;
}

bool background_begin(struct background *b, void (*work)(void *context),
                      void *context, const char *what, struct error *err)
{
    int reason;

    b->work = work;
    b->context = context;
    b->has_copied = false;
    reason = thread_start(&b->thread, run, b);
    b->is_busy = reason == 0;
    return b->is_busy ||
           fail(err, "%s: cannot start a thread: %s", what, strerror(reason));
}

void background_has_copied(struct background *b)
{
    pthread_mutex_lock(&b->lock);
    b->has_copied = true;
    pthread_cond_signal(&b->copied);
    pthread_mutex_unlock(&b->lock);
}

void background_wait_copied(struct background *b)
{
    if (!b->is_busy)
        return;
    pthread_mutex_lock(&b->lock);
    while (!b->has_copied)
        pthread_cond_wait(&b->copied, &b->lock);
    pthread_mutex_unlock(&b->lock);
}

void background_finish(struct background *b)
{
    pthread_join(b->thread, NULL);
    b->is_busy = false;
    event_fd_clear(b->event_fd);
}

void background_free(struct background *b)
{
    pthread_cond_destroy(&b->copied);
    pthread_mutex_destroy(&b->lock);
    close(b->event_fd);
}
