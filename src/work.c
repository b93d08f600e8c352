// SPDX-License-Identifier: MIT
#include "glim/work.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/file.h"
#include "glim/picture.h"
#include "glim/view_file.h"
#include "glim/xdg.h"

#define MESSAGE_NS UINT64_C(4000000000)
#define LONG_NS    UINT64_C(10000000000)

/* The draft's first sample of all pixels is waited for: half a frame at 60 Hz
 * for a picture that is worth to be seen. */
#define PATIENCE_NS UINT64_C(8000000)

/* Editors and exporters write several files, or one in several steps. */
#define QUIET_NS UINT64_C(150000000)

/* How often files are looked at where the system does not watch them. */
#define LOOK_NS UINT64_C(1000000000)

static void say(struct work *w, const char *text, uint64_t until_ns)
{
    snprintf(w->message.text, sizeof w->message.text, "%s", text);
    w->message.is_error = false;
    w->message.until_ns = until_ns;
    w->has_changed = true;
}

void work_say(struct work *w, const char *text)
{
    say(w, text, clock_ns() + MESSAGE_NS);
}

void work_say_long(struct work *w, const char *text)
{
    say(w, text, clock_ns() + LONG_NS);
}

void work_say_error(struct work *w, const char *text)
{
    say(w, text, UINT64_MAX);
    w->message.is_error = true;
}

static void add_result(struct work *w, const char *text)
{
    w->results = xrealloc(w->results,
                          ((size_t)w->result_count + 1) * sizeof w->results[0]);
    w->results[w->result_count++] = xstrdup(text);
}

static void restart(struct work *w)
{
    uint64_t spp = w->is_live ? 0 : w->session->options->spp;
    struct error err;

    saver_wait_copied(&w->saver);
    if (!session_restart(w->session, spp, &err))
        work_say_error(w, err.text);
    if (w->session->notice[0] != '\0')
        work_say_error(w, w->session->notice);
    w->session->notice[0] = '\0';
    w->must_restart = false;
    w->is_halted = false;
    w->saved_samples = 0;
    w->saving_samples = 0; /* these are of the picture before */
    w->restarted_ns = clock_ns();
    w->progress = render_progress(w->session->render);
    w->progress.first_picture_ns = 0; /* for the next look to find */
}

static void watch_files(struct work *w)
{
    watch_begin(&w->watch);
    session_watch(w->session, &w->watch);
    watch_end(&w->watch);
    w->files_ns = w->watch.fd < 0 ? clock_ns() + LOOK_NS : UINT64_MAX;
}

bool work_init(struct work *w, struct session *session, struct error *err)
{
    *w = (struct work){.session = session,
                       .is_live = true,
                       .restarted_ns = clock_ns()};
    if (!session_restart(session, 0, err) || !saver_init(&w->saver, err))
        return false;
    if (!reload_init(&w->reload, session->options, err)) {
        saver_free(&w->saver);
        return false;
    }
    watch_init(&w->watch);
    watch_files(w);
    w->progress = render_progress(session->render);
    return true;
}

bool work_awaits_picture(const struct work *w)
{
    const struct render_progress *p = &w->progress;

    return p->state == RENDER_RUNNING &&
           (p->first_picture_ns == 0 ||
            (p->draft_is_coarse && p->render_ns < PATIENCE_NS));
}

/* A device that fails is replaced by the CPU, which starts anew. */
static void take_failure(struct work *w)
{
    struct session *s = w->session;
    bool has_cpu = session_uses_device(s);
    char *text = xformat("%s%s", w->progress.error.text,
                         has_cpu ? "; the CPU renders" : "");

    if (has_cpu) {
        render_use(s->render, s->machines.cpu);
        restart(w);
    }
    work_say_error(w, text);
    free(text);
}

/* files_ns has come. */
static void take_files(struct work *w)
{
    bool loads;

    work_look_at_files(w);
    loads = w->has_changed_files && w->session->options->watch && w->is_live &&
            !work_has_unsaved_edit(w);
    w->files_ns = w->watch.fd < 0 ? clock_ns() + LOOK_NS : UINT64_MAX;
    if (loads && w->reload.is_busy)
        w->files_ns = clock_ns() + QUIET_NS;
    else if (loads)
        work_reload(w);
}

void work_look(struct work *w)
{
    enum render_state before = w->progress.state;
    bool was_awaited = work_awaits_picture(w);

    if (clock_ns() >= w->files_ns)
        take_files(w);
    w->progress = session_look(w->session);
    if (w->progress.state != before)
        w->has_changed = true;
    if (w->progress.state == RENDER_FAILED && before != RENDER_FAILED)
        take_failure(w);
    /* A picture of the old place that has been begun is shown first, between
     * this look and the next, or a scene that is slow to begin would never show
     * anything on the way. */
    if (w->must_restart && !was_awaited)
        restart(w);
}

bool work_has_unsaved(const struct work *w)
{
    return !w->is_live && w->is_started &&
           w->progress.samples > w->saved_samples;
}

bool work_has_unsaved_edit(const struct work *w)
{
    const struct edit *edit = &w->session->edit;

    return edit_has_unsaved_materials(edit) || edit_has_unsaved_view(edit);
}

bool work_may_move(struct work *w)
{
    if (!w->is_live)
        work_say(w, "the camera moves in live mode: space goes there");
    return w->is_live;
}

void work_set_live(struct work *w, bool is_live)
{
    w->is_live = is_live;
    w->is_started = false;
    w->must_restart = false;
    if (is_live) {
        work_say(w, "live mode: every change starts anew");
        w->files_ns = clock_ns(); /* what has changed may be loaded now */
        restart(w);
        return;
    }
    render_halt(w->session->render);
    work_say(w, "normal mode: Enter starts the render, space goes back");
}

static void start_normal(struct work *w)
{
    w->is_started = true;
    w->message.until_ns = 0;
    restart(w);
}

static void say_done(struct work *w)
{
    work_say(w, "the render is done: p saves it, space goes to live mode");
}

void work_start_or_halt(struct work *w)
{
    struct render *render = w->session->render;

    w->has_changed = true;
    if (!w->is_live && !w->is_started) {
        start_normal(w);
    } else if (w->progress.state == RENDER_RUNNING) {
        render_halt(render);
        w->is_halted = true;
    } else if (w->progress.state == RENDER_IDLE) {
        render_resume(render, w->is_live ? 0 : w->session->options->spp);
        w->is_halted = false;
    } else {
        say_done(w);
    }
    w->progress = render_progress(render);
}

void work_step(struct work *w)
{
    struct render *render = w->session->render;

    w->has_changed = true;
    if (!w->is_live && !w->is_started)
        start_normal(w);
    w->is_halted = render_step(render);
    w->progress = render_progress(render);
    if (!w->is_halted)
        say_done(w);
}

void work_restart(struct work *w)
{
    w->has_changed = true;
    if (w->is_live || w->is_started)
        restart(w);
    else
        work_say(w, "nothing is rendered yet: Enter starts");
}

/* ---- backends ---- */

static void use(struct work *w, struct backend *backend)
{
    struct machines *m = &w->session->machines;
    char *text;

    render_use(w->session->render, backend);
    restart(w);
    if (backend == m->device)
        text =
            xformat("%s renders; self-test: %s", backend->device, m->verdict);
    else
        text = xstrdup("the CPU renders");
    work_say(w, text);
    free(text);
}

void work_begin_device(struct work *w)
{
    struct error err;

    if (!machines_begin_device(&w->session->machines, FEATURES_ALL, &err))
        work_say_error(w, err.text);
}

void work_switch_backend(struct work *w)
{
    struct machines *m = &w->session->machines;

    if (!w->is_live) {
        work_say(w, "the backend changes in live mode: space goes there");
    } else if (session_uses_device(w->session)) {
        use(w, m->cpu);
    } else if (m->device != NULL) {
        use(w, m->device);
    } else {
        work_say_long(w, "OpenCL: waiting for the device");
        if (m->start == NULL)
            work_begin_device(w);
    }
}

void work_end_device(struct work *w)
{
    struct machines *m = &w->session->machines;
    struct error err;
    char *log;

    if (machines_end_specialising(m))
        return;
    if (machines_end_device(m, &log, &err)) {
        if (w->is_live)
            use(w, m->device);
        else
            work_say(w, "OpenCL: the device is up: b takes it in live mode");
    } else if (w->session->options->backend == BACKEND_AUTO) {
        work_say(w, err.text);
    } else {
        work_say_error(w, err.text);
        if (log != NULL && *log != '\0')
            add_result(w, log);
        add_result(w, err.text);
    }
    free(log);
}

/* ---- files ---- */

void work_look_at_files(struct work *w)
{
    bool has_changed;

    watch_drain(&w->watch);
    has_changed = watch_has_changed(&w->watch);
    if (has_changed != w->has_changed_files)
        w->has_changed = true;
    w->has_changed_files = has_changed;
    if (has_changed && w->session->options->watch &&
        w->files_ns > clock_ns() + QUIET_NS)
        w->files_ns = clock_ns() + QUIET_NS;
}

void work_reload(struct work *w)
{
    struct error err;

    if (!w->is_live) {
        work_say(w, "files are loaded in live mode: space goes there");
        return;
    }
    if (work_has_unsaved_edit(w)) {
        work_say(w, "not loaded: changes of materials or light are not saved; "
                    "in the panel ^S saves, u undoes");
        return;
    }
    watch_settle(&w->watch, NULL); /* what changes from here on is new again */
    w->has_changed_files = false;
    if (reload_begin(&w->reload, &err))
        work_say_long(w, "loading ...");
    else
        work_say_error(w, err.text);
}

/* How many warnings there are, and the first of them. */
static void say_loaded(struct work *w)
{
    const struct report *r = &w->session->report;
    uint64_t count = 0;
    char *text;

    for (int i = 0; i < r->entry_count; i++)
        count += r->entries[i].count;
    if (count > 0)
        text = xformat("loaded, %" PRIu64 " warning%s: %s", count,
                       count == 1 ? "" : "s", r->entries[0].text);
    else
        text = xformat("loaded %s", w->session->scene.path);
    work_say(w, text);
    free(text);
}

bool work_end_reload(struct work *w)
{
    struct session fresh;
    struct error err;
    bool ok = reload_end(&w->reload, &fresh, &err);

    if (!ok) {
        work_say_error(w, err.text);
    } else {
        saver_wait_copied(&w->saver);
        session_take(w->session, &fresh);
        watch_files(w);
        work_look_at_files(w); /* what was missed meanwhile */
        say_loaded(w);
        restart(w);
    }
    session_close(&fresh);
    return ok;
}

/* The scene's name without folder and ending. */
static char *scene_name(const struct work *w)
{
    char *stem = path_stem(w->session->scene.path);
    const char *slash = strrchr(stem, '/');
    char *name = xstrdup(slash ? slash + 1 : stem);

    free(stem);
    return name;
}

void work_save_picture(struct work *w, const char *ending)
{
    struct render_progress now = render_progress(w->session->render);
    struct error err;
    char *stem;

    if (now.samples == 0) {
        work_say(w, "nothing to save yet");
        return;
    }
    stem = scene_name(w);
    if (saver_begin(&w->saver, render_film(w->session->render),
                    session_develop(w->session), stem, ending, &err)) {
        w->saving_samples = now.samples;
        snprintf(w->saving_spp, sizeof w->saving_spp, "%" PRIu64 " spp",
                 now.spp_done);
        work_say_long(w, "saving ...");
    } else {
        work_say_error(w, err.text);
    }
    free(stem);
}

bool work_finish_saving(struct work *w)
{
    const struct film *film = render_film(w->session->render);
    struct error err;
    char *name, *text;

    if (!w->saver.is_busy)
        return true;
    name = saver_finish(&w->saver, &err);
    if (!name) {
        work_say_error(w, err.text);
        add_result(w, err.text);
        return false;
    }
    text = xformat("saved %s %dx%d, %s", name, film->width, film->height,
                   w->saving_spp);
    work_say(w, text);
    add_result(w, text);
    w->saved_samples = w->saving_samples;
    free(text);
    free(name);
    return true;
}

void work_save_text(struct work *w, const struct text_style *style)
{
    struct render_progress now = render_progress(w->session->render);
    struct error err;
    char *stem, *text, *name = NULL;
    size_t size_bytes;

    if (now.samples == 0) {
        work_say(w, "nothing to save yet");
        return;
    }
    stem = scene_name(w);
    if (text_of_film(render_film(w->session->render),
                     session_develop(w->session), style, &text, &size_bytes,
                     &err)) {
        name = file_write_numbered(stem, "ans", text, size_bytes, &err);
        free(text);
    }
    free(stem);
    if (!name) {
        work_say_error(w, err.text);
        return;
    }
    text = xformat("saved %s, text of %dx%d characters", name, style->cols,
                   style->rows);
    work_say(w, text);
    add_result(w, text);
    free(text);
    free(name);
}

void work_save_view(struct work *w)
{
    struct session *s = w->session;
    struct error err;
    char *text;

    s->view.has_camera = true; /* also one that was placed by the program */
    edit_to_view(&s->edit, &s->edit.now, &s->scene, &s->view);
    if (!view_write(&s->view, s->view_path, &err)) {
        work_say_error(w, err.text);
        return;
    }
    edit_saved_view(&s->edit);
    view_copy(&s->filed, &s->view);
    watch_settle(&w->watch, s->view_path);
    text = xformat("wrote the view to %s", s->view_path);
    work_say(w, text);
    add_result(w, text);
    free(text);
}

bool work_save_edit(struct work *w)
{
    bool had_changed = watch_has_changed(&w->watch);
    struct error err;
    char *what;
    bool ok = session_save_edit(w->session, &what, &err);

    if (!had_changed)
        watch_settle(&w->watch, NULL); /* what has changed was just written */
    if (!ok) {
        work_say_error(w, err.text);
        return false;
    }
    w->files_ns = clock_ns(); /* what has changed may be loaded now */
    work_say(w, what);
    add_result(w, what);
    free(what);
    return true;
}

/* NULL if it cannot be written there. */
static char *keep_as(struct work *w, const char *stem, struct error *err)
{
    char *kept = xformat("%s-kept", stem);
    char *name =
        picture_write_numbered(render_film(w->session->render),
                               session_develop(w->session), kept, "png", err);

    free(kept);
    return name;
}

static char *keep_beside(struct work *w, struct error *err)
{
    char *stem = path_stem(w->session->scene.path);
    char *name = keep_as(w, stem, err);

    free(stem);
    return name;
}

static char *keep_in_state(struct work *w, struct error *err)
{
    char *scene = scene_name(w);
    char *stem = xdg_state_path(scene);
    char *name = stem ? keep_as(w, stem, err) : NULL;

    free(stem);
    free(scene);
    return name;
}

void work_keep(struct work *w)
{
    struct error err;
    char *name, *text;

    render_halt(w->session->render);
    w->progress = render_progress(w->session->render);
    if (w->progress.samples <= w->saved_samples)
        return;
    name = keep_beside(w, &err);
    if (!name)
        name = keep_in_state(w, &err);
    text = name
               ? xformat("kept %s, %" PRIu64 " spp", name, w->progress.spp_done)
               : xstrdup(err.text);
    add_result(w, text);
    free(text);
    free(name);
}

void work_free(struct work *w)
{
    saver_free(&w->saver);
    reload_free(&w->reload);
    watch_free(&w->watch);
    for (int i = 0; i < w->result_count; i++)
        free(w->results[i]);
    free(w->results);
    *w = (struct work){0};
}
