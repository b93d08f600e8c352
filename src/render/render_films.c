// SPDX-License-Identifier: MIT
#include "render/render_films.h"

#include <string.h>

#include "render/projection.h"
#include "render/render_loop.h"

#include "kernels/rng.h"

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

bool render_films_reset(struct render_films *f, const struct render_job *job,
                        struct error *err)
{
    if (!reset_film(&f->film, job->crop.width, job->crop.height,
                    has_surfaces(job), err) ||
        !reset_draft(&f->draft, job, err) ||
        !reset_adaptive(&f->adaptive, job, err))
        return false;
    f->film.first_sample = job->first_sample;
    if (job->from != NULL)
        take_file(f, job->from);
    return true;
}

struct world render_films_draft_world(const struct render_films *f,
                                      const struct render_job *job)
{
    struct world w = job->world;
    struct projection_part part = {job->crop.x,     job->crop.y,
                                   job->crop.width, job->crop.height,
                                   f->draft.width,  f->draft.height};

    w.settings.camera = projection_camera(&w.settings.camera, &part);
    w.settings.order = ORDER_DRAFT;
    if (job->draft_has_surfaces) {
        w.settings.order = ORDER_DRAFT_HALVES;
        w.settings.features |= FEATURE_FILTER;
    }
    return w;
}

bool render_films_want_light(const struct render_job *job)
{
    return job->world.settings.sample == SAMPLE_LIGHT;
}

uint64_t render_films_draft_spp(const struct render_job *job)
{
    if (!render_films_want_light(job))
        return 1;
    return job->draft_has_surfaces ? DRAFT_HALVES_SPP : DRAFT_SPP;
}

void render_films_count(const struct render_films *f, struct render_progress *p)
{
    p->is_adaptive = f->adaptive.shares != NULL;
    p->pixels = (uint64_t)f->film.width * (uint64_t)f->film.height;
    p->samples = atomic_load(&f->film.samples);
    p->samples_limit = p->spp_limit * p->pixels;
    p->draft_samples = atomic_load(&f->draft.samples);
    p->rays = atomic_load(&f->film.rays);
    p->non_finite = atomic_load(&f->film.non_finite);
    p->saturated = atomic_load(&f->film.saturated);
    p->cut_paths = atomic_load(&f->film.cut_paths);
}

void render_films_free(struct render_films *f)
{
    film_free(&f->film);
    film_free(&f->draft);
    adaptive_free(&f->adaptive);
}
