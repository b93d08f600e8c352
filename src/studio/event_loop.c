// SPDX-License-Identifier: MIT
#include "studio/event_loop.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/background.h"
#include "base/clock.h"
#include "base/print.h"
#include "base/stop.h"
#include "session/save.h"
#include "session/stats_json.h"
#include "studio/panel_draw.h"
#include "studio/studio.h"

#define MS_NS UINT64_C(1000000)
#define S_NS  UINT64_C(1000000000)
#define NEVER UINT64_MAX

/* An ESC byte is the Esc key if no byte follows within this time; it begins the
 * sequence of another key otherwise. */
#define ESCAPE_NS (50 * MS_NS)

/* Descriptors that wake the loop. */
enum {
    FD_KEYS,
    FD_SIGNALS,
    FD_RENDER,
    FD_SAVER,
    FD_AUTOSAVE, /* an autosaved session is written */
    FD_KEEPER_TIMER,
    FD_DEVICE, /* an OpenCL device has started, or cannot */
    FD_FILES,  /* files of the scene have changed */
    FD_RELOAD, /* the scene was loaded anew */
    FDS
};

/* ---- input ---- */

/* Draws the panel after a key, and the picture, which outlines the selection.
 */
static void draw_panel(struct studio *studio)
{
    panel_draw(&studio->workspace.panel);
    workspace_refresh(&studio->workspace);
}

/* Selects a new pick in the panel if that is open. */
static void follow_pick(struct studio *studio)
{
    struct editor_panel *panel = &studio->workspace.panel;

    if (studio->camera.cursor.is_pick_new && panel->is_open) {
        editor_panel_select(panel, &studio->camera.cursor.pick);
        draw_panel(studio);
    }
    studio->camera.cursor.is_pick_new = false;
}

/* Gives a key to the editor panel. Returns false if the key is not the panel's,
 * or the cursor on the picture is shown and takes the arrows. */
static bool panel_takes(struct studio *studio, int key)
{
    struct editor_panel *panel = &studio->workspace.panel;

    if (!panel->is_open ||
        (studio->workspace.screen.has_cursor && !panel->is_typing) ||
        !editor_panel_key(panel, key))
        return false;
    if (!panel->is_open)
        workspace_layout(&studio->workspace);
    else
        draw_panel(studio);
    return true;
}

static bool is_urgent(enum action action)
{
    return action == ACTION_INTERRUPT || action == ACTION_ABORT ||
           action == ACTION_SUSPEND || action == ACTION_REDRAW;
}

/* Urgent keys always work. Any other key goes to the first of these that is
 * there: a question, a window too small for anything but quitting, the help,
 * the editor panel, the cursor. */
static void take_key(struct studio *studio, int key)
{
    struct workspace *workspace = &studio->workspace;
    enum action action =
        keymap_action(&studio->control.session->options->keys, key);

    live_render_acknowledge_error(&studio->control);
    if (!is_urgent(action) && studio->question != QUESTION_NONE &&
        question_answer(studio, key))
        return;
    if (is_urgent(action))
        studio_run(studio, action);
    else if (workspace->screen.is_too_small)
        studio_run(studio, action == ACTION_QUIT ? action : ACTION_NONE);
    else if (workspace->help.is_open)
        workspace_help_key(workspace, key);
    else if (!panel_takes(studio, key) &&
             !comparison_takes(&workspace->comparison, action) &&
             !studio_run_at_cursor(studio, action))
        studio_run(studio, action);
    if (action == ACTION_UNDO || action == ACTION_REDO)
        panel_draw(&workspace->panel);
    follow_pick(studio);
}

/* Moves the wipe to the mouse while a comparison is shown. */
static bool wipe_takes(struct studio *studio, const struct event *event)
{
    struct workspace *workspace = &studio->workspace;
    const struct cells_rect *fit = &workspace->screen.fit;

    if (workspace->comparison.mode == COMPARISON_OFF ||
        (event->mouse != MOUSE_PRESS && event->mouse != MOUSE_DRAG))
        return false;
    comparison_wipe_to(&workspace->comparison,
                       (event->x - 0.5 - fit->col) / fit->cols);
    return true;
}

static void take_mouse(struct studio *studio, const struct event *event)
{
    if (editor_panel_mouse(&studio->workspace.panel, event))
        draw_panel(studio);
    else if (!wipe_takes(studio, event))
        camera_control_mouse(&studio->camera, event);
    follow_pick(studio);
}

static void take_event(struct studio *studio, const struct event *event)
{
    struct workspace *workspace = &studio->workspace;
    enum palette palette = workspace->screen.display.palette;
    enum theme theme = workspace->screen.display.theme;

    if (event->kind == EVENT_KEY) {
        take_key(studio, event->key);
    } else if (event->kind == EVENT_MOUSE) {
        if (studio->has_mouse && !workspace->help.is_open &&
            !workspace->screen.is_too_small)
            take_mouse(studio, event);
    } else {
        bool is_other = screen_answer(&workspace->screen, event);

        if ((event->kind == EVENT_ATTRIBUTES || event->kind == EVENT_KITTY) &&
            glyph_choice_recall(&workspace->glyph_choice))
            is_other = true;
        if (is_other)
            workspace_layout(workspace);
        if (workspace->screen.display.palette != palette ||
            workspace->screen.display.theme != theme)
            draw_panel(studio);
    }
}

static void take_byte_events(struct studio *studio, bool nothing_follows)
{
    struct event event;

    while (!studio->is_ending &&
           tty_input_next(&studio->input, nothing_follows, &event))
        take_event(studio, &event);
}

/* Takes all keys that wait before the next frame is drawn. */
static void take_input(struct studio *studio)
{
    unsigned char bytes[1024];
    int count;

    while (!studio->is_ending && (count = tty_read(bytes, sizeof bytes)) != 0) {
        if (count < 0) {
            studio->is_gone = true;
            studio_end(studio, 128 + SIGHUP);
            return;
        }
        studio->byte_ns = clock_ns();
        tty_input_feed(&studio->input, bytes, (size_t)count);
        take_byte_events(studio, false);
    }
}

static void take_signals(struct studio *studio)
{
    int number;

    while ((number = tty_signal()) != 0) {
        switch (number) {
        case SIGTERM:
        case SIGHUP:
        case SIGINT:
        case SIGQUIT: studio_end(studio, 128 + number); return;
        case SIGTSTP: studio_suspend(studio); break;
        case SIGCONT:
            tty_resume();
            workspace_layout(&studio->workspace);
            break;
        case SIGWINCH: workspace_layout(&studio->workspace); break;
        default: break;
        }
    }
}

/* ---- loop ---- */

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* When a sequence that is not complete is taken as it is. The terminal's
 * answers may come in pieces, so they have longer than a lone ESC. */
static uint64_t input_deadline_ns(const struct studio *studio)
{
    if (!tty_input_is_partial(&studio->input))
        return NEVER;
    return studio->byte_ns + (studio->input.length == 1 ? ESCAPE_NS : S_NS);
}

/* When the loop has to go on if no descriptor wakes it. */
static uint64_t wake_ns(const struct studio *studio, uint64_t now_ns)
{
    return earlier(workspace_next_ns(&studio->workspace, now_ns),
                   earlier(camera_control_next_ns(&studio->camera),
                           input_deadline_ns(studio)));
}

static void take_reload(struct studio *studio)
{
    struct selection_names names =
        selection_names(&studio->workspace.panel.selection);

    if (live_render_end_reload(&studio->control)) {
        camera_control_set_scene(&studio->camera);
        workspace_renew(&studio->workspace, &names);
    }
    free(names.material);
    free(names.object);
}

/* Keys come last, so that they find finished saves and loaded files. */
static void take_events(struct studio *studio, struct pollfd fds[FDS])
{
    uint64_t now_ns;

    if (fds[FD_SIGNALS].revents)
        take_signals(studio);
    if (studio->is_ending)
        return;
    if (fds[FD_RENDER].revents)
        event_fd_clear(fds[FD_RENDER].fd); /* live_render_update() follows */
    if (fds[FD_SAVER].revents)
        save_finish(&studio->control);
    if (fds[FD_AUTOSAVE].revents)
        autosave_finish(&studio->autosave);
    if (fds[FD_KEEPER_TIMER].revents)
        autosave_write(&studio->autosave);
    if (fds[FD_DEVICE].revents)
        live_render_end_device(&studio->control);
    if (fds[FD_FILES].revents)
        live_render_check_files(&studio->control);
    if (fds[FD_RELOAD].revents)
        take_reload(studio);
    if (fds[FD_KEYS].revents)
        take_input(studio);
    now_ns = clock_ns();
    if (now_ns >= input_deadline_ns(studio))
        take_byte_events(studio, true);
    frame_pacing_tick(&studio->workspace.screen.pace, now_ns);
}

static void wait_for_events(struct studio *studio)
{
    const struct cl_start *start =
        studio->control.session->engine.backends.start;
    struct pollfd fds[FDS] = {
        [FD_KEYS].fd = STDIN_FILENO,
        [FD_SIGNALS].fd = tty_signal_fd(),
        [FD_RENDER].fd =
            render_event_fd(studio->control.session->engine.render),
        [FD_SAVER].fd = studio->control.saver.copying.event_fd,
        [FD_AUTOSAVE].fd = studio->control.keeping.copying.event_fd,
        [FD_KEEPER_TIMER].fd = studio->autosave.timer_fd,
        [FD_DEVICE].fd = start ? cl_start_event_fd(start) : -1,
        [FD_FILES].fd = studio->control.watch.fd,
        [FD_RELOAD].fd = studio->control.is_live
                             ? studio->control.reload.loading.event_fd
                             : -1,
    };
    uint64_t now_ns = clock_ns();
    uint64_t until_ns = wake_ns(studio, now_ns);
    uint64_t pause_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec pause = {(time_t)(pause_ns / S_NS),
                             (long)(pause_ns % S_NS)};

    for (int i = 0; i < FDS; i++)
        fds[i].events = POLLIN;
    if (ppoll(fds, FDS, until_ns == NEVER ? NULL : &pause, NULL) < 0)
        memset(fds, 0, sizeof fds); /* interrupted: FD_SIGNALS wakes it next */
    take_events(studio, fds);
}

/* A write to the terminal has failed: a signal has come, or the terminal is
 * gone. */
static void lose_terminal(struct studio *studio)
{
    take_signals(studio);
    if (studio->is_ending)
        return;
    studio->is_gone = true;
    studio_end(studio, 128 + SIGHUP);
}

static void loop(struct studio *studio)
{
    while (!studio->is_ending) {
        uint64_t now_ns = clock_ns();

        camera_control_step(&studio->camera, now_ns);
        workspace_look(&studio->workspace);
        if (!workspace_draw(&studio->workspace, now_ns))
            lose_terminal(studio);
        if (!studio->is_ending)
            wait_for_events(studio);
    }
}

static void close_screen(struct studio *studio)
{
    /* Ctrl-C and Ctrl-\ are typed, as q is */
    bool is_lost =
        studio->status == 128 + SIGHUP || studio->status == 128 + SIGTERM;

    if (is_lost)
        tty_ignore_termination(); /* shells send SIGHUP again */
    if (!studio->is_gone)
        screen_drain(&studio->workspace.screen, &studio->input);
    /* before what may take longer than stop.h allows: a driver, or a tree */
    stop_hold();
    save_finish(&studio->control);
    autosave_end(&studio->autosave, is_lost);
    stop_release();
    /* before tty_close(): its end puts back the signal handlers of its start */
    backends_abandon_device(&studio->control.session->engine.backends);
    tty_close(studio->is_gone);
    for (int i = 0; i < studio->control.result_count && !studio->is_gone; i++)
        print_line(stdout, "%s", studio->control.results[i]);
    fflush(stdout);
    render_halt(studio->control.session->engine.render);
}

/* The render starts first: it works while the terminal is opened. */
bool event_loop_run(struct session *s, int *status, struct error *err)
{
    const char *stats_path = s->options->stats_path;
    struct studio studio = {.has_mouse = true};
    bool ok;

    workspace_expect(s);
    if (stats_path && (!session_check_output(s, "--stats", stats_path, err) ||
                       !stats_json_check(stats_path, err)))
        return false;
    if (!live_render_init(&studio.control, s, err))
        return false;
    camera_control_init(&studio.camera, &studio.control,
                        &studio.workspace.screen);
    workspace_init(&studio.workspace, &studio.control, &studio.camera);
    ok = tty_open(err);
    if (ok) {
        workspace_open(&studio.workspace);
        if (s->notice[0] != '\0')
            live_render_say_long(&studio.control, "%s", s->notice);
        s->notice[0] = '\0';
        autosave_init(&studio.autosave, &studio.control, &studio.camera);
        if (studio.autosave.has_offer)
            question_ask(&studio, QUESTION_KEPT);
        /* after tty_open(): it puts back the signal handlers that it finds */
        if (s->options->backend != BACKEND_CPU)
            live_render_begin_device(&studio.control);
        loop(&studio);
        close_screen(&studio);
        autosave_free(&studio.autosave);
        *status = studio.status;
        session_progress(s);
        ok = !stats_path || stats_json_write(s, false, stats_path, err);
    }
    workspace_free(&studio.workspace);
    live_render_free(&studio.control);
    return ok;
}
