// SPDX-License-Identifier: MIT
#include "render/render_loop.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/memory.h"
#include "base/thread.h"
#include "render/error_trend.h"
#include "picture/adaptive.h"
#include "render/projection.h"

#include "kernels/path_types.h"
#include "kernels/rng.h"

/* Stride of the coarsest grid in a draft, whose pixels are about ten times as
 * large as the film's. */
#define DRAFT_STRIDE_MAX 8

struct render {
    struct backend *backend;
    struct film film;
    struct film draft;        /* width 0: there is no draft */
    struct adaptive adaptive; /* empty: the render is not adaptive */
    pthread_t thread;
    int event_fd;
    struct cancel cancel;

    pthread_mutex_t lock;
    pthread_cond_t begin; /* signals has_job or is_ending */
    pthread_cond_t end;   /* signals that the state left RENDER_RUNNING */
    /* guarded by lock */
    bool has_job; /* a job waits for the render thread */
    bool is_ending;
    enum render_state state;
    uint64_t steps; /* steps left before it halts; 0: no steps */
    enum render_limit stopped_by;
    uint64_t spp_done; /* samples that every pixel has */
    uint64_t draft_spp_done;
    uint64_t run_begin_ns;
    uint64_t run_before_ns; /* total of earlier runs of the picture */
    uint64_t build_ns;
    uint64_t first_picture_ns;
    struct film_error film_error;
    struct error_trend error_trend;
    struct error error;
    /* set while the render thread is parked */
    struct render_job job;
    struct render_limits limits;
    /* film of the backend's last begin(); NULL: a new picture */
    const struct film *begun_film;
};

static bool is_adaptive_after(const struct render *r, uint64_t spp_done)
{
    return r->adaptive.targets != NULL && spp_done >= ADAPTIVE_FIRST;
}

/* Returns the target of the next pass after spp_done samples per pixel. */
static uint64_t next_target(uint64_t spp_done, uint64_t spp)
{
    uint64_t more = spp_done == 0 ? 1 : spp_done;
    uint64_t target;

    /* doubles up to one block per pass: short passes give early pictures, and
     * in long ones the wait at the end is a small share */
    if (more > SAMPLE_BLOCK)
        more = SAMPLE_BLOCK;
    target = spp_done + more;
    return spp != 0 && target > spp ? spp : target;
}

uint64_t render_pass_end(uint64_t spp)
{
    uint64_t end = 1;

    while (end < spp && end < SAMPLE_BLOCK)
        end *= 2;
    return end < spp ? (spp + SAMPLE_BLOCK - 1) / SAMPLE_BLOCK * SAMPLE_BLOCK
                     : end;
}

static enum pass_result run_pass(struct render *r, int stride, uint64_t done,
                                 uint64_t target)
{
    struct pass pass = {.stride = stride,
                        .target = target,
                        .samples = (uint32_t)(target - done),
                        .order = (uint32_t)target};

    if (is_adaptive_after(r, done)) {
        pass.targets = r->adaptive.targets;
        pass.target_count = 2 * (uint32_t)r->adaptive.cells;
        pass.target_version = r->adaptive.version;
        pass.samples = ADAPTIVE_MOST;
    }
    return r->backend->pass(r->backend, &pass, &r->cancel, &r->error);
}

/* Renders the first sample of all pixels, from the coarsest grid to the
 * finest. */
static enum pass_result run_first_pass(struct render *r, int stride)
{
    enum pass_result result = PASS_DONE;

    for (; stride > 0 && result == PASS_DONE; stride /= 2) {
        result = run_pass(r, stride, 0, 1);
        pthread_mutex_lock(&r->lock);
        if (r->first_picture_ns == 0 && result == PASS_DONE)
            r->first_picture_ns =
                r->run_before_ns + clock_ns() - r->run_begin_ns;
        pthread_mutex_unlock(&r->lock);
    }
    return result;
}

/* Renders every pixel from *spp_done up to `target` samples. */
static enum pass_result run_to(struct render *r, uint64_t target,
                               int stride_max, uint64_t *spp_done)
{
    enum pass_result result = *spp_done == 0
                                  ? run_first_pass(r, stride_max)
                                  : run_pass(r, 1, *spp_done, target);

    if (result == PASS_DONE) {
        pthread_mutex_lock(&r->lock);
        *spp_done = target;
        pthread_mutex_unlock(&r->lock);
    }
    return result;
}

/* Loads the shape into the backend, unless it has it already. */
static enum pass_result load(struct render *r)
{
    struct backend *b = r->backend;
    uint64_t shape = r->job.host->versions[WORLD_SHAPE];
    uint64_t begin_ns = clock_ns();
    bool ok =
        b->shape == shape || b->load(b, r->job.host, &r->job.world, &r->error);

    if (b->shape != shape) {
        pthread_mutex_lock(&r->lock);
        r->build_ns = clock_ns() - begin_ns;
        pthread_mutex_unlock(&r->lock);
    }
    b->shape = ok ? shape : 0;
    return ok ? PASS_DONE : PASS_FAILED;
}

/* Begins the film in the backend, unless it continues with it after a halt. */
static enum pass_result begin(struct render *r, const struct world *world,
                              struct film *film, int x0, int y0)
{
    if (r->begun_film == film)
        return PASS_DONE;
    r->begun_film = NULL;
    if (!r->backend->begin(r->backend, r->job.host, world, film, x0, y0,
                           &r->error))
        return PASS_FAILED;
    r->begun_film = film;
    return PASS_DONE;
}

/* Returns the world of the draft: the crop at the draft's resolution. */
static struct world draft_world(const struct render_job *job,
                                const struct film *draft)
{
    struct world w = job->world;
    struct projection_part part = {job->crop.x,     job->crop.y,
                                   job->crop.width, job->crop.height,
                                   draft->width,    draft->height};

    w.settings.camera = projection_camera(&w.settings.camera, &part);
    w.settings.order = ORDER_DRAFT;
    return w;
}

static bool is_light(const struct render_job *job)
{
    return job->world.settings.sample == SAMPLE_LIGHT;
}

/* Returns the samples per pixel of a draft. Those that are not light are all
 * equal, so one suffices. */
static uint64_t draft_spp(const struct render_job *job)
{
    return is_light(job) ? DRAFT_SPP : 1;
}

/* Renders the draft in two passes, one for each sample set of ORDER_DRAFT. */
static enum pass_result run_draft(struct render *r)
{
    struct world world = draft_world(&r->job, &r->draft);
    uint64_t spp = draft_spp(&r->job);
    uint64_t *spp_done = &r->draft_spp_done;
    enum pass_result result = begin(r, &world, &r->draft, 0, 0);

    while (result == PASS_DONE && *spp_done < spp)
        result =
            run_to(r, *spp_done == 0 ? 1 : spp, DRAFT_STRIDE_MAX, spp_done);
    return result;
}

static bool is_stepping(struct render *r)
{
    bool has_steps;

    pthread_mutex_lock(&r->lock);
    has_steps = r->steps > 0;
    pthread_mutex_unlock(&r->lock);
    return has_steps;
}

/* Counts a step after its pass. Returns true if it was the last. */
static bool was_last_step(struct render *r)
{
    bool is_last;

    pthread_mutex_lock(&r->lock);
    is_last = r->steps > 0 && --r->steps == 0;
    pthread_mutex_unlock(&r->lock);
    return is_last;
}

/* Returns the limit that holds at the end of a pass, which depends on samples
 * only. The error counts more than the samples, since it tells more. */
static enum render_limit limit_at(const struct render *r, uint64_t spp_done)
{
    const struct film_error *e = &r->film_error;

    if (r->limits.error > 0 && e->is_known && e->high <= r->limits.error)
        return RENDER_LIMIT_ERROR;
    return r->limits.spp != 0 && spp_done >= r->limits.spp ? RENDER_LIMIT_SPP
                                                           : RENDER_LIMIT_NONE;
}

static void estimate_error(struct render *r)
{
    struct film_error e = film_error(&r->film, r->job.exposure);

    pthread_mutex_lock(&r->lock);
    r->film_error = e;
    if (e.is_known)
        error_trend_add(&r->error_trend, r->spp_done, e.high);
    pthread_mutex_unlock(&r->lock);
}

/* Renders the film until a limit, the last step, a cancel or an error. */
static enum pass_result run_film(struct render *r)
{
    uint64_t *spp_done = &r->spp_done;
    enum pass_result result =
        begin(r, &r->job.world, &r->film, r->job.crop.x, r->job.crop.y);

    while (result == PASS_DONE && limit_at(r, *spp_done) == RENDER_LIMIT_NONE) {
        uint64_t target = is_stepping(r)
                              ? *spp_done + 1
                              : next_target(*spp_done, r->limits.spp);

        if (is_adaptive_after(r, *spp_done) &&
            !adaptive_next_pass(&r->adaptive, &r->film, r->job.exposure,
                                *spp_done, target - *spp_done, &target,
                                &r->error))
            return PASS_FAILED;
        result = run_to(r, target, FILM_STRIDE_MAX, spp_done);
        if (result == PASS_DONE)
            estimate_error(r);
        if (result == PASS_DONE && was_last_step(r) &&
            limit_at(r, *spp_done) == RENDER_LIMIT_NONE)
            result = PASS_CANCELLED;
    }
    return result;
}

static enum pass_result run(struct render *r)
{
    enum pass_result result = load(r);

    if (result == PASS_DONE && r->draft.width > 0 &&
        r->draft_spp_done < draft_spp(&r->job))
        result = run_draft(r);
    return result == PASS_DONE && is_light(&r->job) ? run_film(r) : result;
}

/* Ends a run. The caller holds the lock. A run that was cancelled at the limit
 * of time is done. */
static void end_run(struct render *r, enum pass_result result)
{
    r->run_before_ns += clock_ns() - r->run_begin_ns;
    if (result == PASS_DONE)
        r->stopped_by = limit_at(r, r->spp_done);
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
        result = run(r);
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
    pthread_condattr_t monotonic;
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
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&r->lock, NULL);
    pthread_cond_init(&r->begin, NULL);
    pthread_cond_init(&r->end, &monotonic);
    pthread_condattr_destroy(&monotonic);
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
    r->has_job = true;
    r->run_begin_ns = clock_ns();
    r->cancel.deadline_ns =
        limit_ns != 0 ? r->run_begin_ns - r->run_before_ns + limit_ns : 0;
    pthread_cond_signal(&r->begin);
}

/* Makes *film an empty film of this size. */
static bool reset_film(struct film *film, int width, int height,
                       bool has_surfaces, struct error *err)
{
    if (film->width == width && film->height == height &&
        (film->surfaces != NULL) == has_surfaces) {
        film_clear(film);
        return true;
    }
    film_free(film);
    return film_init(film, width, height, err) &&
           (!has_surfaces || film_init_surfaces(film, err));
}

static bool has_surfaces(const struct render_job *job)
{
    return (job->world.settings.features & FEATURE_FILTER) != 0;
}

static bool reset_adaptive(struct render *r, const struct render_job *job,
                           struct error *err)
{
    struct adaptive *a = &r->adaptive;
    int width = job->crop.width, height = job->crop.height;

    adaptive_reset(a);
    if (!job->is_adaptive || width < 8 || height < 8) {
        adaptive_free(a);
        return true;
    }
    if (a->targets != NULL && a->width == width && a->height == height)
        return true;
    adaptive_free(a);
    return adaptive_init(a, width, height, err);
}

static int smallest(int a, int b, int c)
{
    int ab = a < b ? a : b;

    return ab < c ? ab : c;
}

static bool reset_draft(struct render *r, const struct render_job *job,
                        struct error *err)
{
    int width = smallest(job->draft_width, job->crop.width, DRAFT_SIDE_MAX);
    int height = smallest(job->draft_height, job->crop.height, DRAFT_SIDE_MAX);

    if (width > 0 && height > 0)
        return reset_film(&r->draft, width, height, has_surfaces(job), err);
    film_free(&r->draft);
    return true;
}

bool render_start(struct render *r, const struct render_job *job,
                  struct error *err)
{
    render_halt(r);
    if (!reset_film(&r->film, job->crop.width, job->crop.height,
                    has_surfaces(job), err) ||
        !reset_draft(r, job, err) || !reset_adaptive(r, job, err))
        return false;
    r->job = *job;
    r->begun_film = NULL;
    pthread_mutex_lock(&r->lock);
    r->limits = job->limits;
    r->spp_done = 0;
    r->draft_spp_done = 0;
    r->run_before_ns = 0;
    r->first_picture_ns = 0;
    r->film_error = (struct film_error){0};
    r->error_trend = (struct error_trend){.count = 0};
    r->build_ns = 0;
    start_run(r, job->steps);
    pthread_mutex_unlock(&r->lock);
    return true;
}

void render_halt(struct render *r)
{
    cancel_request(&r->cancel);
    render_wait(r, -1);
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
    struct timespec until;
    bool is_parked;
    int reason = 0;

    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += timeout_ms / 1000;
    until.tv_nsec += (long)(timeout_ms % 1000) * 1000000;
    if (until.tv_nsec >= 1000000000) {
        until.tv_sec++;
        until.tv_nsec -= 1000000000;
    }
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
    uint64_t pixels = (uint64_t)r->film.width * (uint64_t)r->film.height;

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
    p.film_error = r->film_error;
    p.error_exponent = error_trend_exponent(&r->error_trend);
    p.draft_is_coarse = r->draft.width > 0 && r->draft_spp_done == 0;
    if (r->state == RENDER_FAILED)
        p.error = r->error;
    pthread_mutex_unlock(&r->lock);
    p.samples = atomic_load(&r->film.samples);
    p.pixels = pixels;
    p.samples_limit = p.spp_limit * pixels;
    p.draft_samples = atomic_load(&r->draft.samples);
    p.rays = atomic_load(&r->film.rays);
    p.non_finite = atomic_load(&r->film.non_finite);
    p.saturated = atomic_load(&r->film.saturated);
    p.cut_paths = atomic_load(&r->film.cut_paths);
    return p;
}

struct film *render_film(struct render *r)
{
    return &r->film;
}

struct film *render_draft(struct render *r)
{
    bool is_young;

    pthread_mutex_lock(&r->lock);
    is_young = r->spp_done < FILM_YOUNG_SPP;
    pthread_mutex_unlock(&r->lock);
    return is_young && r->draft.width > 0 ? &r->draft : NULL;
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
    film_free(&r->film);
    film_free(&r->draft);
    adaptive_free(&r->adaptive);
    free(r);
}
