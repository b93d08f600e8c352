// SPDX-License-Identifier: MIT
#include "session/save_thread.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/event_fd.h"
#include "base/thread.h"
#include "picture/image_write.h"
#include "terminal/xmalloc.h"

bool save_thread_init(struct save_thread *s, struct error *err)
{
    *s = (struct save_thread){.event_fd = event_fd_open("saver", err)};
    if (s->event_fd < 0)
        return false;
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->copied, NULL);
    return true;
}

static void *saver_main(void *argument)
{
    struct save_thread *s = argument;
    struct film copy = {0};
    bool ok = film_copy(&copy, s->film, &s->error);

    pthread_mutex_lock(&s->lock);
    s->has_copied = true;
    pthread_cond_signal(&s->copied);
    pthread_mutex_unlock(&s->lock);
    if (ok)
        s->name = image_write_numbered(&copy, s->how, &s->metadata, s->stem,
                                       s->ending, &s->error);
    film_free(&copy);
    event_fd_set(s->event_fd);
    return NULL;
}

bool save_thread_begin(struct save_thread *s, struct film *film,
                       struct develop how,
                       const struct image_metadata *metadata, const char *stem,
                       const char *ending, struct error *err)
{
    int reason;

    if (s->is_busy)
        return fail(err, "%s.%s: the previous picture is still being saved",
                    stem, ending);
    s->film = film;
    s->how = how;
    s->metadata = *metadata;
    s->stem = xstrdup(stem);
    s->ending = ending;
    s->has_copied = false;
    s->name = NULL;
    reason = thread_start(&s->thread, saver_main, s);
    if (reason != 0) {
        free(s->stem);
        return fail(err, "%s.%s: cannot start a thread to save it: %s", stem,
                    ending, strerror(reason));
    }
    s->is_busy = true;
    return true;
}

void save_thread_wait_copied(struct save_thread *s)
{
    if (!s->is_busy)
        return;
    pthread_mutex_lock(&s->lock);
    while (!s->has_copied)
        pthread_cond_wait(&s->copied, &s->lock);
    pthread_mutex_unlock(&s->lock);
}

char *save_thread_finish(struct save_thread *s, struct error *err)
{
    pthread_join(s->thread, NULL);
    s->is_busy = false;
    free(s->stem);
    s->stem = NULL;
    event_fd_clear(s->event_fd);
    if (!s->name)
        *err = s->error;
    return s->name;
}

void save_thread_free(struct save_thread *s)
{
    struct error ignored;

    if (s->is_busy)
        free(save_thread_finish(s, &ignored));
    pthread_cond_destroy(&s->copied);
    pthread_mutex_destroy(&s->lock);
    close(s->event_fd);
}
