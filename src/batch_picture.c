// SPDX-License-Identifier: MIT
#include "batch_picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/glim.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/print.h"
#include "base/stop.h"
#include "terminal/xmalloc.h"
#include "session/frame_series.h"
#include "batch_filter.h"
#include "batch_handle.h"
#include "batch_progress.h"

bool batch_picture_is_wanted(const struct options *o)
{
    return o->batch && !frame_series_is_wanted(o) && o->show == SHOW_LIGHT &&
           o->text_cols == 0 && !o->stats_path && !o->error_map_path &&
           o->aovs == 0 && !o->paths && !o->kernels_path && !o->film_path &&
           !o->checkpoint_path && !o->resume_path;
}

static bool on_progress(void *bar, const struct glim_progress *p)
{
    batch_bar_draw(bar, p);
    return true;
}

/* A device that fails is replaced by the CPU, which starts anew. */
static bool render(struct glim *g, const struct options *o, bool has_device,
                   struct error *err)
{
    struct render_limits limits = options_limits(o);
    struct batch_bar bar = batch_bar_begin();
    struct glim_error why;
    enum glim_result result;

    if (!glim_set_error_limit(g, limits.error, &why))
        return batch_fail_as(err, &why);
    glim_set_adaptive(g, options_adaptive(o));
    result = glim_render(g, limits.spp, seconds_between(0, limits.time_ns),
                         bar.is_wanted ? on_progress : NULL, &bar, &why);

    batch_bar_erase(&bar);
    if (result != GLIM_FAILED)
        return true;
    if (!has_device)
        return batch_fail_as(err, &why);
    batch_warn_of_device(why.text);
    return glim_set_backend(g, GLIM_BACKEND_CPU, NULL, &why)
               ? render(g, o, false, err)
               : batch_fail_as(err, &why);
}

/* Returns the name for messages, or NULL. */
static const char *write_picture(struct glim *g, const struct options *o,
                                 struct error *err)
{
    const char *path = o->output_path;
    struct glim_error why;
    const char *name = path;
    char *stem;

    if (path) {
        if (!glim_save(g, path, &why))
            name = NULL;
        else if (strcmp(path, "-") == 0)
            name = "standard output";
    } else {
        stem = xchecked(path_stem_of_input(o->scene_path));
        name = strrchr(stem, '/');
        name = glim_save_new(g, name ? name + 1 : stem, &why);
        free(stem);
    }
    if (!name)
        batch_fail_as(err, &why);
    return name;
}

/* Writes the filtered picture to its own file, or lets write_picture() write
 * it. */
static bool write_filtered(struct glim *g, const struct options *o,
                           struct error *err)
{
    const char *path = o->denoise_path;
    struct glim_error why;

    if (!glim_is_denoised(g)) {
        batch_filter_warn();
        return true;
    }
    if (!path)
        return true;
    if (!glim_save(g, path, &why) || !glim_set_denoise(g, false, &why))
        return batch_fail_as(err, &why);
    batch_filter_say(path);
    return true;
}

static bool save(struct glim *g, const struct options *o, uint64_t start_ns,
                 struct error *err)
{
    struct glim_progress p = glim_get_progress(g);
    const char *name;
    int width, height;

    if (p.samples == 0) {
        /* an old picture is worth more than a black one */
        return batch_say_empty(err);
    }
    if (o->denoise && !write_filtered(g, o, err))
        return false;
    name = write_picture(g, o, err);
    if (!name)
        return false;
    glim_get_picture_size(g, &width, &height);
    batch_say_result(name, width, height, &p, o, start_ns);
    return true;
}

static bool save_held(struct glim *g, const struct options *o,
                      uint64_t start_ns, struct error *err)
{
    bool ok;

    stop_hold();
    ok = save(g, o, start_ns, err);
    stop_release();
    return ok;
}

/* Checks before the render that the files can be written. */
static bool check_outputs(struct glim *g, const struct options *o,
                          struct error *err)
{
    return (!o->output_path ||
            batch_handle_spares(g, "-o", o->output_path, err)) &&
           (!o->denoise_path ||
            (batch_handle_spares(g, "--denoise", o->denoise_path, err) &&
             batch_check_picture(o->denoise_path, err))) &&
           batch_check_picture(o->output_path, err);
}

static bool run(struct glim *g, const struct options *o, uint64_t start_ns,
                struct error *err)
{
    bool wants_device = o->backend != BACKEND_CPU;
    struct glim_error why;
    int wake_fd;

    if (!check_outputs(g, o, err))
        return false;
    if (!glim_set_denoise(g, o->denoise, &why))
        return batch_fail_as(err, &why);
    /* before our signals are set: drivers put theirs over them */
    if (wants_device && !batch_handle_use_device(g, o, err))
        return false;
    return batch_catch_signals(g, &wake_fd, err) &&
           render(g, o, wants_device, err) && save_held(g, o, start_ns, err);
}

bool batch_picture_run(const struct options *o, uint64_t start_ns, int *status,
                       struct error *err)
{
    struct glim *g = batch_handle_open(o, err);
    bool ok = g != NULL && run(g, o, start_ns, err);

    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    glim_close(g);
    return ok;
}
