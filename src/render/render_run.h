// SPDX-License-Identifier: MIT
/*
 * render_run.h - a run of the render thread: draft, passes, error, until a
 * limit or a cancel
 *
 * Private to render_loop.c, which starts runs and answers for them.
 *
 * Units:     samples per pixel (spp), nanoseconds
 * Threads:   render_run() on the render thread; it takes the lock where it
 *            writes what the lock guards
 */
#ifndef GLIM_RENDER_RUN_H
#define GLIM_RENDER_RUN_H

#include <pthread.h>

#include "render/render_films.h"
#include "render/render_loop.h"

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

/* Runs the job until a limit, the last step, a cancel or an error, from where
 * the run before has ended. */
enum pass_result render_run(struct render *r);

/* Returns the limit that holds after the last pass. */
enum render_limit render_run_limit(const struct render *r);

#endif
