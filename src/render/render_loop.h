// SPDX-License-Identifier: MIT
/*
 * render_loop.h - the render thread: passes over the film, halt and restart
 *
 * The first pass goes from coarse to fine, so that there is a whole picture
 * after a few milliseconds; later ones visit blocks in random order. Pass
 * sizes follow sample counts, never the clock.
 *
 * For a screen a draft may come first: a small film of the same picture, with
 * a few samples a pixel in an order that is calm to look at. It is added to
 * what is shown, never to the film. What is not light, but a preview or numbers
 * (enum sample_kind), is a draft only, and the film stays empty.
 *
 * Units:     samples a pixel (spp), pixels, nanoseconds
 * Ownership: the backend, the host and the world's arrays stay the caller's
 *            and must live until render_use(), render_halt() or
 *            render_destroy()
 * Threads:   all functions from one thread (the main one)
 * Errors:    render_start() for memory; a failing backend shows in the progress
 */
#ifndef GLIM_RENDER_LOOP_H
#define GLIM_RENDER_LOOP_H

#include <stdbool.h>
#include <stdint.h>

#include "picture/film.h"
#include "render/backend.h"

struct rect {
    int x, y, width, height;
};

struct render_job {
    struct host_world *host;
    struct world world; /* lent from the host */
    struct rect crop;   /* in the picture that world.settings.camera has */
    uint64_t spp;       /* 0: no limit */
    uint64_t steps;     /* as of render_step(): halts then; 0: does not */
    /* pixels of the draft, as many as are shown; it has no more than the film,
     * and there is none without columns or rows */
    int draft_width, draft_height;
};

enum render_state {
    RENDER_IDLE, /* nothing started, or halted */
    RENDER_RUNNING,
    RENDER_DONE,  /* spp reached */
    RENDER_FAILED /* see error */
};

struct render_progress {
    enum render_state state;
    uint64_t spp_limit;     /* 0: none */
    uint64_t spp_done;      /* that every pixel has */
    uint64_t samples;       /* of all pixels together */
    uint64_t samples_limit; /* 0: none */
    uint64_t draft_samples; /* of the draft, not among the others */
    bool draft_is_coarse;   /* it has pixels without a sample */
    uint64_t rays;
    uint64_t non_finite;
    uint64_t saturated;
    uint64_t cut_paths;
    uint64_t render_ns;        /* from start to now, or to the end */
    uint64_t build_ns;         /* the backend's load() */
    uint64_t first_picture_ns; /* from start until every pixel, of the draft if
                                  there is one, has a sample on the coarsest
                                  grid; 0: not yet */
    struct error error;
};

struct render;

struct render *render_create(struct backend *backend, struct error *err);

/* Halts what runs, clears the film and starts. Returns at once when the old
 * workers are parked; building and rendering go on in the render thread. */
bool render_start(struct render *r, const struct render_job *job,
                  struct error *err);

/* Halts what runs; from the next start on, which loads the geometry anew, this
 * backend renders. */
void render_use(struct render *r, struct backend *backend);

/* Returns when every worker is parked; the film keeps what it has. */
void render_halt(struct render *r);

/* Goes on after render_halt() where it stopped. `spp` is the new limit. */
void render_resume(struct render *r, uint64_t spp);

/* One more sample of every pixel, and one more still if it is under way; then
 * halts by itself. False if the render is done or has failed. */
bool render_step(struct render *r);

/* Blocks until the state is not RENDER_RUNNING or timeout_ms has passed (-1:
 * no limit). True if it is not running. */
bool render_wait(struct render *r, int timeout_ms);

/* A file descriptor that becomes readable when the state changes from
 * RENDER_RUNNING; read it empty. */
int render_event_fd(const struct render *r);

struct render_progress render_progress(struct render *r);

/* For reading: film_preview(), film_resolve(), film_linear(), image_write().
 * Valid until the next render_start() with another size. */
struct film *render_film(struct render *r);

/* The draft, to be shown with the film by film_preview() as long as that is
 * young; NULL: none. Valid until the next render_start(). */
struct film *render_draft(struct render *r);
struct backend *render_backend(const struct render *r);

void render_destroy(struct render *r);

#endif
