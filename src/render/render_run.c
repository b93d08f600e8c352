// SPDX-License-Identifier: MIT
#include "render/render_run.h"

#include "base/clock.h"
#include "base/stop.h"
#include "filter/film_filter.h"
#include "render/pass_plan.h"

#include "kernels/rng.h"

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
    enum pass_result result = begin(r, &world, &r->films.draft, 0, 0);

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

enum render_limit render_run_limit(const struct render *r)
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
    const struct adaptive_measure *measure;

    if (!pass_plan_has_shares(r->spp_done, is_adaptive(r)))
        return PASS_DONE;
    measure = film_filter_applies(film) ? &adaptive_filtered : &adaptive_film;
    if (!adaptive_decide(a, measure, film, r->job.exposure, r->backend->pool,
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

static enum pass_result run_film_pass(struct render *r)
{
    uint64_t *spp_done = &r->spp_done;
    uint64_t target = is_stepping(r) ? *spp_done + 1 : next_target(r);
    enum pass_result result = decide_shares(r);

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
    enum pass_result result =
        begin(r, &r->job.world, &r->films.film, r->job.crop.x, r->job.crop.y);

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

enum pass_result render_run(struct render *r)
{
    enum pass_result result = load(r);

    if (result == PASS_DONE && r->films.draft.width > 0 &&
        r->draft_spp_done < render_films_draft_spp(&r->job))
        result = run_draft(r);
    return result == PASS_DONE && render_films_want_light(&r->job) ? run_film(r)
                                                                   : result;
}
