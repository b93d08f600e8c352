// SPDX-License-Identifier: MIT
#include "session/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "scene/world_lamps.h"
#include "load/scene_load.h"
#include "terminal/xmalloc.h"

/* Overrides values of the view file by those of the command line. */
static bool apply_options(const struct options *o, struct view *view,
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

/* Returns the first warning about faces: why there are none, with the line of
 * the file if it has some. */
static const char *face_warning(const struct warnings *report)
{
    for (int i = 0; i < report->entry_count; i++)
        if (strstr(report->entries[i].kind, "face") != NULL ||
            strstr(report->entries[i].kind, "triangle") != NULL)
            return report->entries[i].text;
    return "only the background is rendered";
}

/* Puts the additions of scene_open() into the notice. */
static void note_additions(struct session *s)
{
    if (s->scene.tri_count == 0)
        snprintf(s->notice, sizeof s->notice, "no faces: %s",
                 face_warning(&s->report));
    else if (view_has_soft_sky(&s->edit.now.view))
        snprintf(s->notice, sizeof s->notice,
                 "no light in the scene: lit by a soft sky");
    else if (warnings_have(&s->report, SCENE_LITTLE_LIGHT))
        snprintf(s->notice, sizeof s->notice, "its own light shows little%s",
                 s->scene.has_own_mtl ? ": lit as a studio" : "");
}

/* Sets the rectangle to render. Returns false if it is not in the picture. */
static bool find_crop(struct session *s, const struct view *view,
                      struct error *err)
{
    const struct rect *c = &s->options->crop;
    int width = view->width_px;
    int height = view->height_px;

    s->crop = (struct rect){0, 0, width, height};
    if (!s->options->has_crop)
        return true;
    if (!view_has_part(view, c->x, c->y, c->width, c->height))
        return fail(err,
                    "--crop: found %d,%d,%d,%d, expected a part of the "
                    "picture, which has %dx%d pixels",
                    c->x, c->y, c->width, c->height, width, height);
    s->crop = *c;
    return true;
}

/* Updates the world to the shown state of the edit, whose view is *view. If the
 * sky image cannot be read, the previous one stays and the notice says so. */
static bool apply_edit(struct session *s, const struct view *view,
                       struct error *err)
{
    const struct edit_state *shown = edit_shown(&s->edit);
    struct error why;

    if (!world_set_materials(&s->world, &s->scene, s->edit.material_count,
                             shown->sources, shown->assigned, err))
        return false;
    if (!world_has_sky(&s->world, view)) {
        s->files_version++;
        if (!world_load_sky(&s->world, view, &s->report, &why))
            snprintf(s->notice, sizeof s->notice, "%.255s", why.text);
    }
    return world_set_lamps(&s->world, &s->scene, view, err) &&
           world_guide(&s->world, &s->scene, view, err);
}

/* Reads the scene and its view. edit.saved keeps size and bounces of the file;
 * *view has those of the options. */
static bool open_scene(struct session *s, struct view *view, struct error *err)
{
    const struct options *o = s->options;
    struct scene_options how = {.up = o->up,
                                .thread_count = options_threads(o),
                                .camera = o->camera,
                                .choice = o->choice,
                                .view_lines = o->view_lines};
    struct view file;

    if (!view_find(view, o->scene_path, o->view_path, &s->view_path, &s->report,
                   err))
        return false;
    file = *view;
    if (!apply_options(o, view, err) || !find_crop(s, view, err) ||
        !scene_open(&s->scene, &s->world, view, o->scene_path, &how, &s->report,
                    err))
        return false;
    edit_init(&s->edit, &s->scene, view, &s->report);
    view_copy_frame(&s->edit.saved.view, &file);
    s->opened_pose = view->pose;
    note_additions(s);
    return true;
}

bool session_load(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err)
{
    uint64_t begin_ns = clock_ns();
    struct view view;
    bool ok;

    *s = (struct session){.options = options,
                          .scene = {.program = "/proc/self/exe"},
                          .start_ns = start_ns,
                          .is_filtered = !options->no_filter};
    view_init(&view);
    ok = open_scene(s, &view, err) && apply_edit(s, &view, err);
    view_free(&view);
    s->load_ns = clock_ns() - begin_ns;
    return ok;
}

bool session_open(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err)
{
    if (!session_load(s, options, start_ns, err))
        return false;
    if (!backends_open(&s->backends, options, err))
        return false;
    s->render = render_create(s->backends.cpu, err);
    return s->render != NULL;
}

static void swap_loaded(struct session *a, struct session *b)
{
    struct session old = *a;

    a->scene = b->scene;
    a->world = b->world;
    a->edit = b->edit;
    a->crop = b->crop;
    a->opened_pose = b->opened_pose;
    a->report = b->report;
    b->scene = old.scene;
    b->world = old.world;
    b->edit = old.edit;
    b->crop = old.crop;
    b->opened_pose = old.opened_pose;
    b->report = old.report;
    memcpy(a->notice, b->notice, sizeof a->notice);
}

void session_take_loaded(struct session *s, struct session *fresh)
{
    bool has_same_shape = scene_has_same_shape(&s->scene, &fresh->scene);

    render_halt(s->render);
    edit_keep_camera(&fresh->edit, &s->edit);
    swap_loaded(s, fresh);
    if (has_same_shape) /* keep the tree */
        world_take_shape(&s->world, &fresh->world);
}

void session_watch(const struct session *s, struct file_watch *watch)
{
    char *camera = xchecked(path_beside(s->options->scene_path, "camera.txt"));
    struct view view = edit_view(&s->edit);
    const char *path;

    for (uint32_t i = 0;
         (path = scene_file(&s->scene, &view, s->view_path, i)) != NULL; i++)
        file_watch_add(watch, path);
    if (!s->options->view_path)
        file_watch_add(watch, camera);
    free(camera);
}

bool session_check_output(const struct session *s, const char *option,
                          const char *path, struct error *err)
{
    struct file_watch files;
    bool ok;

    file_watch_init(&files);
    session_watch(s, &files);
    ok = file_watch_spares(&files, option, path, err);
    file_watch_free(&files);
    return ok;
}

static bool begin(struct session *s, struct render_limits limits,
                  uint64_t steps, struct error *err)
{
    struct render_job job = {.host = &s->world,
                             .crop = s->crop,
                             .limits = limits,
                             .steps = steps,
                             .is_adaptive = options_adaptive(s->options),
                             .first_sample = s->first_sample,
                             .from = s->from};
    struct view view = edit_view(&s->edit);
    bool is_live =
        limits.spp == 0 && !(limits.error > 0) && limits.time_ns == 0;
    uint32_t features;

    job.exposure = (float)view.lighting.exposure;
    if (is_live) {
        job.draft_width = s->draft_width;
        job.draft_height = s->draft_height;
        s->draft_has_surfaces = s->is_filtered && s->sample == SAMPLE_LIGHT;
        job.draft_has_surfaces = s->draft_has_surfaces;
    }
    render_halt(s->render);
    s->rendered_version = s->edit.version;
    if (!apply_edit(s, &view, err) ||
        !world_lend(&s->world, &s->scene, &view, s->options->seed, &job.world,
                    err))
        return false;
    /* a device has its own tree; the interactive program needs this one for
     * picks and for walls, also after a reload */
    if (session_uses_device(s) && s->options->batch)
        world_drop_tree(&s->world);
    else if (session_uses_device(s) &&
             !world_ensure_tree(&s->world, &job.world, NULL, err))
        return false;
    job.world.settings.features = session_features(s);
    features = job.world.settings.features;
    if (is_live && s->sample != SAMPLE_LIGHT) {
        job.world.settings.sample = s->sample;
        job.world.settings.features |= FEATURE_AOV;
    }
    s->restart_ns = clock_ns();
    s->speeds = (struct speeds){0};
    s->errors.count = 0;
    thread_load_begin(&s->load, render_backend(s->render));
    if (!render_start(s->render, &job, err))
        return false;
    /* restarts repay the time of a special build */
    if (session_uses_device(s) && is_live)
        backends_specialise(&s->backends, features);
    return true;
}

uint32_t session_features(const struct session *s)
{
    return world_features(&s->world) |
           (s->options->denoise ? (uint32_t)FEATURE_FILTER : 0);
}

bool session_restart(struct session *s, struct render_limits limits,
                     struct error *err)
{
    return begin(s, limits, 0, err);
}

bool session_step(struct session *s, struct render_limits limits,
                  struct error *err)
{
    return begin(s, limits, 1, err);
}

bool session_is_outdated(const struct session *s)
{
    return s->rendered_version != s->edit.version;
}

struct develop session_develop(const struct session *s)
{
    const struct lighting *l = &edit_shown(&s->edit)->view.lighting;

    return (struct develop){(float)l->exposure, l->tone};
}

struct render_progress session_progress(struct session *s)
{
    struct render_progress p = render_progress(s->render);

    speeds_update(&s->speeds, p.render_ns, p.samples);
    error_history_update(&s->errors, &p);
    return p;
}

struct image_metadata session_metadata(const struct session *s,
                                       bool is_denoised)
{
    struct render_progress p = render_progress(s->render);

    return render_metadata(&p, s->scene.path, s->options->seed, is_denoised);
}

bool session_uses_device(const struct session *s)
{
    return render_backend(s->render) != s->backends.cpu;
}

void session_close(struct session *s)
{
    if (s->render)
        render_destroy(s->render); /* first, since it reads the scene */
    backends_close(&s->backends);
    world_free(&s->world);
    scene_free(&s->scene);
    edit_free(&s->edit);
    warnings_free(&s->report);
    thread_load_free(&s->load);
    free(s->view_path);
    *s = (struct session){0};
}
