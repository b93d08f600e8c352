// SPDX-License-Identifier: MIT
#include "batch_handle.h"

#include <stdio.h>

#include "base/print.h"
#include "session/file_watch.h"
#include "batch_progress.h"

bool batch_fail_as(struct error *err, const struct glim_error *why)
{
    return fail(err, "%s", why->text);
}

/* Applies the options of the picture. */
static bool set_up(struct glim *g, const struct options *o, struct error *err)
{
    const struct rect *c = &o->crop;
    struct glim_error why;

    if ((o->width_px != 0 || o->height_px != 0) &&
        !glim_set_size(g, o->width_px, o->height_px, &why))
        return batch_fail_as(err, &why);
    if (o->has_crop && !glim_set_crop(g, c->x, c->y, c->width, c->height, &why))
        return fail(err, "--%s", why.text);
    if (o->has_max_bounces && !glim_set_max_bounces(g, o->max_bounces, &why))
        return batch_fail_as(err, &why);
    glim_set_seed(g, o->seed);
    return true;
}

struct glim *batch_handle_open(const struct options *o, struct error *err)
{
    struct glim_sun sun = {o->sun_azimuth_deg, o->sun_elevation_deg};
    struct glim_open_options how = {
        .view_path = o->view_path,
        .sun = o->has_sun ? &sun : NULL,
        .turbidity = o->turbidity,
        .up = (enum glim_up)o->up,
        .camera = o->camera,
        .scene = o->choice.scene,
        .animation = o->choice.animation,
        .variant = o->choice.variant,
        .has_anim_time = o->choice.has_time,
        .anim_time_s = o->choice.time_s,
        .view_lines = o->view_lines,
        .threads = options_threads(o),
        .program = "/proc/self/exe",
    };
    struct glim_error why;
    struct glim *g = glim_open(o->scene_path, &how, &why);
    const char *line;

    if (g == NULL) {
        batch_fail_as(err, &why);
        return NULL;
    }
    if (!set_up(g, o, err)) {
        glim_close(g);
        return NULL;
    }
    for (int i = 0; (line = glim_warning(g, i)) != NULL; i++)
        print_line(stderr, "glim: warning: %s", line);
    return g;
}

bool batch_handle_spares(const struct glim *g, const char *option,
                         const char *path, struct error *err)
{
    struct file_watch files;
    const char *name;
    bool ok;

    file_watch_init(&files);
    for (int i = 0; (name = glim_file(g, i)) != NULL; i++)
        file_watch_add(&files, name);
    ok = file_watch_spares(&files, option, path, err);
    file_watch_free(&files);
    return ok;
}

bool batch_handle_use_device(struct glim *g, const struct options *o,
                             struct error *err)
{
    bool is_auto = o->backend == BACKEND_AUTO;
    struct glim_error why;
    const char *log;

    if (glim_set_backend(g, is_auto ? GLIM_BACKEND_GPU : GLIM_BACKEND_OPENCL,
                         o->device, &why))
        return true;
    log = glim_backend_log(g);
    if (log && (o->device || !is_auto))
        print_lines(stderr, log);
    if (o->device)
        return batch_fail_as(err, &why);
    if (!is_auto)
        batch_warn_of_device(why.text);
    return true;
}
