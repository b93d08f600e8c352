// SPDX-License-Identifier: MIT
/* Backends of a handle, and the loop that waits for the render thread. */
#include "api/handle.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "base/background.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "render/progress.h"
#include "scene/pose_fit.h"

/* Greatest number of threads, more than machines have processors. */
#define THREADS_MAX 4096

/* Milliseconds between calls of the progress function. */
#define PROGRESS_MS 100

/* ---- backends ---- */

bool handle_find_threads(int given, int *count, struct error *err)
{
    if (given < 0 || given > THREADS_MAX)
        return fail(err, "threads: found %d, expected 0 to %d", given,
                    THREADS_MAX);
    *count = given > 0 ? given : usable_threads();
    return true;
}

/* Ends the render of the handle, whose picture is lost. */
static void end_render(struct glim *g)
{
    engine_end(&g->engine);
    g->has_picture = false;
}

bool glim_set_threads(struct glim *g, int count, struct glim_error *err)
{
    struct error why;
    int found = 0;

    if (!handle_given(g, "handle", err))
        return false;
    if (!handle_find_threads(count, &found, &why))
        return handle_fail(err, &why);
    end_render(g);
    g->engine.options.scene.thread_count = found;
    g->engine.world.thread_count = found;
    return true;
}

bool glim_set_backend(struct glim *g, enum glim_backend backend,
                      const char *device, struct glim_error *err)
{
    struct cl_request *request;
    struct error why;
    bool ok;

    if (!handle_given(g, "handle", err))
        return false;
    if ((unsigned)backend > GLIM_BACKEND_OPENCL) {
        fail(&why, "backend: found %d, expected %d to %d", (int)backend,
             GLIM_BACKEND_CPU, GLIM_BACKEND_OPENCL);
        return handle_fail(err, &why);
    }
    end_render(g);
    backends_drop_device(&g->engine.backends);
    free(g->backend_log);
    g->backend_log = NULL;
    if (backend == GLIM_BACKEND_CPU)
        return true;
    request = &g->engine.options.device;
    request->device = device;
    request->needs_gpu = backend == GLIM_BACKEND_GPU;
    ok = engine_use_device(&g->engine, &g->view, &g->backend_log, &why);
    request->device = NULL; /* the caller's text */
    return ok || handle_fail(err, &why);
}

const char *glim_backend_log(const struct glim *g)
{
    return g != NULL ? g->backend_log : NULL;
}

/* ---- rendering ---- */

static enum glim_limit limit_of(enum render_limit limit)
{
    switch (limit) {
    case RENDER_LIMIT_NONE: break;
    case RENDER_LIMIT_SPP: return GLIM_LIMIT_SPP;
    case RENDER_LIMIT_ERROR: return GLIM_LIMIT_ERROR;
    case RENDER_LIMIT_TIME: return GLIM_LIMIT_SECONDS;
    }
    return GLIM_LIMIT_NONE;
}

static struct glim_progress convert(const struct render_progress *p)
{
    bool is_running = p->state == RENDER_RUNNING;
    struct render_left left = render_left(p);
    bool is_known = left.limit != RENDER_LIMIT_NONE;

    return (struct glim_progress){
        .spp = p->spp_done,
        .spp_limit = p->spp_limit,
        .samples = p->samples,
        .samples_limit = p->samples_limit,
        .non_finite = p->non_finite,
        .saturated = p->saturated,
        .seconds = seconds_between(0, p->render_ns),
        .build_seconds = seconds_between(0, p->build_ns),
        .error_is_known = p->film_error.is_known,
        .error_is_resolved = p->film_error.is_resolved,
        .error = p->film_error.error,
        .error_low = p->film_error.low,
        .error_high = p->film_error.high,
        .limit = limit_of(is_running ? left.limit : p->stopped_by),
        .part_done = left.part,
        .seconds_left = is_known ? left.ns * 1e-9 : -1,
    };
}

struct glim_progress glim_get_progress(struct glim *g)
{
    struct render_progress p;

    if (g == NULL || !g->has_picture)
        return (struct glim_progress){0};
    p = render_progress(g->engine.render);
    return convert(&p);
}

bool glim_set_error_limit(struct glim *g, double error, struct glim_error *err)
{
    struct error why;

    if (!handle_given(g, "handle", err))
        return false;
    if (!(error >= 0 && error <= 1)) {
        fail(&why, "error limit: found %g, expected 0 to 1", error);
        return handle_fail(err, &why);
    }
    g->error_limit = error;
    return true;
}

void glim_set_adaptive(struct glim *g, bool is_adaptive)
{
    if (g == NULL)
        return;
    g->has_picture =
        g->has_picture && g->engine.options.is_adaptive == is_adaptive;
    g->engine.options.is_adaptive = is_adaptive;
}

bool glim_set_denoise(struct glim *g, bool is_wanted, struct glim_error *err)
{
    struct error why;

    if (!handle_given(g, "handle", err))
        return false;
    if (is_wanted && g->engine.backends.device != NULL &&
        (g->engine.backends.features & FEATURE_FILTER) == 0) {
        fail(&why, "denoise: found a device without the filter's kernels, "
                   "expected glim_set_denoise() before glim_set_backend()");
        return handle_fail(err, &why);
    }
    /* switching the filter off keeps what it needs, to switch it on again */
    g->has_picture =
        g->has_picture &&
        (!is_wanted || render_film(g->engine.render)->surfaces != NULL);
    g->engine.options.wants_filter = is_wanted;
    return true;
}

/* Limits of one call of glim_render(); 0 is none. */
struct glim_call {
    uint64_t spp;
    double error;
    uint64_t end_ns; /* of clock_ns() */
};

static struct glim_call call_of(const struct glim *g, uint64_t spp,
                                double seconds)
{
    double ns = seconds * 1e9;
    bool has_end = seconds > 0 && ns < 9e18;

    return (struct glim_call){
        .spp = spp,
        .error = g->error_limit,
        .end_ns = has_end ? clock_ns() + (uint64_t)ns : 0,
    };
}

/* Returns the limits of the picture, which was rendered for `before_ns` by
 * earlier calls. */
static struct render_limits limits_of(const struct glim_call *call,
                                      uint64_t before_ns)
{
    struct render_limits limits = {.spp = call->spp, .error = call->error};
    uint64_t now_ns = clock_ns();

    if (call->end_ns != 0)
        limits.time_ns =
            before_ns + (call->end_ns > now_ns ? call->end_ns - now_ns : 1);
    return limits;
}

bool handle_prepare(struct glim *g, struct render_job *job, struct error *err)
{
    if (!g->view.has_camera) /* depends on the aspect ratio */
        scene_frame(&g->engine.scene, &g->view);
    return engine_prepare(&g->engine, &g->view, job, err);
}

/* Starts a new picture with the current settings. */
static bool begin(struct glim *g, const struct glim_call *call,
                  struct error *err)
{
    struct render_job job;

    if (!handle_prepare(g, &job, err))
        return false;
    job.limits = limits_of(call, 0);
    return g->has_picture = engine_start(&g->engine, &job, err);
}

/* Waits until a limit is reached, or the render is stopped by the progress
 * function or glim_cancel(). */
static enum glim_result wait_for_end(struct glim *g, glim_progress_fn *progress,
                                     void *context)
{
    struct pollfd fds[2] = {{.fd = render_event_fd(g->engine.render),
                             .events = POLLIN},
                            {.fd = g->cancel_fd, .events = POLLIN}};

    for (;;) {
        struct render_progress p = render_progress(g->engine.render);
        struct glim_progress shown = convert(&p);

        if (p.state != RENDER_RUNNING)
            return GLIM_DONE;
        if (progress != NULL && !progress(context, &shown))
            return GLIM_STOPPED;
        if (poll(fds, 2, progress != NULL ? PROGRESS_MS : -1) <= 0)
            continue;
        if (fds[0].revents & POLLIN)
            event_fd_clear(fds[0].fd);
        if (fds[1].revents & POLLIN) {
            event_fd_clear(fds[1].fd);
            return GLIM_STOPPED;
        }
    }
}

enum glim_result glim_render(struct glim *g, uint64_t spp, double seconds,
                             glim_progress_fn *progress, void *context,
                             struct glim_error *err)
{
    struct render_progress p;
    enum glim_result result;
    struct glim_call call;
    struct error why;

    if (!handle_given(g, "handle", err))
        return GLIM_FAILED;
    if (!(seconds >= 0)) {
        fail(&why, "seconds: found %g, expected a number from 0 on", seconds);
        handle_fail(err, &why);
        return GLIM_FAILED;
    }
    call = call_of(g, spp, seconds);
    if (g->has_picture) {
        p = render_progress(g->engine.render);
        render_resume(g->engine.render, limits_of(&call, p.render_ns));
    } else if (!begin(g, &call, &why)) {
        handle_fail(err, &why);
        return GLIM_FAILED;
    }
    result = wait_for_end(g, progress, context);
    render_halt(g->engine.render);
    p = render_progress(g->engine.render);
    if (p.state != RENDER_FAILED)
        return result;
    g->has_picture = false;
    handle_fail(err, &p.error);
    return GLIM_FAILED;
}

void glim_cancel(struct glim *g)
{
    if (g != NULL)
        event_fd_set(g->cancel_fd);
}
