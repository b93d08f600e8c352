// SPDX-License-Identifier: MIT
/* Reading and saving the picture of a handle, and its film files. */
#include "api/handle.h"

#include <stdlib.h>

#include "engine/engine_film.h"
#include "engine/engine_metadata.h"
#include "film/film.h"
#include "film/image_write.h"

static struct develop develop_of(const struct glim *g)
{
    return (struct develop){(float)g->view.lighting.exposure,
                            g->view.lighting.tone};
}

bool glim_is_denoised(struct glim *g)
{
    return g != NULL && g->has_picture && g->engine.options.wants_filter &&
           engine_can_filter(&g->engine);
}

/* Returns the film or the filtered one, or NULL with an error if there is no
 * picture. */
static struct film *film_of(struct glim *g, struct glim_error *err)
{
    struct film *film = NULL;
    struct error why;

    if (!handle_given(g, "handle", err))
        return NULL;
    if (!g->has_picture)
        fail(&why, "picture: found none, expected glim_render() before");
    else if (!glim_is_denoised(g))
        film = render_film(g->engine.render);
    else
        film = engine_filtered(&g->engine, &why);
    if (film == NULL)
        handle_fail(err, &why);
    return film;
}

void glim_get_picture_size(const struct glim *g, int *width, int *height)
{
    const struct film *film =
        g != NULL && g->has_picture ? render_film(g->engine.render) : NULL;

    if (width != NULL)
        *width = film != NULL ? film->width : 0;
    if (height != NULL)
        *height = film != NULL ? film->height : 0;
}

static bool check_count(const struct film *film, size_t count,
                        struct glim_error *err)
{
    size_t expected = 3 * (size_t)film->width * (size_t)film->height;
    struct error why;

    if (count == expected)
        return true;
    fail(&why, "picture: found room for %zu numbers, expected %zu", count,
         expected);
    return handle_fail(err, &why);
}

bool glim_read_floats(struct glim *g, float *rgb, size_t count,
                      struct glim_error *err)
{
    struct film *film =
        handle_given(rgb, "picture", err) ? film_of(g, err) : NULL;

    if (film == NULL || !check_count(film, count, err))
        return false;
    film_linear(film, rgb);
    return true;
}

bool glim_read_bytes(struct glim *g, uint8_t *rgb, size_t count,
                     struct glim_error *err)
{
    struct film *film =
        handle_given(rgb, "picture", err) ? film_of(g, err) : NULL;
    struct frame frame;

    if (film == NULL || !check_count(film, count, err))
        return false;
    frame = (struct frame){.width = film->width,
                           .height = film->height,
                           .rgb = rgb};
    film_resolve(film, develop_of(g), &frame);
    return true;
}

bool glim_save(struct glim *g, const char *path, struct glim_error *err)
{
    struct film *film =
        handle_given(path, "file", err) ? film_of(g, err) : NULL;
    struct image_metadata metadata;
    struct error why;

    if (film == NULL)
        return false;
    metadata = engine_metadata(&g->engine, &g->view, glim_is_denoised(g));
    return image_write(film, develop_of(g), &metadata, path, &why) ||
           handle_fail(err, &why);
}

const char *glim_save_new(struct glim *g, const char *stem,
                          struct glim_error *err)
{
    struct film *film =
        handle_given(stem, "file", err) ? film_of(g, err) : NULL;
    struct image_metadata metadata;
    struct error why;
    char *name;

    if (film == NULL)
        return NULL;
    metadata = engine_metadata(&g->engine, &g->view, glim_is_denoised(g));
    name =
        image_write_numbered(film, develop_of(g), &metadata, stem, "png", &why);
    if (name == NULL) {
        handle_fail(err, &why);
        return NULL;
    }
    free(g->saved_name);
    g->saved_name = name;
    return name;
}

/* ---- films ---- */

/* The picture has the settings of the handle. */
static bool save(struct glim *g, const char *path, struct error *err)
{
    struct engine *e = &g->engine;
    struct film_range range;
    struct film_header h =
        engine_film_header(e, &g->view, 0, render_progress(e->render).spp_limit,
                           &range);

    if (!engine_film_identify(e, &g->view, &h.identity, err))
        return false;
    /* a picture that began for the filter stays when that is switched off */
    h.identity.has_surfaces = render_film(e->render)->surfaces != NULL;
    return engine_film_write(e, path, &h, err);
}

bool glim_save_film(struct glim *g, const char *path, struct glim_error *err)
{
    struct error why;

    if (!handle_given(g, "handle", err) || !handle_given(path, "film", err))
        return false;
    if (!g->has_picture)
        fail(&why, "picture: found none, expected glim_render() before");
    else if (save(g, path, &why))
        return true;
    return handle_fail(err, &why);
}

/* Reads files and joins them. The caller frees after a failure, too. */
static bool read_films(struct film_file *f, const char *const *paths, int count,
                       struct error *err)
{
    bool ok = film_file_read(f, paths[0], err);

    for (int i = 1; ok && i < count; i++)
        ok = film_file_join_read(f, paths[0], paths[i], err);
    return ok;
}

/* Checks that the film is one to go on with. */
static bool check(struct glim *g, const struct film_file *f, const char *path,
                  struct error *err)
{
    const struct film_header *h = &f->header;
    struct film_identity id;

    if (!engine_film_identify(&g->engine, &g->view, &id, err) ||
        !film_identity_check(&h->identity, path, &id, g->engine.scene.path,
                             err))
        return false;
    return (h->range_count == 1 && h->ranges[0].first == 0) ||
           fail(err,
                "%s: found a part of the samples, expected all from the first "
                "on, with those of other films",
                path);
}

bool glim_load_films(struct glim *g, const char *const *paths, int count,
                     struct glim_error *err)
{
    struct film_file f = {.shares = NULL};
    struct render_job job;
    struct error why;
    bool ok;

    if (!handle_given(g, "handle", err) || !handle_given(paths, "films", err))
        return false;
    for (int i = 0; i < count; i++)
        if (!handle_given(paths[i], "films", err))
            return false;
    if (count < 1) {
        fail(&why, "films: found %d, expected one at least", count);
        return handle_fail(err, &why);
    }
    ok = read_films(&f, paths, count, &why) && handle_prepare(g, &job, &why) &&
         check(g, &f, paths[0], &why);
    if (ok) {
        uint64_t spp = film_header_spp(&f.header);

        job.from = &f;
        job.limits.spp = spp > 0 ? spp : 1; /* it ends at once */
        ok = g->has_picture = engine_start(&g->engine, &job, &why);
    }
    if (ok) {
        render_wait(g->engine.render, -1);
        why = render_progress(g->engine.render).error;
        ok = g->has_picture =
            render_progress(g->engine.render).state != RENDER_FAILED;
    }
    film_file_free(&f);
    return ok || handle_fail(err, &why);
}
