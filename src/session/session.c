// SPDX-License-Identifier: MIT
#include "session/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "engine/smoke_load.h"
#include "image/image_read.h"
#include "read/mtl.h"
#include "terminal/xmalloc.h"
#include "world/world_lamps.h"

#include "kernels/features.h"

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

/* Returns the warning about what could not be read of the scene's files, or
 * NULL. A kind may be followed by a name. */
static const char *unread_warning(const struct warnings *report)
{
    static const char *const kinds[] = {"malformed faces",
                                        "faces with a bad index",
                                        "missing material files",
                                        "material files in UTF-16",
                                        "unusable textures"};

    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
        for (int i = 0; i < report->entry_count; i++)
            if (strncmp(report->entries[i].kind, kinds[k], strlen(kinds[k])) ==
                0)
                return report->entries[i].text;
    return NULL;
}

/* Puts what was not read, or the additions of scene_open(), into the notice. */
static void note_additions(struct session *s)
{
    const char *unread = unread_warning(&s->engine.report);

    if (s->engine.scene.tri_count == 0 && s->engine.world.smoke_count == 0)
        snprintf(s->notice, sizeof s->notice, "no faces: %s",
                 face_warning(&s->engine.report));
    else if (unread != NULL)
        snprintf(s->notice, sizeof s->notice, "%s", unread);
    else if (view_has_soft_sky(&s->edit.now.view))
        snprintf(s->notice, sizeof s->notice,
                 "no light in the scene: lit by a soft sky");
    else if (warnings_have(&s->engine.report, SCENE_LITTLE_LIGHT))
        snprintf(s->notice, sizeof s->notice, "its own light shows little%s",
                 s->engine.scene.is_model ? ": lit as a studio" : "");
}

/* Updates the world to the shown state of the edit, whose view is *view. If the
 * sky image or a grid of smoke cannot be used, what was there before stays and
 * the notice says so. */
static bool apply_edit(struct session *s, const struct view *view,
                       struct error *err)
{
    const struct edit_state *shown = edit_shown(&s->edit);
    struct error why;

    if (!world_set_materials(&s->engine.world, &s->engine.scene,
                             s->edit.material_count, shown->sources,
                             shown->assigned, err))
        return false;
    if (!world_has_sky(&s->engine.world, view)) {
        s->files_version++;
        if (!world_load_sky(&s->engine.world, view, &s->engine.report, &why))
            snprintf(s->notice, sizeof s->notice, "%.255s", why.text);
    }
    if (!smoke_load(&s->engine.world, &s->engine.scene, view, &s->engine.report,
                    &why))
        snprintf(s->notice, sizeof s->notice, "%.255s", why.text);
    return world_set_lamps(&s->engine.world, &s->engine.scene, view, err) &&
           world_guide(&s->engine.world, &s->engine.scene, view, err);
}

bool session_load(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err)
{
    struct engine_options how = options_engine(options);
    uint64_t begin_ns = clock_ns();
    struct view view, file;
    bool ok;

    *s = (struct session){.options = options,
                          .start_ns = start_ns,
                          .is_filtered = !options->no_filter};
    view_init(&view);
    ok = engine_load(&s->engine, &how, &view, &file, err);
    if (ok) {
        edit_init(&s->edit, &s->engine.scene, &view, &s->engine.report);
        view_copy_frame(&s->edit.saved.view, &file);
        s->opened_pose = view.pose;
        note_additions(s);
        ok = apply_edit(s, &view, err);
    }
    view_free(&view);
    s->load_ns = clock_ns() - begin_ns;
    return ok;
}

bool session_open(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err)
{
    return session_load(s, options, start_ns, err) &&
           engine_begin(&s->engine, err);
}

void session_take_loaded(struct session *s, struct session *fresh)
{
    struct edit edit = s->edit;
    struct pose opened = s->opened_pose;

    edit_keep_camera(&fresh->edit, &s->edit);
    engine_take_loaded(&s->engine, &fresh->engine);
    s->edit = fresh->edit;
    s->opened_pose = fresh->opened_pose;
    fresh->edit = edit;
    fresh->opened_pose = opened;
    memcpy(s->notice, fresh->notice, sizeof s->notice);
}

void session_watch(const struct session *s, struct file_watch *watch)
{
    char *camera = xchecked(path_beside(s->options->scene_path, "camera.txt"));
    struct view view = edit_view(&s->edit);
    const char *path;

    for (uint32_t i = 0; (path = scene_file(&s->engine.scene, &view,
                                            s->engine.view_path, i)) != NULL;
         i++)
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

/* Completes the job of live mode, which begins with a draft. */
static void add_draft(struct session *s, bool is_fine, struct render_job *job)
{
    job->draft_width = is_fine ? s->fine_width : s->draft_width;
    job->draft_height = is_fine ? s->fine_height : s->draft_height;
    s->draft_is_fine = is_fine;
    job->draft_is_fine = is_fine;
    s->draft_has_surfaces = s->is_filtered && s->sample == SAMPLE_LIGHT;
    job->draft_has_surfaces = s->draft_has_surfaces;
    if (s->sample == SAMPLE_LIGHT)
        return;
    job->world.settings.sample = s->sample;
    job->world.settings.features |= FEATURE_AOV;
}

bool session_start(struct session *s, const struct session_start *start,
                   struct error *err)
{
    const struct render_limits *l = &start->limits;
    bool is_live = l->spp == 0 && !(l->error > 0) && l->time_ns == 0;
    struct view view = edit_view(&s->edit);
    struct engine *e = &s->engine;
    struct cl_request request;
    struct render_job job;

    bool keeps = start->keeps_film && !session_is_outdated(s);

    render_halt(e->render);
    s->rendered_version = s->edit.version;
    if (!apply_edit(s, &view, err) || !engine_prepare(e, &view, &job, err))
        return false;
    job.limits = start->limits;
    job.steps = start->steps;
    job.first_sample = start->first_sample;
    job.from = start->from;
    job.keeps_film = keeps;
    request = engine_request(e, job.world.settings.features);
    if (is_live)
        add_draft(s, keeps && start->draft_is_fine, &job);
    s->restart_ns = clock_ns();
    if (!keeps) {
        s->speeds = (struct speeds){0};
        s->errors.count = 0;
        thread_load_begin(&s->load, render_backend(e->render));
    }
    if (!engine_start(e, &job, err))
        return false;
    /* restarts repay the time of a special build */
    if (engine_uses_device(e) && is_live)
        backends_specialise(&e->backends, &request);
    return true;
}

bool session_restart(struct session *s, struct render_limits limits,
                     struct error *err)
{
    return session_start(s, &(struct session_start){.limits = limits}, err);
}

/* Makes the statement 1 that a map multiplies, unless it is absent. */
static void reset_factor(struct material_values *s, enum mtl_map map)
{
    size_t member = mtl_maps[map].factor;
    struct mtl_number *number = (void *)((char *)s + member);

    if (member != 0 && number->line != 0)
        number->value = 1;
    if (map == MTL_MAP_COLOR && s->base_color.line != 0)
        s->base_color.rgb[0] = s->base_color.rgb[1] = s->base_color.rgb[2] = 1;
}

bool session_set_map(struct session *s, uint32_t material, enum mtl_map map,
                     const char *path, struct error *err)
{
    struct material_values source = s->edit.now.sources[material];
    struct image_file file;

    if (!image_open(&file, path, IMAGE_8BIT, 0, err))
        return false;
    image_close(&file);
    if (material_values_map(&source, map) == NO_INDEX)
        reset_factor(&source, map);
    source.maps[map] = mtl_add_map(&s->engine.scene, map, path);
    if (source.maps[map] == NO_INDEX)
        return fail(err, "%s: out of memory for the texture", path);
    source.maps_off &= ~(1u << map);
    s->files_version++;
    edit_end_step(&s->edit);
    edit_material(&s->edit, material, &source);
    edit_end_step(&s->edit);
    return true;
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
    struct render_progress p = render_progress(s->engine.render);

    speeds_update(&s->speeds, p.render_ns, p.samples);
    error_history_update(&s->errors, &p);
    return p;
}

void session_close(struct session *s)
{
    engine_close(&s->engine); /* first, since it renders */
    edit_free(&s->edit);
    thread_load_free(&s->load);
    *s = (struct session){0};
}
