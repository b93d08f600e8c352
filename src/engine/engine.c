// SPDX-License-Identifier: MIT
#include "engine/engine.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "film/filter/film_filter.h"
#include "read/view_parse.h"
#include "render/cluster/cluster.h"
#include "render/cpu_dispatch.h"
#include "kernels/features.h"

/* ---- backends ---- */

/* Lets all ranks of a cluster render what this backend is given. A worker gets
 * its work from rank 0. */
static bool share_out(struct backend **b, struct error *err)
{
    struct backend *cluster;

    if (cluster_size() == 1 || cluster_rank() > 0)
        return true;
    cluster = cluster_backend_create(*b, err);
    if (cluster != NULL)
        *b = cluster;
    return cluster != NULL;
}

void backends_drop_cpu(struct backends *b)
{
    if (b->cpu != NULL)
        b->cpu->destroy(b->cpu);
    b->cpu = NULL;
}

bool backends_open(struct backends *b, const struct cpu_kernel *kernel,
                   int thread_count, struct error *err)
{
    b->cpu =
        backend_cpu_create(thread_count,
                           kernel != NULL ? kernel : cpu_kernel_best(), err);
    if (b->cpu != NULL && share_out(&b->cpu, err))
        return true;
    backends_drop_cpu(b);
    return false;
}

bool backends_begin_device(struct backends *b, const struct cl_request *request,
                           struct error *err)
{
    b->features = request->features;
    b->start = cl_start_begin(request, b->raw_device, err);
    return b->start != NULL;
}

bool backends_end_device(struct backends *b, char **log, struct error *err)
{
    free(b->verdict);
    b->raw_device = cl_start_end(b->start, &b->verdict, log, err);
    b->start = NULL;
    b->device = b->raw_device;
    return b->device != NULL && share_out(&b->device, err);
}

void backends_specialise(struct backends *b, const struct cl_request *request)
{
    struct error ignored;

    if (b->device != NULL && b->start == NULL &&
        b->features != request->features)
        backends_begin_device(b, request, &ignored);
}

bool backends_end_specialising(struct backends *b)
{
    struct error ignored;
    char *verdict, *log;

    if (b->device == NULL)
        return false;
    cl_start_end(b->start, &verdict, &log, &ignored);
    b->start = NULL;
    free(verdict);
    free(log);
    return true;
}

void backends_abandon_device(struct backends *b)
{
    if (b->start != NULL)
        cl_start_abandon(b->start);
    b->start = NULL;
}

void backends_drop_device(struct backends *b)
{
    backends_abandon_device(b);
    if (b->device != NULL)
        b->device->destroy(b->device);
    b->device = b->raw_device = NULL;
    free(b->verdict);
    b->verdict = NULL;
}

void backends_close(struct backends *b)
{
    backends_drop_device(b);
    backends_drop_cpu(b);
}

/* ---- load ---- */

/* Overrides values of the view file by those of the options. */
static bool apply_options(const struct engine_options *o, struct view *view,
                          struct error *err)
{
    if (o->width_px != 0 || o->height_px != 0)
        view_set_size(view, o->width_px, o->height_px);
    if (o->has_max_bounces)
        view->max_bounces = o->max_bounces;
    if (o->has_sun &&
        !view_set_sun(view, o->sun_azimuth_deg, o->sun_elevation_deg, err))
        return false;
    return o->turbidity == 0 || view_set_turbidity(view, o->turbidity, err);
}

bool engine_set_crop(struct engine *e, const struct view *view,
                     const struct rect *crop, const char *place,
                     struct error *err)
{
    int x = crop->x, y = crop->y, width = crop->width, height = crop->height;

    if (!view_has_part(view, x, y, width, height))
        return fail(err,
                    "%s: found %d,%d,%d,%d, expected a part of the picture, "
                    "which has %dx%d pixels",
                    place, x, y, width, height, view->width_px,
                    view->height_px);
    e->crop = *crop;
    return true;
}

void engine_set_whole(struct engine *e, const struct view *view)
{
    e->crop = (struct rect){0, 0, view->width_px, view->height_px};
}

/* Finds the view, of a text or in files. */
static bool find_view(struct engine *e, struct view *view, struct error *err)
{
    const struct engine_options *o = &e->options;

    if (o->view_text == NULL)
        return view_find(view, o->scene.path, o->view_path, &e->view_path,
                         &e->report, err);
    /* a name for messages; names of files in the text are as seen from there */
    e->view_path = path_beside(o->scene.path, "view of the picture");
    return e->view_path != NULL
               ? view_parse(view, o->view_text, strlen(o->view_text),
                            e->view_path, &e->report, err)
               : fail(err, "%s: out of memory", o->scene.path);
}

bool engine_load(struct engine *e, const struct engine_options *options,
                 struct view *view, struct view *file, struct error *err)
{
    *e = (struct engine){.options = *options,
                         .scene = {.program = options->device.program}};
    if (!find_view(e, view, err))
        return false;
    view_copy_frame(file, view);
    if (!apply_options(options, view, err))
        return false;
    engine_set_whole(e, view);
    return (!options->has_crop ||
            engine_set_crop(e, view, &options->crop, "--crop", err)) &&
           scene_open(&e->scene, &e->world, view, &options->scene, &e->report,
                      err);
}

void engine_take_loaded(struct engine *e, struct engine *fresh)
{
    bool has_same_shape = scene_has_same_shape(&e->scene, &fresh->scene);
    struct engine old = *e;

    render_halt(e->render);
    e->scene = fresh->scene;
    e->world = fresh->world;
    e->crop = fresh->crop;
    e->report = fresh->report;
    e->options.scene.choice = fresh->options.scene.choice;
    fresh->scene = old.scene;
    fresh->world = old.world;
    fresh->crop = old.crop;
    fresh->report = old.report;
    fresh->options.scene.choice = old.options.scene.choice;
    if (has_same_shape)
        world_take_shape(&e->world, &fresh->world);
}

/* ---- backends of a picture ---- */

bool engine_begin(struct engine *e, struct error *err)
{
    const struct engine_options *o = &e->options;

    if (e->render != NULL)
        return true;
    if (e->backends.device == NULL &&
        !backends_open(&e->backends, o->kernel, o->scene.thread_count, err))
        return false;
    e->render = render_create(e->backends.device != NULL ? e->backends.device
                                                         : e->backends.cpu,
                              err);
    if (e->render == NULL)
        backends_drop_cpu(&e->backends); /* the next call creates it again */
    return e->render != NULL;
}

static void drop_filtered(struct engine *e)
{
    film_free(&e->filtered);
    e->filtered_samples = 0;
}

void engine_end(struct engine *e)
{
    if (e->render != NULL)
        render_destroy(e->render);
    e->render = NULL;
    backends_drop_cpu(&e->backends);
    drop_filtered(e);
}

uint64_t engine_features(const struct engine *e, const struct view *view)
{
    return world_features(&e->world) | view_features(view) |
           (e->options.wants_filter ? FEATURE_FILTER : 0) |
           (e->options.is_exact ? 0 : FEATURE_RADIANCE_CELLS) |
           (e->world.light_paths.sources != NULL ? FEATURE_LIGHT_PATHS : 0);
}

struct cl_request engine_request(const struct engine *e, uint64_t features)
{
    struct cl_request request = e->options.device;

    request.features = features;
    return request;
}

bool engine_use_device(struct engine *e, const struct view *view, char **log,
                       struct error *err)
{
    struct cl_request request;

    *log = NULL;
    /* first, since the guide adds a feature that the kernels must have */
    if (!world_guide(&e->world, &e->scene, view, err))
        return false;
    request = engine_request(e, engine_features(e, view));
    if (!backends_begin_device(&e->backends, &request, err) ||
        !backends_end_device(&e->backends, log, err))
        return false;
    if (e->render != NULL)
        render_set_backend(e->render, e->backends.device);
    return true;
}

void engine_use_cpu(struct engine *e)
{
    render_set_backend(e->render, e->backends.cpu);
}

bool engine_uses_device(const struct engine *e)
{
    return render_backend(e->render) != e->backends.cpu;
}

/* ---- pictures ---- */

bool engine_lend(const struct engine *e, const struct view *view,
                 struct world *world, struct error *err)
{
    if (!world_lend(&e->world, &e->scene, view, e->options.seed, world, err))
        return false;
    world->settings.has_light_cells = !e->options.is_exact;
    return true;
}

bool engine_prepare(struct engine *e, const struct view *view,
                    struct render_job *job, struct error *err)
{
    *job = (struct render_job){.host = &e->world,
                               .crop = e->crop,
                               .exposure = (float)view->lighting.exposure,
                               .is_adaptive = e->options.is_adaptive};
    if (!engine_begin(e, err) ||
        !world_guide(&e->world, &e->scene, view, err) ||
        !engine_lend(e, view, &job->world, err))
        return false;
    job->world.settings.features = engine_features(e, view);
    return true;
}

bool engine_start(struct engine *e, const struct render_job *job,
                  struct error *err)
{
    drop_filtered(e);
    return render_start(e->render, job, err);
}

bool engine_can_filter(const struct engine *e)
{
    return film_filter_applies(render_film(e->render));
}

struct film *engine_filtered(struct engine *e, struct error *err)
{
    struct film *film = render_film(e->render);
    uint64_t samples = atomic_load(&film->samples);

    if (e->filtered_samples == samples)
        return &e->filtered;
    drop_filtered(e);
    if (!film_filter_copy(film, e->options.scene.thread_count, &e->filtered,
                          err))
        return NULL;
    e->filtered_samples = samples;
    return &e->filtered;
}

void engine_close(struct engine *e)
{
    engine_end(e); /* first, since the renderer reads the scene */
    backends_close(&e->backends);
    world_free(&e->world);
    scene_free(&e->scene);
    warnings_free(&e->report);
    free(e->view_path);
    *e = (struct engine){.render = NULL};
}
