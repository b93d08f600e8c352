// SPDX-License-Identifier: MIT
#include "batch_picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/glim.h"

#include "base/file.h"
#include "base/print.h"
#include "terminal/xmalloc.h"
#include "session/file_watch.h"
#include "batch_progress.h"

bool batch_picture_is_wanted(const struct options *o)
{
    return o->batch && o->show == SHOW_LIGHT && o->text_cols == 0 &&
           !o->stats_path && !o->paths && !o->kernels_path;
}

static bool fail_as(struct error *err, const struct glim_error *why)
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
        return fail_as(err, &why);
    if (o->has_crop && !glim_set_crop(g, c->x, c->y, c->width, c->height, &why))
        return fail(err, "--%s", why.text);
    if (o->has_max_bounces && !glim_set_max_bounces(g, o->max_bounces, &why))
        return fail_as(err, &why);
    glim_set_seed(g, o->seed);
    return true;
}

/* Finds mistakes before minutes of rendering. */
static bool check_output(const struct glim *g, const char *path,
                         struct error *err)
{
    struct file_watch files;
    const char *name;
    bool ok;

    file_watch_init(&files);
    for (int i = 0; (name = glim_file(g, i)) != NULL; i++)
        file_watch_add(&files, name);
    ok = !path || file_watch_spares(&files, "-o", path, err);
    file_watch_free(&files);
    return ok && batch_check_picture(path, err);
}

/* Brings up the device that the options want. If it fails, the CPU renders,
 * unless the options name the device. A missing GPU is not reported if glim
 * chooses. */
static bool use_device(struct glim *g, const struct options *o,
                       struct error *err)
{
    bool is_auto = o->backend == BACKEND_AUTO;
    struct glim_error why;
    const char *log;

    if (!glim_set_program(g, "/proc/self/exe", &why))
        return fail_as(err, &why);
    if (glim_set_backend(g, is_auto ? GLIM_BACKEND_GPU : GLIM_BACKEND_OPENCL,
                         o->device, &why))
        return true;
    log = glim_backend_log(g);
    if (log && (o->device || !is_auto))
        print_lines(stderr, log);
    if (o->device)
        return fail_as(err, &why);
    if (!is_auto)
        batch_warn_of_device(why.text);
    return true;
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
    struct batch_bar bar = batch_bar_begin();
    struct glim_error why;
    enum glim_result result =
        glim_render(g, o->spp, 0, bar.is_wanted ? on_progress : NULL, &bar,
                    &why);

    batch_bar_erase(&bar);
    if (result != GLIM_FAILED)
        return true;
    if (!has_device)
        return fail_as(err, &why);
    batch_warn_of_device(why.text);
    return glim_set_backend(g, GLIM_BACKEND_CPU, NULL, &why)
               ? render(g, o, false, err)
               : fail_as(err, &why);
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
        stem = xchecked(path_stem(o->scene_path));
        name = strrchr(stem, '/');
        name = glim_save_new(g, name ? name + 1 : stem, &why);
        free(stem);
    }
    if (!name)
        fail_as(err, &why);
    return name;
}

static bool save(struct glim *g, const struct options *o, uint64_t start_ns,
                 struct error *err)
{
    struct glim_progress p = glim_get_progress(g);
    const char *name;
    int width, height;

    if (p.samples == 0) {
        /* an old picture is worth more than a black one */
        batch_say_empty();
        return true;
    }
    name = write_picture(g, o, err);
    if (!name)
        return false;
    glim_get_picture_size(g, &width, &height);
    batch_say_result(name, width, height, &p, start_ns);
    return true;
}

static bool run(struct glim *g, const struct options *o, uint64_t start_ns,
                struct error *err)
{
    const char *line;
    bool wants_device = o->backend != BACKEND_CPU;
    int wake_fd;

    if (!set_up(g, o, err))
        return false;
    for (int i = 0; (line = glim_warning(g, i)) != NULL; i++)
        print_line(stderr, "glim: warning: %s", line);
    if (!check_output(g, o->output_path, err))
        return false;
    /* before our signals are set: drivers put theirs over them */
    if (wants_device && !use_device(g, o, err))
        return false;
    return batch_catch_signals(g, &wake_fd, err) &&
           render(g, o, wants_device, err) && save(g, o, start_ns, err);
}

bool batch_picture_run(const struct options *o, uint64_t start_ns, int *status,
                       struct error *err)
{
    struct glim_open_options how = {
        .view_path = o->view_path,
        .up = o->up_is_z ? GLIM_UP_Z : GLIM_UP_Y,
        .threads = options_threads(o),
    };
    struct glim_error why;
    struct glim *g = glim_open(o->scene_path, &how, &why);
    bool ok = g != NULL ? run(g, o, start_ns, err) : fail_as(err, &why);

    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    glim_close(g);
    return ok;
}
