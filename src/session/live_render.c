// SPDX-License-Identifier: MIT
#include "session/live_render.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/print.h"
#include "kernels/rng.h"
#include "render/error_text.h"
#include "terminal/xmalloc.h"

/* Limit of the wait for the draft's first whole pass: half a frame at 60 Hz, to
 * show a better first picture. */
#define DRAFT_WAIT_NS UINT64_C(8000000)

/* A picture counts as moving until this time after a restart: keys that are
 * held come again within it. */
#define REST_NS UINT64_C(400000000)

/* Time without changes before a reload: editors and exporters write several
 * files, or one file in several steps. */
#define FILES_QUIET_NS UINT64_C(150000000)

/* Period of checks of the files if the system cannot watch them. */
#define FILES_POLL_NS UINT64_C(1000000000)

/* Least time of a message, and per byte for 200 words per minute. LONG_NS is
 * the least time of long ones. */
#define MESSAGE_NS UINT64_C(4000000000)
#define BYTE_NS    UINT64_C(60000000)
#define LONG_NS    UINT64_C(10000000000)

/* Shows the message for the time that it takes to read it, at least `least_ns`.
 */
static void show_message(struct live_render *control, uint64_t least_ns)
{
    struct message *m = &control->message;
    uint64_t ns = strlen(m->text) * BYTE_NS;

    m->is_error = false;
    m->until_ns = m->said_ns + (ns > least_ns ? ns : least_ns);
    control->has_changed = true;
}

static void __attribute__((format(printf, 2, 0)))
set_text(struct live_render *control, const char *format, va_list values)
{
    struct message *m = &control->message;

    vsnprintf(m->text, sizeof m->text, format, values);
    m->said_ns = clock_ns();
}

void live_render_say(struct live_render *control, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    set_text(control, format, values);
    va_end(values);
    show_message(control, MESSAGE_NS);
}

void live_render_say_long(struct live_render *control, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    set_text(control, format, values);
    va_end(values);
    show_message(control, LONG_NS);
}

void live_render_say_error(struct live_render *control, const char *text)
{
    live_render_say(control, "%s", text);
    control->message.is_error = true;
    control->message.until_ns = UINT64_MAX;
}

void live_render_clear_message(struct live_render *control)
{
    control->message = (struct message){0};
    control->has_changed = true;
}

void live_render_acknowledge_error(struct live_render *control)
{
    if (control->message.is_error)
        show_message(control, MESSAGE_NS);
}

struct keymap_name live_render_key(const struct live_render *control,
                                   enum action action)
{
    return keymap_first_name(&control->session->options->keys, action);
}

void live_render_add_result(struct live_render *control, const char *text)
{
    control->results =
        xrealloc(control->results, ((size_t)control->result_count + 1) *
                                       sizeof control->results[0]);
    control->results[control->result_count++] = xstrdup(text);
}

static void watch_files(struct live_render *control)
{
    file_watch_begin(&control->watch);
    session_watch(control->session, &control->watch);
    file_watch_end(&control->watch);
    control->watched_version = control->session->files_version;
    control->files_ns =
        control->watch.fd < 0 ? clock_ns() + FILES_POLL_NS : UINT64_MAX;
}

/* Returns the limits of the mode; live mode has none. */
static struct render_limits limits_of(const struct live_render *control)
{
    const struct render_limits none = {0};

    return control->is_live ? none : options_limits(control->session->options);
}

/* Blocks until nobody reads the film or the world any more. */
static void wait_copied(struct live_render *control)
{
    save_thread_wait_copied(&control->saver);
    background_wait_copied(&control->keeping.copying);
}

bool live_render_rests(const struct live_render *control)
{
    return clock_ns() >= control->changed_ns + REST_NS;
}

bool live_render_wants_fine_draft(const struct live_render *control)
{
    const struct session *s = control->session;
    const struct render_progress *p = &control->progress;
    uint64_t pixels = (uint64_t)s->fine_width * (uint64_t)s->fine_height;

    return control->is_live && live_render_rests(control) && pixels > 0 &&
           p->samples >= pixels * DRAFT_SPP;
}

/* Starts a picture within the limits of the mode. */
static void begin(struct live_render *control, struct session_start start)
{
    struct session *s = control->session;
    bool is_same = start.keeps_film && !session_is_outdated(s);
    struct error err;

    wait_copied(control);
    start.limits = limits_of(control);
    start.draft_is_fine = live_render_wants_fine_draft(control);
    if (!session_start(s, &start, &err))
        live_render_say_error(control, err.text);
    if (s->notice[0] != '\0')
        live_render_say_error(control, s->notice);
    s->notice[0] = '\0';
    control->is_halted = start.steps > 0;
    control->has_gone_on =
        start.from != NULL || (start.keeps_film && control->has_gone_on);
    control->saved_samples = 0;
    control->saving_samples = 0; /* both counted the old picture */
    if (s->files_version != control->watched_version)
        watch_files(control); /* another sky image */
    control->restarted_ns = clock_ns();
    if (!is_same)
        control->changed_ns = control->restarted_ns;
    control->progress = render_progress(s->engine.render);
    control->progress.first_picture_ns = 0; /* found by the next update */
}

bool live_render_is_outdated(const struct live_render *control)
{
    return control->is_live && session_is_outdated(control->session);
}

static void restart(struct live_render *control)
{
    begin(control, (struct session_start){.from = NULL});
}

bool live_render_init(struct live_render *control, struct session *session,
                      struct error *err)
{
    *control = (struct live_render){.session = session,
                                    .is_live = true,
                                    .restarted_ns = clock_ns(),
                                    .changed_ns = clock_ns()};
    if (!session_restart(session, limits_of(control), err) ||
        !save_thread_init(&control->saver, err))
        return false;
    if (!autosave_writer_init(&control->keeping, err)) {
        save_thread_free(&control->saver);
        return false;
    }
    if (!reload_init(&control->reload, session->options, err)) {
        autosave_writer_free(&control->keeping);
        save_thread_free(&control->saver);
        return false;
    }
    file_watch_init(&control->watch);
    watch_files(control);
    control->progress = render_progress(session->engine.render);
    return true;
}

bool live_render_awaits_picture(const struct live_render *control)
{
    const struct render_progress *p = &control->progress;

    return p->state == RENDER_RUNNING &&
           (p->first_picture_ns == 0 ||
            (p->draft_is_coarse && p->render_ns < DRAFT_WAIT_NS));
}

/* Replaces a device that failed by the CPU, which goes on with its samples. */
static void replace_device(struct live_render *control)
{
    struct session *s = control->session;
    bool has_cpu = engine_uses_device(&s->engine);
    char *text = xformat("%s%s", control->progress.error.text,
                         has_cpu ? "; the CPU renders" : "");

    if (has_cpu) {
        engine_use_cpu(&s->engine);
        begin(control, (struct session_start){.keeps_film = true});
    }
    live_render_say_error(control, text);
    free(text);
}

static void look_at_files(struct live_render *control)
{
    bool has_changed;

    file_watch_drain(&control->watch);
    has_changed = file_watch_has_changed(&control->watch);
    if (has_changed != control->has_changed_files)
        control->has_changed = true;
    control->has_changed_files = has_changed;
}

/* Checks the files at files_ns. Reloads them if --watch is given. */
static void handle_files(struct live_render *control)
{
    bool loads;

    look_at_files(control);
    loads = control->has_changed_files && control->session->options->watch &&
            control->is_live && !live_render_has_unsaved_edit(control);
    control->files_ns =
        control->watch.fd < 0 ? clock_ns() + FILES_POLL_NS : UINT64_MAX;
    if (control->watch.is_changing ||
        (loads && control->reload.loading.is_busy))
        control->files_ns = clock_ns() + FILES_QUIET_NS;
    else if (loads)
        live_render_reload(control);
}

/* Says that the device is being tested, until there is a verdict, whenever
 * nothing else is said. */
static void say_device_test(struct live_render *control)
{
    if (!control->awaits_device || clock_ns() < control->message.until_ns)
        return;
    live_render_say(control,
                    "OpenCL: testing the device; the CPU renders until then");
    control->message.until_ns = UINT64_MAX;
}

/* Says once that samples are black or cut: in the status line, and when the
 * screen is closed. */
static void say_faults(struct live_render *control)
{
    const struct render_progress *p = &control->progress;
    char text[ERROR_FAULTS_BYTES];

    if (control->has_said_faults ||
        !error_text_faults(text, p->non_finite, p->saturated))
        return;
    control->has_said_faults = true;
    live_render_say_long(control, "%s", text);
    live_render_add_result(control, text);
}

void live_render_update(struct live_render *control)
{
    enum render_state before = control->progress.state;
    bool was_awaited = live_render_awaits_picture(control);

    if (clock_ns() >= control->files_ns)
        handle_files(control);
    control->progress = session_progress(control->session);
    if (control->progress.state != before)
        control->has_changed = true;
    say_faults(control);
    say_device_test(control);
    if (control->progress.state == RENDER_FAILED && before != RENDER_FAILED)
        replace_device(control);
    /* A picture in progress is shown once before the restart. Otherwise a scene
     * whose first picture is slow would show none while the camera moves. */
    if (live_render_is_outdated(control) && !was_awaited)
        restart(control);
}

void live_render_restart_if_outdated(struct live_render *control)
{
    if (live_render_is_outdated(control))
        restart(control);
}

bool live_render_has_unsaved(const struct live_render *control)
{
    return !control->is_live && control->is_started &&
           render_progress(control->session->engine.render).samples >
               control->saved_samples;
}

bool live_render_has_unsaved_edit(const struct live_render *control)
{
    const struct edit *edit = &control->session->edit;

    return edit_has_unsaved_materials(edit) || edit_has_unsaved_view(edit);
}

bool live_render_need_live(struct live_render *control, const char *what)
{
    if (!control->is_live)
        live_render_say(control, "%s only in live mode: %s switches to it",
                        what, live_render_key(control, ACTION_MODE).text);
    return control->is_live;
}

bool live_render_may_edit(struct live_render *control, const char *what)
{
    if (!live_render_need_live(control, what))
        return false;
    if (control->reload.loading.is_busy)
        live_render_say(control, "the scene is being loaded: %s after that",
                        what);
    return !control->reload.loading.is_busy;
}

void live_render_set_live(struct live_render *control, bool is_live)
{
    control->is_live = is_live;
    control->is_started = false;
    if (is_live) {
        live_render_say(control, "live mode: every change restarts the render");
        control->files_ns = clock_ns(); /* reload changed files now */
        restart(control);
        return;
    }
    render_halt(control->session->engine.render);
    live_render_say(control, "normal mode: %s starts the render, %s goes back",
                    live_render_key(control, ACTION_START).text,
                    live_render_key(control, ACTION_MODE).text);
}

static void start_normal(struct live_render *control, uint64_t steps)
{
    control->is_started = true;
    live_render_clear_message(control);
    begin(control, (struct session_start){.steps = steps});
}

static void say_done(struct live_render *control)
{
    live_render_say(control,
                    "the render is done: %s saves it, %s goes to live mode",
                    live_render_key(control, ACTION_SAVE).text,
                    live_render_key(control, ACTION_MODE).text);
}

void live_render_start_or_halt(struct live_render *control)
{
    struct render *render = control->session->engine.render;

    control->has_changed = true;
    if (!control->is_live && !control->is_started) {
        start_normal(control, 0);
    } else if (control->progress.state == RENDER_RUNNING) {
        render_halt(render);
        control->is_halted = true;
    } else if (control->progress.state == RENDER_IDLE) {
        render_resume(render, limits_of(control));
        control->is_halted = false;
    } else {
        say_done(control);
    }
    control->progress = render_progress(render);
}

void live_render_step(struct live_render *control)
{
    struct render *render = control->session->engine.render;

    control->has_changed = true;
    if (!control->is_live && !control->is_started) {
        start_normal(control, 1);
        return;
    }
    control->is_halted = render_step(render);
    control->progress = render_progress(render);
    if (!control->is_halted)
        say_done(control);
}

void live_render_restart(struct live_render *control)
{
    control->has_changed = true;
    if (control->is_live || control->is_started)
        restart(control);
    else
        live_render_say(control, "nothing is rendered yet: %s starts",
                        live_render_key(control, ACTION_START).text);
}

void live_render_renew_draft(struct live_render *control)
{
    control->has_changed = true;
    if (control->is_live)
        begin(control, (struct session_start){.keeps_film = true});
}

void live_render_go_on(struct live_render *control, bool is_live,
                       struct film_file *from)
{
    control->has_changed = true;
    control->is_live = is_live;
    control->is_started = !is_live;
    begin(control, (struct session_start){.from = from});
}

/* ---- backends ---- */

static void use_backend(struct live_render *control, struct backend *backend)
{
    struct backends *m = &control->session->engine.backends;

    render_set_backend(control->session->engine.render, backend);
    restart(control);
    if (backend == m->device)
        live_render_say(control, "%s renders; self-test: %s", backend->device,
                        m->verdict);
    else
        live_render_say(control, "the CPU renders");
}

void live_render_begin_device(struct live_render *control)
{
    struct engine *e = &control->session->engine;
    struct cl_request request = engine_request(e, FEATURES_ALL);
    struct error err;

    if (!backends_begin_device(&e->backends, &request, &err))
        live_render_say_error(control, err.text);
    else
        control->awaits_device =
            control->session->options->backend == BACKEND_OPENCL;
}

void live_render_switch_backend(struct live_render *control)
{
    struct backends *m = &control->session->engine.backends;

    if (!live_render_need_live(control, "the backend changes"))
        return;
    if (engine_uses_device(&control->session->engine)) {
        use_backend(control, m->cpu);
    } else if (m->device != NULL) {
        use_backend(control, m->device);
    } else {
        live_render_clear_message(control);
        if (m->start == NULL)
            live_render_begin_device(control);
        control->awaits_device = m->start != NULL;
        say_device_test(control);
    }
}

/* Adds each line of a log to the results. */
static void add_log(struct live_render *control, const char *log)
{
    while (*log != '\0') {
        size_t length = strcspn(log, "\n");
        char *line = xformat("%.*s", (int)length, log);

        live_render_add_result(control, line);
        free(line);
        log += length + (log[length] == '\n');
    }
}

void live_render_end_device(struct live_render *control)
{
    struct backends *m = &control->session->engine.backends;
    struct error err;
    char *log;

    if (backends_end_specialising(m))
        return;
    control->awaits_device = false;
    if (backends_end_device(m, &log, &err)) {
        if (control->is_live && !control->has_gone_on)
            use_backend(control, m->device);
        else
            live_render_say(
                control,
                "OpenCL: the device is ready: %s selects it in live mode",
                live_render_key(control, ACTION_BACKEND).text);
    } else if (control->session->options->backend == BACKEND_AUTO) {
        live_render_say(control, "%s", err.text);
    } else {
        live_render_say_error(control, err.text);
        if (log != NULL)
            add_log(control, log);
        live_render_add_result(control, err.text);
    }
    free(log);
}

/* ---- files ---- */

void live_render_check_files(struct live_render *control)
{
    uint64_t look_ns = clock_ns() + FILES_QUIET_NS;

    file_watch_drain(&control->watch);
    if (control->files_ns > look_ns)
        control->files_ns = look_ns;
}

void live_render_reload(struct live_render *control)
{
    struct error err;

    if (!live_render_need_live(control, "files are loaded"))
        return;
    if (live_render_has_unsaved_edit(control)) {
        live_render_say(
            control, "not loaded: changes of materials or light are not saved; "
                     "in the panel ^S saves, u undoes");
        return;
    }
    file_watch_settle(&control->watch); /* later changes count as new */
    control->has_changed_files = false;
    if (reload_begin(&control->reload, &err))
        live_render_say_long(control, "loading ...");
    else
        live_render_say_error(control, err.text);
}

/* Shows the number of warnings and the first one. */
static void say_loaded(struct live_render *control)
{
    const struct warnings *r = &control->session->engine.report;
    uint64_t count = 0;

    for (int i = 0; i < r->entry_count; i++)
        count += r->entries[i].count;
    if (count > 0)
        live_render_say(control, "loaded, %" PRIu64 " warning%s: %s", count,
                        print_plural((uint64_t)count), r->entries[0].text);
    else
        live_render_say(control, "loaded %s",
                        control->session->engine.scene.path);
}

bool live_render_end_reload(struct live_render *control)
{
    struct session fresh;
    struct error err;
    bool ok = reload_end(&control->reload, &fresh, &err);

    if (!ok) {
        live_render_say_error(control, err.text);
    } else {
        wait_copied(control);
        session_take_loaded(control->session, &fresh);
        watch_files(control);
        live_render_check_files(control); /* changes during the load */
        say_loaded(control);
        restart(control);
    }
    session_close(&fresh);
    return ok;
}

void live_render_free(struct live_render *control)
{
    save_thread_free(&control->saver);
    autosave_writer_free(&control->keeping);
    reload_free(&control->reload);
    file_watch_free(&control->watch);
    for (int i = 0; i < control->result_count; i++)
        free(control->results[i]);
    free(control->results);
    *control = (struct live_render){0};
}
