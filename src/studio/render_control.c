// SPDX-License-Identifier: MIT
#include "studio/render_control.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"

/* The least time for a message, and for each of its bytes: 200 words a minute
 * are read. */
#define MESSAGE_NS UINT64_C(4000000000)
#define BYTE_NS    UINT64_C(60000000)
#define LONG_NS    UINT64_C(10000000000)

/* The draft's first sample of all pixels is waited for: half a frame at 60 Hz
 * for a picture that is worth to be seen. */
#define PATIENCE_NS UINT64_C(8000000)

/* Editors and exporters write several files, or one in several steps. */
#define QUIET_NS UINT64_C(150000000)

/* How often files are looked at where the system does not watch them. */
#define LOOK_NS UINT64_C(1000000000)

static uint64_t reading_ns(const char *text)
{
    uint64_t ns = strlen(text) * BYTE_NS;

    return ns > MESSAGE_NS ? ns : MESSAGE_NS;
}

/* For `least_ns`, or as long as it takes to read. */
static void __attribute__((format(printf, 3, 0)))
say(struct render_control *w, uint64_t least_ns, const char *format,
    va_list values)
{
    uint64_t read_ns;

    vsnprintf(w->message.text, sizeof w->message.text, format, values);
    w->message.is_error = false;
    w->message.said_ns = clock_ns();
    read_ns = reading_ns(w->message.text);
    w->message.until_ns =
        w->message.said_ns + (read_ns > least_ns ? read_ns : least_ns);
    w->has_changed = true;
}

void render_control_say(struct render_control *w, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    say(w, MESSAGE_NS, format, values);
    va_end(values);
}

void render_control_say_long(struct render_control *w, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    say(w, LONG_NS, format, values);
    va_end(values);
}

void render_control_say_error(struct render_control *w, const char *text)
{
    snprintf(w->message.text, sizeof w->message.text, "%s", text);
    w->message.is_error = true;
    w->message.said_ns = clock_ns();
    w->message.until_ns = UINT64_MAX;
    w->has_changed = true;
}

void render_control_be_silent(struct render_control *w)
{
    w->message = (struct message){0};
    w->has_changed = true;
}

void render_control_be_heard(struct render_control *w)
{
    struct message *m = &w->message;

    if (!m->is_error)
        return;
    m->is_error = false;
    m->until_ns = m->said_ns + reading_ns(m->text);
    w->has_changed = true;
}

struct keymap_name render_control_key(const struct render_control *w,
                                      enum action action)
{
    return keymap_first_name(&w->session->options->keys, action);
}

void render_control_add_result(struct render_control *w, const char *text)
{
    w->results = xrealloc(w->results,
                          ((size_t)w->result_count + 1) * sizeof w->results[0]);
    w->results[w->result_count++] = xstrdup(text);
}

static void watch_files(struct render_control *w)
{
    file_watch_begin(&w->watch);
    session_watch(w->session, &w->watch);
    file_watch_end(&w->watch);
    w->watched_sky = w->session->sky;
    w->files_ns = w->watch.fd < 0 ? clock_ns() + LOOK_NS : UINT64_MAX;
}

static void begin(struct render_control *w, bool is_step)
{
    uint64_t spp = w->is_live ? 0 : w->session->options->spp;
    struct error err;

    save_thread_wait_copied(&w->saver);
    if (!(is_step ? session_step(w->session, spp, &err)
                  : session_restart(w->session, spp, &err)))
        render_control_say_error(w, err.text);
    if (w->session->notice[0] != '\0')
        render_control_say_error(w, w->session->notice);
    w->session->notice[0] = '\0';
    w->must_restart = false;
    w->is_halted = is_step;
    w->saved_samples = 0;
    w->saving_samples = 0; /* these are of the picture before */
    if (w->session->sky != w->watched_sky)
        watch_files(w); /* of another image from now on */
    w->restarted_ns = clock_ns();
    w->progress = render_progress(w->session->render);
    w->progress.first_picture_ns = 0; /* for the next look to find */
}

static void restart(struct render_control *w)
{
    begin(w, false);
}

bool render_control_init(struct render_control *w, struct session *session,
                         struct error *err)
{
    *w = (struct render_control){.session = session,
                                 .is_live = true,
                                 .restarted_ns = clock_ns()};
    if (!session_restart(session, 0, err) || !save_thread_init(&w->saver, err))
        return false;
    if (!reload_init(&w->reload, session->options, err)) {
        save_thread_free(&w->saver);
        return false;
    }
    file_watch_init(&w->watch);
    watch_files(w);
    w->progress = render_progress(session->render);
    return true;
}

bool render_control_awaits_picture(const struct render_control *w)
{
    const struct render_progress *p = &w->progress;

    return p->state == RENDER_RUNNING &&
           (p->first_picture_ns == 0 ||
            (p->draft_is_coarse && p->render_ns < PATIENCE_NS));
}

/* A device that fails is replaced by the CPU, which starts anew. */
static void take_failure(struct render_control *w)
{
    struct session *s = w->session;
    bool has_cpu = session_uses_device(s);
    char *text = xformat("%s%s", w->progress.error.text,
                         has_cpu ? "; the CPU renders" : "");

    if (has_cpu) {
        render_use(s->render, s->machines.cpu);
        restart(w);
    }
    render_control_say_error(w, text);
    free(text);
}

/* files_ns has come. */
static void take_files(struct render_control *w)
{
    bool loads;

    render_control_look_at_files(w);
    loads = w->has_changed_files && w->session->options->watch && w->is_live &&
            !render_control_has_unsaved_edit(w);
    w->files_ns = w->watch.fd < 0 ? clock_ns() + LOOK_NS : UINT64_MAX;
    if (loads && w->reload.is_busy)
        w->files_ns = clock_ns() + QUIET_NS;
    else if (loads)
        render_control_reload(w);
}

void render_control_look(struct render_control *w)
{
    enum render_state before = w->progress.state;
    bool was_awaited = render_control_awaits_picture(w);

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

void render_control_settle(struct render_control *w)
{
    if (w->must_restart)
        restart(w);
}

bool render_control_has_unsaved(const struct render_control *w)
{
    return !w->is_live && w->is_started &&
           render_progress(w->session->render).samples > w->saved_samples;
}

bool render_control_has_unsaved_edit(const struct render_control *w)
{
    const struct edit *edit = &w->session->edit;

    return edit_has_unsaved_materials(edit) || edit_has_unsaved_view(edit);
}

bool render_control_may_move(struct render_control *w)
{
    if (!w->is_live)
        render_control_say(w, "the camera moves in live mode: %s goes there",
                           render_control_key(w, ACTION_MODE).text);
    return w->is_live;
}

void render_control_set_live(struct render_control *w, bool is_live)
{
    w->is_live = is_live;
    w->is_started = false;
    w->must_restart = false;
    if (is_live) {
        render_control_say(w, "live mode: every change starts anew");
        w->files_ns = clock_ns(); /* what has changed may be loaded now */
        restart(w);
        return;
    }
    render_halt(w->session->render);
    render_control_say(w, "normal mode: %s starts the render, %s goes back",
                       render_control_key(w, ACTION_START).text,
                       render_control_key(w, ACTION_MODE).text);
}

static void start_normal(struct render_control *w, bool is_step)
{
    w->is_started = true;
    render_control_be_silent(w);
    begin(w, is_step);
}

static void say_done(struct render_control *w)
{
    render_control_say(w,
                       "the render is done: %s saves it, %s goes to live mode",
                       render_control_key(w, ACTION_SAVE).text,
                       render_control_key(w, ACTION_MODE).text);
}

void render_control_start_or_halt(struct render_control *w)
{
    struct render *render = w->session->render;

    w->has_changed = true;
    if (!w->is_live && !w->is_started) {
        start_normal(w, false);
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

void render_control_step(struct render_control *w)
{
    struct render *render = w->session->render;

    w->has_changed = true;
    if (!w->is_live && !w->is_started) {
        start_normal(w, true);
        return;
    }
    w->is_halted = render_step(render);
    w->progress = render_progress(render);
    if (!w->is_halted)
        say_done(w);
}

void render_control_restart(struct render_control *w)
{
    w->has_changed = true;
    if (w->is_live || w->is_started)
        restart(w);
    else
        render_control_say(w, "nothing is rendered yet: %s starts",
                           render_control_key(w, ACTION_START).text);
}

/* ---- backends ---- */

static void use(struct render_control *w, struct backend *backend)
{
    struct backends *m = &w->session->machines;

    render_use(w->session->render, backend);
    restart(w);
    if (backend == m->device)
        render_control_say(w, "%s renders; self-test: %s", backend->device,
                           m->verdict);
    else
        render_control_say(w, "the CPU renders");
}

void render_control_begin_device(struct render_control *w)
{
    struct error err;

    if (!backends_begin_device(&w->session->machines, FEATURES_ALL, &err))
        render_control_say_error(w, err.text);
}

void render_control_switch_backend(struct render_control *w)
{
    struct backends *m = &w->session->machines;

    if (!w->is_live) {
        render_control_say(w, "the backend changes in live mode: %s goes there",
                           render_control_key(w, ACTION_MODE).text);
    } else if (session_uses_device(w->session)) {
        use(w, m->cpu);
    } else if (m->device != NULL) {
        use(w, m->device);
    } else {
        render_control_say_long(w, "OpenCL: waiting for the device");
        if (m->start == NULL)
            render_control_begin_device(w);
    }
}

/* Each line is a result. */
static void add_log(struct render_control *w, const char *log)
{
    while (*log != '\0') {
        size_t length = strcspn(log, "\n");
        char *line = xformat("%.*s", (int)length, log);

        render_control_add_result(w, line);
        free(line);
        log += length + (log[length] == '\n');
    }
}

void render_control_end_device(struct render_control *w)
{
    struct backends *m = &w->session->machines;
    struct error err;
    char *log;

    if (backends_end_specialising(m))
        return;
    if (backends_end_device(m, &log, &err)) {
        if (w->is_live)
            use(w, m->device);
        else
            render_control_say(
                w, "OpenCL: the device is up: %s takes it in live mode",
                render_control_key(w, ACTION_BACKEND).text);
    } else if (w->session->options->backend == BACKEND_AUTO) {
        render_control_say(w, "%s", err.text);
    } else {
        render_control_say_error(w, err.text);
        if (log != NULL)
            add_log(w, log);
        render_control_add_result(w, err.text);
    }
    free(log);
}

/* ---- files ---- */

void render_control_look_at_files(struct render_control *w)
{
    bool has_changed;

    file_watch_drain(&w->watch);
    has_changed = file_watch_has_changed(&w->watch);
    if (has_changed != w->has_changed_files)
        w->has_changed = true;
    w->has_changed_files = has_changed;
    if (has_changed && w->session->options->watch &&
        w->files_ns > clock_ns() + QUIET_NS)
        w->files_ns = clock_ns() + QUIET_NS;
}

void render_control_reload(struct render_control *w)
{
    struct error err;

    if (!w->is_live) {
        render_control_say(w, "files are loaded in live mode: %s goes there",
                           render_control_key(w, ACTION_MODE).text);
        return;
    }
    if (render_control_has_unsaved_edit(w)) {
        render_control_say(
            w, "not loaded: changes of materials or light are not saved; "
               "in the panel ^S saves, u undoes");
        return;
    }
    file_watch_settle(&w->watch); /* what changes from here on is new again */
    w->has_changed_files = false;
    if (reload_begin(&w->reload, &err))
        render_control_say_long(w, "loading ...");
    else
        render_control_say_error(w, err.text);
}

/* How many warnings there are, and the first of them. */
static void say_loaded(struct render_control *w)
{
    const struct warnings *r = &w->session->report;
    uint64_t count = 0;

    for (int i = 0; i < r->entry_count; i++)
        count += r->entries[i].count;
    if (count > 0)
        render_control_say(w, "loaded, %" PRIu64 " warning%s: %s", count,
                           count == 1 ? "" : "s", r->entries[0].text);
    else
        render_control_say(w, "loaded %s", w->session->scene.path);
}

bool render_control_end_reload(struct render_control *w)
{
    struct session fresh;
    struct error err;
    bool ok = reload_end(&w->reload, &fresh, &err);

    if (!ok) {
        render_control_say_error(w, err.text);
    } else {
        save_thread_wait_copied(&w->saver);
        session_take(w->session, &fresh);
        watch_files(w);
        render_control_look_at_files(w); /* what was missed meanwhile */
        say_loaded(w);
        restart(w);
    }
    session_close(&fresh);
    return ok;
}

void render_control_free(struct render_control *w)
{
    save_thread_free(&w->saver);
    reload_free(&w->reload);
    file_watch_free(&w->watch);
    for (int i = 0; i < w->result_count; i++)
        free(w->results[i]);
    free(w->results);
    *w = (struct render_control){0};
}
