// SPDX-License-Identifier: MIT
/* Film files of a handle's picture. */
#include "api/handle.h"

#include <stdlib.h>

#include "opencl/cl_source.h"
#include "picture/film_file.h"
#include "render/film_describe.h"
#include "scene/world_hash.h"

static bool identify(const struct glim *g, const struct world *world,
                     struct film_identity *id, struct error *err)
{
    char *kernels = cl_source_text(NULL, err);

    if (kernels == NULL)
        return false;
    *id = film_describe_identity(&g->view, g->crop, g->seed,
                                 world->settings.features, g->is_adaptive);
    world_hash(world, id->hashes);
    id->hashes[FILM_KERNELS] = cl_source_hash(kernels);
    free(kernels);
    return true;
}

static const uint16_t *shares_of(void *render)
{
    return render_shares(render);
}

/* The picture has the settings of the handle. */
static bool save(struct glim *g, const char *path, struct error *err)
{
    struct render_progress p = render_progress(g->render);
    struct film_range range;
    struct film_header h =
        film_describe_header(&p, g->scene.path, 0, p.spp_limit, &range);
    struct render_job job;

    h.tone = g->view.lighting.tone;
    if (!handle_prepare(g, &job, err) ||
        !identify(g, &job.world, &h.identity, err))
        return false;
    /* a picture that began for the filter stays when that is switched off */
    h.identity.has_surfaces = render_film(g->render)->surfaces != NULL;
    return film_file_write(path, &h, render_film(g->render), shares_of,
                           g->render, err);
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
static bool check(const struct glim *g, const struct film_file *f,
                  const struct world *world, const char *path,
                  struct error *err)
{
    const struct film_header *h = &f->header;
    struct film_identity id;

    if (!identify(g, world, &id, err) ||
        !film_identity_check(&h->identity, path, &id, g->scene.path, err))
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
         check(g, &f, &job.world, paths[0], &why);
    if (ok) {
        uint64_t spp = film_header_spp(&f.header);

        job.from = &f;
        job.limits.spp = spp > 0 ? spp : 1; /* it ends at once */
        ok = handle_start(g, &job, &why);
    }
    if (ok) {
        render_wait(g->render, -1);
        why = render_progress(g->render).error;
        ok = g->has_picture = render_progress(g->render).state != RENDER_FAILED;
    }
    film_file_free(&f);
    return ok || handle_fail(err, &why);
}
