// SPDX-License-Identifier: MIT
#include "render/render_loop.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/memory.h"
#include "base/stop.h"
#include "base/thread_pool.h"
#include "render/render_run.h"

/* Ends a run. The caller holds the lock. A run that was cancelled at the limit
 * of time is done. */
static void end_run(struct render *r, enum pass_result result)
{
    r->run_before_ns += clock_ns() - r->run_begin_ns;
    if (result == PASS_DONE)
        r->stopped_by = render_run_limit(r);
    else if (result == PASS_CANCELLED && r->limits.time_ns != 0 &&
             r->run_before_ns >= r->limits.time_ns)
        r->stopped_by = RENDER_LIMIT_TIME;
    r->state = result == PASS_FAILED ? RENDER_FAILED
               : result == PASS_DONE || r->stopped_by != RENDER_LIMIT_NONE
                   ? RENDER_DONE
                   : RENDER_IDLE;
}

static void *render_main(void *argument)
{
    struct render *r = argument;

    pthread_mutex_lock(&r->lock);
    for (;;) {
        enum pass_result result;

        while (!r->has_job && !r->is_ending)
            pthread_cond_wait(&r->begin, &r->lock);
        if (r->is_ending)
            break;
        r->has_job = false;
        pthread_mutex_unlock(&r->lock);
        result = render_run(r);
        pthread_mutex_lock(&r->lock);
        end_run(r, result);
        pthread_cond_broadcast(&r->end);
        event_fd_set(r->event_fd);
    }
    pthread_mutex_unlock(&r->lock);
    return NULL;
}

struct render *render_create(struct backend *backend, struct error *err)
{
    struct render *r = alloc_array(1, sizeof *r);
    int reason;

    if (r == NULL) {
        fail(err, "render: out of memory");
        return NULL;
    }
    r->backend = backend;
    r->event_fd = event_fd_open("render", err);
    if (r->event_fd < 0) {
        free(r);
        return NULL;
    }
    pthread_mutex_init(&r->lock, NULL);
    pthread_cond_init(&r->begin, NULL);
    thread_condition_init(&r->end);
    reason = thread_start(&r->thread, render_main, r);
    if (reason != 0) {
        fail(err, "render: cannot start a thread: %s", strerror(reason));
        close(r->event_fd);
        free(r);
        return NULL;
    }
    return r;
}

/* Hands the job to the render thread. The caller holds the lock. */
static void start_run(struct render *r, uint64_t steps)
{
    const uint64_t limit_ns = r->limits.time_ns;

    cancel_reset(&r->cancel);
    r->steps = steps;
    r->state = RENDER_RUNNING;
    r->stopped_by = RENDER_LIMIT_NONE;
    r->cut_error = (struct film_error){0};
    r->has_job = true;
    r->run_begin_ns = clock_ns();
    r->cancel.deadline_ns =
        limit_ns != 0 ? r->run_begin_ns - r->run_before_ns + limit_ns : 0;
    pthread_cond_signal(&r->begin);
}

/* Sets the state to that of a file whose film was taken over. The error at the
 * end of a pass decides whether the render goes on, and a film that was saved
 * within a pass has been found to go on. */
static void go_on(struct render *r, const struct film_file *from)
{
    r->spp_done = film_header_spp(&from->header);
    r->run_before_ns = from->header.render_ns;
    r->has_shares = from->shares != NULL;
    r->has_error = from->is_within_pass;
}

bool render_start(struct render *r, const struct render_job *job,
                  struct error *err)
{
    render_halt(r);
    if (!render_films_reset(&r->films, job, err))
        return false;
    r->job = *job;
    r->begun_film = NULL;
    r->error_halts = 0;
    r->estimate_end_ns = 0;
    r->estimate_ns = 0;
    pthread_mutex_lock(&r->lock);
    r->limits = job->limits;
    r->spp_done = 0;
    r->draft_spp_done = 0;
    r->run_before_ns = 0;
    r->has_shares = false;
    r->first_picture_ns = 0;
    r->has_error = true; /* that of no sample is unknown */
    r->film_error = (struct film_error){0};
    r->trend = (struct render_trend){.count = 0};
    r->build_ns = 0;
    if (job->from != NULL)
        go_on(r, job->from);
    start_run(r, job->steps);
    pthread_mutex_unlock(&r->lock);
    return true;
}

void render_halt(struct render *r)
{
    stop_hold();
    cancel_request(&r->cancel);
    render_wait(r, -1);
    stop_release();
}

void render_resume(struct render *r, struct render_limits limits)
{
    pthread_mutex_lock(&r->lock);
    if (r->state == RENDER_IDLE || r->state == RENDER_DONE) {
        r->limits = limits;
        start_run(r, 0);
    }
    pthread_mutex_unlock(&r->lock);
}

bool render_step(struct render *r)
{
    bool is_done;

    pthread_mutex_lock(&r->lock);
    if (r->state == RENDER_RUNNING && r->steps > 0) {
        r->steps++;
        pthread_mutex_unlock(&r->lock);
        return true;
    }
    pthread_mutex_unlock(&r->lock);
    render_halt(r);
    pthread_mutex_lock(&r->lock);
    is_done = r->state != RENDER_IDLE;
    if (!is_done)
        start_run(r, 1);
    pthread_mutex_unlock(&r->lock);
    return !is_done;
}

bool render_wait(struct render *r, int timeout_ms)
{
    struct timespec until = clock_time_after(timeout_ms * INT64_C(1000000));
    bool is_parked;
    int reason = 0;

    pthread_mutex_lock(&r->lock);
    while (r->state == RENDER_RUNNING && reason == 0)
        reason = timeout_ms < 0
                     ? pthread_cond_wait(&r->end, &r->lock)
                     : pthread_cond_timedwait(&r->end, &r->lock, &until);
    is_parked = r->state != RENDER_RUNNING;
    pthread_mutex_unlock(&r->lock);
    return is_parked;
}

int render_event_fd(const struct render *r)
{
    return r->event_fd;
}

struct render_progress render_progress(struct render *r)
{
    struct render_progress p = {0};

    pthread_mutex_lock(&r->lock);
    p.state = r->state;
    p.stopped_by = r->stopped_by;
    p.spp_limit = r->limits.spp;
    p.error_limit = r->limits.error;
    p.time_limit_ns = r->limits.time_ns;
    p.spp_done = r->spp_done;
    p.render_ns = r->run_before_ns;
    if (r->state == RENDER_RUNNING)
        p.render_ns += clock_ns() - r->run_begin_ns;
    p.build_ns = r->build_ns;
    p.first_picture_ns = r->first_picture_ns;
    p.film_error = r->stopped_by == RENDER_LIMIT_TIME && r->cut_error.is_known
                       ? r->cut_error
                       : r->film_error;
    p.trend = r->trend;
    p.draft_is_coarse = r->films.draft.width > 0 && r->draft_spp_done == 0;
    if (r->state == RENDER_FAILED)
        p.error = r->error;
    pthread_mutex_unlock(&r->lock);
    render_films_count(&r->films, &p);
    return p;
}

const uint16_t *render_shares(struct render *r)
{
    const uint16_t *shares;

    pthread_mutex_lock(&r->lock);
    shares = r->has_shares ? r->films.adaptive.shares : NULL;
    pthread_mutex_unlock(&r->lock);
    return shares;
}

struct film *render_film(struct render *r)
{
    return &r->films.film;
}

struct film *render_draft(struct render *r)
{
    bool is_young;

    pthread_mutex_lock(&r->lock);
    is_young = r->spp_done < FILM_YOUNG_SPP;
    pthread_mutex_unlock(&r->lock);
    return is_young && r->films.draft.width > 0 ? &r->films.draft : NULL;
}

struct film *render_surfaces(struct render *r)
{
    bool is_whole;

    pthread_mutex_lock(&r->lock);
    is_whole = r->draft_spp_done > 0;
    pthread_mutex_unlock(&r->lock);
    return is_whole && r->films.draft.surfaces != NULL ? &r->films.draft : NULL;
}

void render_set_backend(struct render *r, struct backend *backend)
{
    render_halt(r);
    if (r->backend != backend) {
        r->backend->unload(r->backend);
        r->backend->shape = 0;
    }
    r->backend = backend;
}

struct backend *render_backend(const struct render *r)
{
    return r->backend;
}

void render_destroy(struct render *r)
{
    if (r == NULL)
        return;
    render_halt(r);
    pthread_mutex_lock(&r->lock);
    r->is_ending = true;
    pthread_cond_signal(&r->begin);
    pthread_mutex_unlock(&r->lock);
    pthread_join(r->thread, NULL);
    pthread_mutex_destroy(&r->lock);
    pthread_cond_destroy(&r->begin);
    pthread_cond_destroy(&r->end);
    close(r->event_fd);
    render_films_free(&r->films);
    free(r);
}
