// SPDX-License-Identifier: MIT
#include "session/autosave_writer.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/stop.h"
#include "engine/engine_film.h"
#include "film/film_file.h"
#include "session/autosave_file.h"

bool autosave_writer_init(struct autosave_writer *w, struct error *err)
{
    *w = (struct autosave_writer){.path = NULL};
    return background_init(&w->copying, "sessions", err);
}

/* A film that nobody adds to any more. */
struct copy {
    struct film film;
    uint16_t *shares; /* of adaptive sampling; NULL: not decided */
};

static bool copy_film(struct autosave_writer *w, struct copy *c)
{
    const uint16_t *shares;
    size_t size;

    if (!film_copy(&c->film, render_film(w->render), &w->error) ||
        !engine_film_hash(&w->world, w->kernels_path, &w->header.identity,
                          &w->error))
        return false;
    /* after the copy, whose samples may depend on them */
    shares = render_shares(w->render);
    if (shares == NULL)
        return true;
    size = (size_t)c->film.width * (size_t)c->film.height * sizeof *shares;
    c->shares = malloc(size);
    if (c->shares == NULL)
        return fail(&w->error, "%s: out of memory", w->path);
    memcpy(c->shares, shares, size);
    return true;
}

static const uint16_t *shares_of(void *context)
{
    return ((const struct copy *)context)->shares;
}

/* Packs the film, unless it is too large. */
static bool pack_film(struct autosave_writer *w, struct copy *c)
{
    size_t size;
    char *bytes =
        film_file_bytes(&w->header, &c->film, shares_of, c, &size, &w->error);

    if (bytes == NULL)
        return false;
    w->is_film_left_out = size > AUTOSAVE_FILM_BYTES_MAX;
    if (w->is_film_left_out) {
        free(bytes);
        return true;
    }
    w->kept.parts[AUTOSAVE_FILM] = bytes;
    w->kept.sizes[AUTOSAVE_FILM] = size;
    w->kept.render_ns = w->header.render_ns;
    return true;
}

static bool write_file(struct autosave_writer *w)
{
    size_t size;
    char *bytes = autosave_file_bytes(&w->kept, &size);
    bool ok = bytes != NULL
                  ? file_write(w->path, bytes, size, false, NULL, &w->error)
                  : fail(&w->error, "%s: out of memory", w->path);

    free(bytes);
    return ok;
}

/* Without the film, for which memory may be out, the rest is written. */
static void work(void *context)
{
    struct autosave_writer *w = context;
    struct copy copy = {.shares = NULL};
    bool ok;

    stop_hold();
    ok = !w->has_film || copy_film(w, &copy);
    background_has_copied(&w->copying);
    if (ok && w->has_film)
        ok = pack_film(w, &copy);
    film_free(&copy.film);
    free(copy.shares);
    w->is_written = write_file(w) && ok;
    autosave_prune(w->path, AUTOSAVE_DAYS_MAX, AUTOSAVE_BYTES_MAX);
    stop_release();
}

bool autosave_writer_begin(struct autosave_writer *w, struct session *s,
                           struct autosave_file *k, const char *path,
                           bool has_film, struct error *err)
{
    struct engine *e = &s->engine;
    struct view view = edit_view(&s->edit);
    const struct film *film = render_film(e->render);
    uint64_t pixels = (uint64_t)film->width * (uint64_t)film->height;

    w->kept = *k;
    *k = (struct autosave_file){.scene = NULL}; /* the writer owns it now */
    w->path = path;
    w->render = e->render;
    w->kernels_path = s->options->kernels_path;
    w->is_film_left_out =
        has_film && pixels * FILM_PIXEL_BYTES > AUTOSAVE_COPY_BYTES_MAX;
    w->has_film = has_film && !w->is_film_left_out;
    w->header =
        engine_film_header(e, &view, 0, render_progress(e->render).spp_limit,
                           &w->range);
    if ((!w->has_film ||
         engine_film_describe(e, &view, &w->header.identity, &w->world, err)) &&
        background_begin(&w->copying, work, w, path, err))
        return true;
    autosave_file_free(&w->kept);
    return false;
}

bool autosave_writer_finish(struct autosave_writer *w, bool *is_film_left_out,
                            struct error *err)
{
    background_finish(&w->copying);
    autosave_file_free(&w->kept);
    *is_film_left_out = w->is_film_left_out;
    if (!w->is_written)
        *err = w->error;
    return w->is_written;
}

void autosave_writer_free(struct autosave_writer *w)
{
    struct error ignored;
    bool is_film_left_out;

    if (w->copying.is_busy)
        autosave_writer_finish(w, &is_film_left_out, &ignored);
    background_free(&w->copying);
}
