// SPDX-License-Identifier: MIT
/*
 * render_films.h - the films that a render fills
 *
 * Ownership: render_films_free() frees; a zeroed struct is empty
 * Threads:   between runs
 * Errors:    out of memory
 */
#ifndef GLIM_RENDER_FILMS_H
#define GLIM_RENDER_FILMS_H

#include "picture/adaptive.h"
#include "picture/film.h"
#include "kernels/types.h"

struct render_job;
struct render_progress;

struct render_films {
    struct film film;
    struct film draft;        /* width 0: there is no draft */
    struct adaptive adaptive; /* empty: the render is not adaptive */
};

/* Clears the films for a new picture, with the sizes that the job wants. */
bool render_films_reset(struct render_films *f, const struct render_job *job,
                        struct error *err);

/* Returns the world of the draft: the crop at the draft's resolution. */
struct world render_films_draft_world(const struct render_films *f,
                                      const struct render_job *job);

/* Returns whether samples are light, which fills the film. Others fill only a
 * draft. */
bool render_films_want_light(const struct render_job *job);

/* Returns the samples per pixel of a draft. Those that are not light are all
 * equal, so one suffices. */
uint64_t render_films_draft_spp(const struct render_job *job);

/* Copies counters and sizes into the progress, whose limits are set. */
void render_films_count(const struct render_films *f,
                        struct render_progress *p);

void render_films_free(struct render_films *f);

#endif
