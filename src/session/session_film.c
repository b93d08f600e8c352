// SPDX-License-Identifier: MIT
#include "session/session_film.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/thread_pool.h"
#include "engine/engine_film.h"

/* ---- shares ---- */

/* Returns where a share of all samples begins: an even number, so that halves
 * of samples stay halves. */
static uint64_t share_begin(const struct options *o, int index)
{
    uint64_t pairs = o->spp / 2;
    uint64_t count = (uint64_t)o->share_count;

    if (index == o->share_count)
        return o->spp;
    /* without the overflow of pairs * index */
    return 2 * (pairs / count * (uint64_t)index +
                pairs % count * (uint64_t)index / count);
}

static struct film_range share_range(const struct options *o)
{
    if (o->share_count == 0)
        return (struct film_range){0, options_limits(o).spp};
    return (struct film_range){share_begin(o, o->share_index - 1),
                               share_begin(o, o->share_index)};
}

uint64_t session_film_first(const struct options *o)
{
    return share_range(o).first;
}

struct render_limits session_film_limits(const struct options *o)
{
    struct render_limits limits = options_limits(o);
    struct film_range range = share_range(o);

    if (o->share_count != 0)
        limits.spp = range.end - range.first;
    return limits;
}

static bool check_share(const struct options *o, struct error *err)
{
    struct film_range range = share_range(o);

    return o->share_count == 0 || range.end > range.first ||
           fail(err,
                "--share: found no sample in %d/%d of %" PRIu64 ", expected "
                "two for each share at least (-s)",
                o->share_index, o->share_count, o->spp);
}

/* ---- write ---- */

static bool write_file(const struct session_film *f, const char *path,
                       struct error *err)
{
    const struct session *s = f->session;
    struct view view = edit_view(&s->edit);
    struct film_range range;
    struct film_header h =
        engine_film_header(&s->engine, &view, f->first_sample,
                           options_limits(s->options).spp, &range);

    h.identity = f->identity;
    return engine_film_write(&s->engine, path, &h, err);
}

/* Waits for the next checkpoint. Returns false if the thread is to end. The
 * caller holds the lock. */
static bool wait_interval(struct session_film *f, uint64_t interval_ns)
{
    struct timespec until = clock_time_after((int64_t)interval_ns);
    int reason = 0;

    while (!f->is_ending && reason == 0)
        reason = pthread_cond_timedwait(&f->end, &f->lock, &until);
    return !f->is_ending;
}

static void *watch(void *argument)
{
    struct session_film *f = argument;
    const struct options *o = f->session->options;
    struct error err;

    pthread_mutex_lock(&f->lock);
    while (wait_interval(f, o->checkpoint_ns)) {
        bool ok;

        pthread_mutex_unlock(&f->lock);
        ok = write_file(f, o->checkpoint_path, &err);
        pthread_mutex_lock(&f->lock);
        if (!ok)
            f->error = err;
        f->has_error = !ok;
    }
    pthread_mutex_unlock(&f->lock);
    return NULL;
}

bool session_film_watch(struct session_film *f, struct error *err)
{
    int reason;

    if (f->session->options->checkpoint_path == NULL || f->has_thread)
        return true;
    f->is_ending = false;
    reason = thread_start(&f->thread, watch, f);
    f->has_thread = reason == 0;
    return f->has_thread || fail(err, "--checkpoint: cannot start a thread: %s",
                                 strerror(reason));
}

bool session_film_failed(struct session_film *f, struct error *err)
{
    bool failed;

    pthread_mutex_lock(&f->lock);
    failed = f->has_error;
    *err = f->error;
    f->has_error = false;
    pthread_mutex_unlock(&f->lock);
    return failed;
}

void session_film_stop(struct session_film *f)
{
    if (!f->has_thread)
        return;
    pthread_mutex_lock(&f->lock);
    f->is_ending = true;
    pthread_cond_signal(&f->end);
    pthread_mutex_unlock(&f->lock);
    pthread_join(f->thread, NULL);
    f->has_thread = false;
}

bool session_film_write(struct session_film *f, struct error *err)
{
    const struct options *o = f->session->options;
    struct error film_err;
    bool has_checkpoint =
        o->checkpoint_path == NULL || write_file(f, o->checkpoint_path, err);

    if (o->film_path == NULL || write_file(f, o->film_path, &film_err))
        return has_checkpoint;
    if (has_checkpoint)
        *err = film_err;
    else
        error_add(err, &film_err);
    return false;
}

/* ---- begin ---- */

/* Returns true if --resume names a checkpoint that is not written yet, so that
 * the same command begins and resumes a render. */
static bool is_first_run(const struct options *o)
{
    return o->checkpoint_path != NULL &&
           path_is_same(o->resume_path, o->checkpoint_path) &&
           !file_identify(o->resume_path).exists;
}

static bool check_range(const struct session_film *f, struct error *err)
{
    const char *path = f->session->options->resume_path;
    const struct film_header *h = &f->from.header;

    if (h->range_count != 1)
        return fail(err,
                    "%s: found %zu ranges of samples, expected one: merge it "
                    "with the films that are missing",
                    path, h->range_count);
    return h->ranges[0].first == f->first_sample ||
           fail(err,
                "%s: found samples from %" PRIu64 " on, expected them from "
                "%" PRIu64 " on (--share)",
                path, h->ranges[0].first, f->first_sample);
}

bool session_film_resume(struct session_film *f, struct film_file **from,
                         struct error *err)
{
    const struct options *o = f->session->options;

    *from = NULL;
    film_file_free(&f->from);
    if (o->resume_path == NULL || is_first_run(o))
        return true;
    if (!film_file_read(&f->from, o->resume_path, err) ||
        !film_identity_check(&f->from.header.identity, o->resume_path,
                             &f->identity, o->scene_path, err) ||
        !check_range(f, err))
        return false;
    *from = &f->from;
    return true;
}

/* Keeps other programs from writing the films of the options. */
static bool lock(struct session_film *f, struct error *err)
{
    const struct options *o = f->session->options;
    const char *first = o->checkpoint_path, *second = o->film_path;

    if (first != NULL && (f->lock_fds[0] = file_lock(first, err)) < 0)
        return false;
    if (second == NULL || (first != NULL && path_is_same(first, second)))
        return true;
    return (f->lock_fds[1] = file_lock(second, err)) >= 0;
}

bool session_film_begin(struct session_film *f, struct session *s,
                        struct error *err)
{
    const struct options *o = s->options;
    struct view view;

    *f = (struct session_film){.session = s, .lock_fds = {-1, -1}};
    pthread_mutex_init(&f->lock, NULL);
    thread_condition_init(&f->end);
    if (!check_share(o, err))
        return false;
    if (!lock(f, err))
        return false;
    f->first_sample = session_film_first(o);
    if (o->checkpoint_path == NULL && o->film_path == NULL &&
        o->resume_path == NULL)
        return true;
    view = edit_view(&s->edit);
    return engine_film_identify(&s->engine, &view, &f->identity, err);
}

void session_film_end(struct session_film *f)
{
    if (f->session == NULL)
        return;
    session_film_stop(f);
    film_file_free(&f->from);
    for (int i = 0; i < 2; i++)
        if (f->lock_fds[i] >= 0)
            close(f->lock_fds[i]);
    pthread_cond_destroy(&f->end);
    pthread_mutex_destroy(&f->lock);
    *f = (struct session_film){.session = NULL};
}
