// SPDX-License-Identifier: MIT
#include "render/render_loop.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/background.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/stop.h"
#include "base/thread_pool.h"
#include "film/adaptive.h"
#include "film/film.h"
#include "film/filter/film_filter.h"
#include "render/light_block.h"
#include "render/pass_plan.h"
#include "render/projection.h"
#include "kernels/rng.h"
#include "kernels/types.h"

/* Stride of the coarsest grid in a draft, whose pixels are about ten times as
 * large as the film's. */
#define DRAFT_STRIDE_MAX 8

/* Halts that may interrupt the error of a pass. Then it is completed, as halts
 * in quick succession would keep the render from going on. */
#define ERROR_HALTS_MAX 3

/* Time from one estimate of the error to the next, in multiples of the time
 * that it takes, where only the screen shows it. After each pass they took 2.5
 * % of a render of the Cornell box. */
#define ESTIMATE_TIMES 100

struct render_films {
    struct film film;
    struct film drafts[2];
    struct film *draft;       /* one of them; width 0: there is no draft */
    struct film *old_draft;   /* shown until the draft is whole; or width 0 */
    struct adaptive adaptive; /* empty: the render is not adaptive */
    struct light_block light; /* of light paths, for the film */
};

struct render {
    struct backend *backend;
    struct render_films films;
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
    bool has_shares; /* those of adaptive sampling are decided */
    bool has_error;  /* film_error is that of the last pass */
    struct film_error film_error;
    struct film_error cut_error; /* of a film that the time has cut */
    struct render_trend trend;   /* over the time without the build */
    struct error error;
    /* set while the render thread is parked */
    struct render_job job;
    struct render_limits limits;
    uint64_t estimate_ns;     /* time of the last estimate of the error */
    uint64_t estimate_end_ns; /* when it ended; 0: none */
    int error_halts; /* halts since the last pass that came before its error */
    /* film of the backend's last begin(); NULL: a new picture */
    const struct film *begun_film;
};

/* ---- films ---- */

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

static bool reset_adaptive(struct adaptive *a, const struct render_job *job,
                           struct error *err)
{
    int width = job->crop.width, height = job->crop.height;

    adaptive_reset(a);
    if (!job->is_adaptive || width < 8 || height < 8) {
        adaptive_free(a);
        return true;
    }
    if (a->shares != NULL && a->width == width && a->height == height)
        return true;
    adaptive_free(a);
    return adaptive_init(a, width, height, err);
}

static int smallest(int a, int b, int c)
{
    int ab = a < b ? a : b;

    return ab < c ? ab : c;
}

static bool reset_draft(struct film *draft, const struct render_job *job,
                        struct error *err)
{
    int width = smallest(job->draft_width, job->crop.width, DRAFT_SIDE_MAX);
    int height = smallest(job->draft_height, job->crop.height, DRAFT_SIDE_MAX);

    if (width > 0 && height > 0)
        return reset_film(draft, width, height,
                          has_surfaces(job) || job->draft_has_surfaces, err);
    film_free(draft);
    return true;
}

/* Takes the samples of a file over. */
static void take_file(struct render_films *f, struct film_file *from)
{
    struct adaptive *a = &f->adaptive;
    size_t pixels = (size_t)f->film.width * (size_t)f->film.height;

    film_swap(&f->film, &from->film);
    if (a->shares == NULL || from->shares == NULL)
        return;
    memcpy(a->shares, from->shares, pixels * sizeof *a->shares);
    a->is_decided = true;
}

/* Keeps the draft, which is whole, as the old one. */
static void keep_draft(struct render_films *f)
{
    struct film *draft = f->draft;

    f->draft = f->old_draft;
    f->old_draft = draft;
}

/* Clears the films for a new picture, with the sizes that the job wants. */
static bool render_films_reset(struct render_films *f,
                               const struct render_job *job, struct error *err)
{
    if (!(job->keeps_film ||
          reset_film(&f->film, job->crop.width, job->crop.height,
                     has_surfaces(job), err)) ||
        !reset_draft(f->draft, job, err) ||
        !reset_adaptive(&f->adaptive, job, err))
        return false;
    f->film.first_sample = job->first_sample;
    light_block_reset(&f->light);
    if (job->from != NULL)
        take_file(f, job->from);
    return true;
}

/* Returns the world of the draft: the crop at the draft's resolution. */
static struct world render_films_draft_world(const struct render_films *f,
                                             const struct render_job *job)
{
    struct world w = job->world;
    struct projection_part part = {job->crop.x,     job->crop.y,
                                   job->crop.width, job->crop.height,
                                   f->draft->width, f->draft->height};

    w.settings.camera = projection_camera(&w.settings.camera, &part);
    w.settings.order = ORDER_DRAFT;
    if (job->draft_has_surfaces) {
        w.settings.order = ORDER_DRAFT_HALVES;
        w.settings.features |= FEATURE_FILTER;
    }
    return w;
}

/* Returns whether samples are light, which fills the film. Others fill only a
 * draft. */
static bool render_films_want_light(const struct render_job *job)
{
    return job->world.settings.sample == SAMPLE_LIGHT;
}

/* Returns the samples per pixel of a draft. Those that are not light are all
 * equal, so one suffices. */
static uint64_t render_films_draft_spp(const struct render_job *job)
{
    if (!render_films_want_light(job))
        return 1;
    return job->draft_has_surfaces && !job->draft_is_fine ? DRAFT_HALVES_SPP
                                                          : DRAFT_SPP;
}

/* Copies counters and sizes into the progress, whose limits are set. */
static void render_films_count(const struct render_films *f,
                               struct render_progress *p)
{
    p->is_adaptive = f->adaptive.shares != NULL;
    p->pixels = (uint64_t)f->film.width * (uint64_t)f->film.height;
    p->samples = atomic_load(&f->film.samples);
    p->samples_limit = p->spp_limit * p->pixels;
    p->draft_samples = atomic_load(&f->draft->samples);
    p->rays = atomic_load(&f->film.rays);
    p->non_finite = atomic_load(&f->film.non_finite);
    p->saturated = atomic_load(&f->film.saturated);
    p->cut_paths = atomic_load(&f->film.cut_paths);
}

static void render_films_free(struct render_films *f)
{
    film_free(&f->film);
    film_free(&f->drafts[0]);
    film_free(&f->drafts[1]);
    adaptive_free(&f->adaptive);
    light_block_free(&f->light);
}

/* ---- passes ---- */

static bool is_adaptive(const struct render *r)
{
    return r->films.adaptive.shares != NULL;
}

static void note_first_picture(struct render *r)
{
    pthread_mutex_lock(&r->lock);
    if (r->first_picture_ns == 0)
        r->first_picture_ns = r->run_before_ns + clock_ns() - r->run_begin_ns;
    pthread_mutex_unlock(&r->lock);
}

/* Renders every pixel from *spp_done up to `target` samples; the first sample
 * from the coarsest grid to the finest. */
static enum pass_result run_to(struct render *r, uint64_t target,
                               int stride_max, uint64_t *spp_done)
{
    enum pass_result result = PASS_DONE;

    for (int stride = *spp_done == 0 ? stride_max : 1;
         stride > 0 && result == PASS_DONE; stride /= 2) {
        struct pass pass =
            pass_plan_pass(*spp_done, target, stride, &r->films.adaptive);

        if (r->begun_film == &r->films.film && r->films.light.end > 0)
            pass.light = &r->films.light.light;
        result = r->backend->pass(r->backend, &pass, &r->cancel, &r->error);
        if (result == PASS_DONE)
            note_first_picture(r);
    }
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
    bool ok;

    stop_allow_begin();
    ok = b->shape == shape || b->load(b, r->job.host, &r->job.world, &r->error);
    stop_allow_end();
    if (b->shape != shape) {
        pthread_mutex_lock(&r->lock);
        r->build_ns = clock_ns() - begin_ns;
        pthread_mutex_unlock(&r->lock);
    }
    b->shape = ok ? shape : 0;
    return ok ? PASS_DONE : PASS_FAILED;
}

/* Begins the film in the backend, unless it continues with it after a halt. */
static enum pass_result begin(struct render *r,
                              const struct backend_picture *picture)
{
    if (r->begun_film == picture->film && !picture->goes_on)
        return PASS_DONE;
    r->begun_film = NULL;
    if (!r->backend->begin(r->backend, picture, &r->error))
        return PASS_FAILED;
    r->begun_film = picture->film;
    return PASS_DONE;
}

/* Returns the samples of a draft after its next pass. Its sets of samples are
 * those of ORDER_DRAFT. */
static uint64_t draft_target(uint64_t spp_done, uint64_t spp)
{
    if (spp_done == 0)
        return 1;
    return spp_done < DRAFT_SPP ? DRAFT_SPP : spp;
}

static enum pass_result run_draft(struct render *r)
{
    struct world world = render_films_draft_world(&r->films, &r->job);
    uint64_t spp = render_films_draft_spp(&r->job);
    uint64_t *spp_done = &r->draft_spp_done;
    enum pass_result result =
        begin(r, &(struct backend_picture){.host = r->job.host,
                                           .world = &world,
                                           .film = r->films.draft});

    while (result == PASS_DONE && *spp_done < spp)
        result =
            run_to(r, draft_target(*spp_done, spp), DRAFT_STRIDE_MAX, spp_done);
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

/* Returns the limit that holds after the last pass. */
static enum render_limit render_run_limit(const struct render *r)
{
    return render_limits_at(&r->limits, r->spp_done, &r->film_error);
}

/* Returns the cancel of work between passes, or NULL if it has been halted too
 * often: a series of halts could delay it for ever. */
static const struct cancel *cancel_between(const struct render *r)
{
    return r->error_halts < ERROR_HALTS_MAX ? &r->cancel : NULL;
}

static bool estimate(struct render *r, const struct cancel *cancel,
                     struct film_error *e)
{
    uint64_t begin_ns = clock_ns();
    bool ok = film_error(&r->films.film, r->job.exposure, r->backend->pool,
                         cancel, e, &r->error);

    r->estimate_end_ns = clock_ns();
    r->estimate_ns = r->estimate_end_ns - begin_ns;
    return ok;
}

/* Returns the time of the picture without halts and build. */
static double tracing_ns(const struct render *r)
{
    uint64_t run_ns = clock_ns() - r->run_begin_ns;

    return (double)(r->run_before_ns + run_ns - r->build_ns);
}

/* Returns whether a pass needs its error: a limit of the error waits for it, no
 * pass follows, or the time since the last estimate is long against the time
 * that one took. */
static bool wants_error(struct render *r)
{
    return r->limits.error > 0 || render_run_limit(r) != RENDER_LIMIT_NONE ||
           is_stepping(r) ||
           clock_ns() - r->estimate_end_ns >= ESTIMATE_TIMES * r->estimate_ns;
}

/* Finds the error at the end of a pass that needs it, unless it is known
 * already. */
static enum pass_result estimate_pass(struct render *r)
{
    const struct cancel *cancel = cancel_between(r);
    struct film_error e;

    if (r->has_error || !wants_error(r))
        return PASS_DONE;
    if (!estimate(r, cancel, &e))
        return PASS_FAILED;
    if (cancel != NULL && cancel_requested(cancel)) {
        r->error_halts++;
        return PASS_CANCELLED;
    }
    r->error_halts = 0;
    pthread_mutex_lock(&r->lock);
    r->film_error = e;
    r->has_error = true;
    if (e.is_known)
        render_trend_add(&r->trend, tracing_ns(r), (double)r->spp_done, &e);
    pthread_mutex_unlock(&r->lock);
    return PASS_DONE;
}

static bool is_out_of_time(const struct render *r)
{
    return r->cancel.deadline_ns != 0 && clock_ns() >= r->cancel.deadline_ns;
}

/* Finds the error of a film that the limit of time has cut within a pass. */
static enum pass_result estimate_cut(struct render *r)
{
    struct film_error e;

    r->cancel.deadline_ns = 0; /* requests still count */
    if (!estimate(r, &r->cancel, &e))
        return PASS_FAILED;
    pthread_mutex_lock(&r->lock);
    r->cut_error = e;
    pthread_mutex_unlock(&r->lock);
    return PASS_CANCELLED;
}

/* The error of the filtered picture: more samples at silhouettes and in light
 * with sharp edges, which the filter cannot average. It removes most of the
 * chance in deviations, so that a pixel takes those of the four beside it, and
 * shares may be large. */
static const struct adaptive_measure adaptive_filtered = {film_filter_squares,
                                                          1, 4};

/* Decides the shares of adaptive sampling before the passes that need them. */
static enum pass_result decide_shares(struct render *r)
{
    struct adaptive *a = &r->films.adaptive;
    struct film *film = &r->films.film;

    if (!pass_plan_has_shares(r->spp_done, is_adaptive(r)))
        return PASS_DONE;
    a->measure =
        film_filter_applies(film) ? &adaptive_filtered : &adaptive_film;
    if (!adaptive_decide(a, film, r->job.exposure, r->backend->pool,
                         cancel_between(r), &r->error))
        return PASS_FAILED;
    if (!a->is_decided) {
        r->error_halts++;
        return PASS_CANCELLED;
    }
    pthread_mutex_lock(&r->lock);
    r->has_shares = true;
    pthread_mutex_unlock(&r->lock);
    return PASS_DONE;
}

/* Returns the samples at the end of the next pass. Passes of the plan are
 * joined if the backend wants longer ones, where nothing depends on their ends.
 */
static uint64_t next_target(const struct render *r)
{
    uint64_t done = r->spp_done, spp = r->limits.spp;
    uint64_t least = r->limits.error > 0 ? 0 : r->backend->pass_least;
    bool shares = pass_plan_has_shares(done, is_adaptive(r));
    uint64_t target = pass_plan_next(done, &r->limits, is_adaptive(r));

    if (least > done) /* long passes only after short ones */
        least = done;
    while (target - done < least && (spp == 0 || target < spp) &&
           pass_plan_has_shares(target, is_adaptive(r)) == shares)
        target = pass_plan_next(target, &r->limits, is_adaptive(r));
    return target;
}

/* Returns the film as the backend has it. */
static struct backend_picture film_picture(struct render *r,
                                           const struct world *world)
{
    return (struct backend_picture){.host = r->job.host,
                                    .world = world,
                                    .film = &r->films.film,
                                    .x0 = r->job.crop.x,
                                    .y0 = r->job.crop.y};
}

/* Begins the film, or goes on with it after its world has changed. */
static enum pass_result begin_film(struct render *r, bool goes_on)
{
    struct world world = light_block_world(&r->films.light, &r->job.world);
    struct backend_picture picture = film_picture(r, &world);

    picture.goes_on = goes_on;
    return begin(r, &picture);
}

/* Finds the light that samples of the next pass share, which ends with its
 * block. */
static enum pass_result find_light(struct render *r, uint64_t *target)
{
    struct light_block *light = &r->films.light;
    uint64_t first = r->films.film.first_sample;
    uint64_t end =
        light_block_end(&r->job.world.settings.camera, first + r->spp_done) -
        first;
    struct backend_picture picture = film_picture(r, &r->job.world);
    bool had_radiance = light->has_radiance;
    enum pass_result result;

    if (!light_block_is_needed(light))
        return PASS_DONE;
    *target = *target < end ? *target : end;
    result = light_block_find(light, &picture, first + r->spp_done,
                              r->backend->pool, &r->cancel, &r->error);
    if (light->has_radiance != had_radiance &&
        begin_film(r, true) == PASS_FAILED)
        return PASS_FAILED;
    return result;
}

static enum pass_result run_film_pass(struct render *r)
{
    uint64_t *spp_done = &r->spp_done;
    uint64_t target = is_stepping(r) ? *spp_done + 1 : next_target(r);
    enum pass_result result = decide_shares(r);

    if (result == PASS_DONE)
        result = find_light(r, &target);
    if (result == PASS_DONE)
        result = run_to(r, target, FILM_STRIDE_MAX, spp_done);
    if (result != PASS_DONE)
        return result;
    r->has_error = false;
    return estimate_pass(r);
}

/* Renders the film until a limit, the last step, a cancel or an error. */
static enum pass_result run_film(struct render *r)
{
    struct backend_picture picture = film_picture(r, &r->job.world);
    enum pass_result result = PASS_DONE;

    if (r->backend->takes_light)
        result = light_block_decide(&r->films.light, &picture, r->backend->pool,
                                    &r->cancel, &r->error);
    if (result == PASS_DONE)
        result = begin_film(r, false);
    if (result == PASS_DONE) /* a halt may have come between pass and error */
        result = estimate_pass(r);
    while (result == PASS_DONE && render_run_limit(r) == RENDER_LIMIT_NONE) {
        result = run_film_pass(r);
        if (result == PASS_DONE && was_last_step(r) &&
            render_run_limit(r) == RENDER_LIMIT_NONE)
            result = PASS_CANCELLED;
    }
    return result == PASS_CANCELLED && is_out_of_time(r) ? estimate_cut(r)
                                                         : result;
}

/* Runs the job until a limit, the last step, a cancel or an error, from where
 * the run before has ended. */
static enum pass_result render_run(struct render *r)
{
    enum pass_result result = load(r);

    if (result == PASS_DONE && r->films.draft->width > 0 &&
        r->draft_spp_done < render_films_draft_spp(&r->job))
        result = run_draft(r);
    return result == PASS_DONE && render_films_want_light(&r->job) ? run_film(r)
                                                                   : result;
}

/* ---- the thread ---- */

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
    r->films.draft = &r->films.drafts[0];
    r->films.old_draft = &r->films.drafts[1];
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

/* Sets the state to that of an empty film. */
static void begin_empty(struct render *r)
{
    r->spp_done = 0;
    r->run_before_ns = 0;
    r->has_shares = false;
    r->has_error = true; /* that of no sample is unknown */
    r->film_error = (struct film_error){0};
    r->trend = (struct render_trend){.count = 0};
    r->build_ns = 0;
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
    if (!job->keeps_film || !job->draft_has_surfaces ||
        !r->job.draft_has_surfaces)
        film_free(r->films.old_draft);
    else if (r->draft_spp_done > 0)
        keep_draft(&r->films);
    if (!render_films_reset(&r->films, job, err))
        return false;
    r->job = *job;
    r->begun_film = NULL;
    r->error_halts = 0;
    r->estimate_end_ns = 0;
    r->estimate_ns = 0;
    pthread_mutex_lock(&r->lock);
    r->limits = job->limits;
    r->draft_spp_done = 0;
    r->first_picture_ns = 0;
    if (!job->keeps_film)
        begin_empty(r);
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
    p.draft_is_coarse = r->films.draft->width > 0 && r->draft_spp_done == 0;
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

/* Returns the draft, or the one before it until each pixel has a sample, which
 * may have no pixels. */
static struct film *shown_draft(struct render *r)
{
    struct render_films *f = &r->films;
    bool is_whole;

    pthread_mutex_lock(&r->lock);
    is_whole = r->draft_spp_done > 0;
    pthread_mutex_unlock(&r->lock);
    return is_whole || f->old_draft->width == 0 ? f->draft : f->old_draft;
}

struct film *render_draft(struct render *r)
{
    struct film *draft = shown_draft(r);
    bool is_shown;

    pthread_mutex_lock(&r->lock);
    is_shown =
        r->spp_done < FILM_YOUNG_SPP || !render_films_want_light(&r->job);
    pthread_mutex_unlock(&r->lock);
    return is_shown && draft->width > 0 ? draft : NULL;
}

struct film *render_surfaces(struct render *r)
{
    struct film *draft = shown_draft(r);
    bool is_whole;

    pthread_mutex_lock(&r->lock);
    is_whole = draft == r->films.old_draft || r->draft_spp_done > 0;
    pthread_mutex_unlock(&r->lock);
    return is_whole && draft->surfaces != NULL ? draft : NULL;
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
