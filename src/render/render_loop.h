// SPDX-License-Identifier: MIT
/*
 * render_loop.h - the render thread: passes over the film, halt and restart
 *
 * The first pass goes from a coarse grid to every pixel, so that there is a
 * whole picture after a few milliseconds; later passes visit blocks in random
 * order (pass_plan.h).
 *
 * For a screen a draft may come first: a small film of the same picture, with a
 * few samples per pixel whose errors are distributed as blue noise. The screen
 * shows the sum of draft and film; the film never contains the draft. Samples
 * that are not light (previews and numbers, enum sample_kind) fill only a
 * draft, and the film stays empty.
 *
 * Units:     samples per pixel (spp), pixels, nanoseconds
 * Ownership: the backend, the host and the world's arrays stay the caller's
 *            and must live until render_set_backend(), render_halt() or
 *            render_destroy()
 * Threads:   all functions from one thread (the main one)
 * Errors:    render_create(); render_start() for memory; errors of the backend
 *            are in the progress
 */
#ifndef GLIM_RENDER_LOOP_H
#define GLIM_RENDER_LOOP_H

#include <stdbool.h>
#include <stdint.h>

#include "film/film.h"
#include "film/film_error.h"
#include "film/film_file.h"
#include "render/backend.h"
#include "render/pass_plan.h"

struct rect {
    int x, y, width, height;
};

struct render_job {
    struct host_world *host;
    struct world world; /* lent from the host */
    struct rect crop;   /* rectangle of the camera's picture to render */
    struct render_limits limits;
    uint64_t steps;   /* halts after this many steps; 0: does not halt */
    float exposure;   /* for the error, film_error.h */
    bool is_adaptive; /* adaptive.h; not in pictures of fewer than 8 x 8 */
    /* size of the draft in pixels: that of the shown picture, reduced to that
     * of the crop if larger. There is no draft if either is 0. */
    int draft_width, draft_height;
    bool draft_has_surfaces; /* for the filter of the screen */
    /* the draft has fewer samples: its film has enough light already */
    bool draft_is_fine;
    /* the picture is that of the job before, but for the draft and the kind of
     * samples: its film stays, and is gone on with when light is rendered */
    bool keeps_film;
    /* index of the first sample of each pixel; even */
    uint64_t first_sample;
    /* samples to go on from, of the same picture, which are taken out of the
     * file; NULL: none */
    struct film_file *from;
};

enum render_state {
    RENDER_IDLE, /* not started, or halted */
    RENDER_RUNNING,
    RENDER_DONE,  /* a limit is reached */
    RENDER_FAILED /* member `error` has the reason */
};

struct render_progress {
    enum render_state state;
    enum render_limit stopped_by; /* none unless the state is RENDER_DONE */
    uint64_t spp_limit;           /* 0: none */
    double error_limit;           /* 0: none */
    uint64_t time_limit_ns;       /* 0: none */
    uint64_t spp_done;            /* samples that every pixel has */
    uint64_t samples;             /* samples of all pixels together */
    uint64_t samples_limit;       /* 0: none */
    uint64_t pixels;
    bool is_adaptive;
    uint64_t draft_samples; /* samples of the draft; not in `samples` */
    bool draft_is_coarse;   /* true while draft pixels lack a sample */
    uint64_t rays;
    uint64_t non_finite;
    uint64_t saturated;
    uint64_t cut_paths;
    uint64_t render_ns; /* time rendered so far, without halts */
    uint64_t build_ns;  /* time of the backend's load() */
    /* time until every point of the coarsest grid had a sample, in the draft if
     * there is one; 0: not yet */
    uint64_t first_picture_ns;
    /* at the end of the last pass, or where the limit of time cut one */
    struct film_error film_error;
    struct render_trend trend; /* of the errors after passes */
    struct error error;
};

struct render;

/* Starts the render thread, idle. Returns NULL on errors. */
struct render *render_create(struct backend *backend, struct error *err);

/* Halts the current render, clears the film and starts a new one. Returns as
 * soon as the old workers are parked; the render thread builds and renders. */
bool render_start(struct render *r, const struct render_job *job,
                  struct error *err);

/* Halts the current render and changes the backend. The next start loads the
 * geometry into it. */
void render_set_backend(struct render *r, struct backend *backend);

/* Halts. Returns when every worker is parked; the film keeps its samples. */
void render_halt(struct render *r);

/* Continues after render_halt() or the end, with new limits. */
void render_resume(struct render *r, struct render_limits limits);

/* Adds one sample to every pixel, then halts by itself. Steps accumulate: a
 * call during a step adds another one. Returns false if the render is done or
 * failed. */
bool render_step(struct render *r);

/* Blocks until the state is not RENDER_RUNNING, or for timeout_ms (-1: no
 * limit). Returns true if the render is not running. */
bool render_wait(struct render *r, int timeout_ms);

/* Returns a file descriptor that becomes readable when the state leaves
 * RENDER_RUNNING. The caller reads it empty; it belongs to the render. */
int render_event_fd(const struct render *r);

struct render_progress render_progress(struct render *r);

/* Returns the shares of adaptive sampling, of each pixel, or NULL while they
 * are not decided. Callable from any thread. They stay until the next
 * render_start(). */
const uint16_t *render_shares(struct render *r);

/* Returns the film, for reading: film_preview(), film_resolve(), film_linear(),
 * image_write(). It is valid until the next render_start() with another
 * size. */
struct film *render_film(struct render *r);

/* Returns the draft, which film_preview() adds to the film, or NULL if there is
 * none or the film has FILM_YOUNG_SPP samples, unless the draft has numbers. It
 * is valid until the next render_start(). A draft with surfaces of a job that
 * keeps the film is that of the job before until each pixel has a sample. */
struct film *render_draft(struct render *r);

/* Returns the draft if it has surfaces, in a film of any age, for
 * screen_filter.h; NULL before each of its pixels has a sample. It is valid
 * until the next render_start(). */
struct film *render_surfaces(struct render *r);
struct backend *render_backend(const struct render *r);

void render_destroy(struct render *r);

#endif
