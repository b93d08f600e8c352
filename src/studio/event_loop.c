// SPDX-License-Identifier: MIT
#include "studio/event_loop.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/memory.h"
#include "base/print.h"
#include "session/stats_json.h"
#include "studio/panel_draw.h"
#include "studio/prompts.h"
#include "studio/save_commands.h"
#include "studio/workspace.h"

#define MS_NS UINT64_C(1000000)
#define S_NS  UINT64_C(1000000000)
#define NEVER UINT64_MAX

/* A lone ESC is the key when nothing has followed for so long. */
#define ESCAPE_NS (50 * MS_NS)

/* What the loop waits for: keys, signals, the render, the saver, a device,
 * files that change, and those that are loaded. */
#define FDS 7

struct tui {
    struct render_control work;
    struct camera_control pilot;
    struct workspace stage;
    struct tty_input input;
    uint64_t byte_ns; /* when its last one came */
    bool has_mouse;
    enum question question;
    bool is_ending;
    bool is_gone; /* the terminal */
    int status;   /* exit status */
};

static void end(struct tui *t, int status)
{
    t->is_ending = true;
    t->status = status;
}

static void switch_mouse(struct tui *t)
{
    t->has_mouse = !t->has_mouse;
    camera_control_stop(&t->pilot);
    tty_set_mouse(t->has_mouse);
    render_control_say(&t->work, t->has_mouse ? "mouse on: drag to look around"
                                              : "mouse off");
}

/* ---- input ---- */

static void suspend(struct tui *t)
{
    screen_drain(&t->stage.canvas, &t->input);
    t->input.length = 0; /* what was typed behind it is for the shell */
    tty_suspend();
    workspace_layout(&t->stage);
}

static void set_live(struct tui *t, bool is_live)
{
    camera_control_stop(&t->pilot);
    inspector_leave(&t->stage.inside);
    render_control_set_live(&t->work, is_live);
}

static void ask(struct tui *t, enum question question)
{
    t->question = question;
    workspace_ask(&t->stage, question_text(question));
}

static void change_mode(struct tui *t)
{
    if (work_finish_saving(&t->work) && render_control_has_unsaved(&t->work))
        ask(t, QUESTION_LIVE);
    else
        set_live(t, !t->work.is_live);
}

static void quit(struct tui *t)
{
    if (!work_finish_saving(&t->work))
        return;
    if (render_control_has_unsaved(&t->work))
        ask(t, QUESTION_QUIT);
    else if (render_control_has_unsaved_edit(&t->work))
        ask(t, QUESTION_EDIT);
    else
        end(t, 0);
}

/* What was picked while the panel is open is selected in it. */
static void follow_pick(struct tui *t)
{
    struct editor_panel *panel = &t->stage.panel;

    if (t->pilot.cursor.is_pick_new && panel->is_open) {
        editor_panel_select(panel, &t->pilot.cursor.pick);
        panel_draw(panel);
    }
    t->pilot.cursor.is_pick_new = false;
}

/* The cursor on the picture has its keys first. */
static bool panel_takes(struct tui *t, int key)
{
    struct editor_panel *panel = &t->stage.panel;

    if (!panel->is_open || (t->stage.canvas.has_cursor && !panel->is_typing) ||
        !editor_panel_key(panel, key))
        return false;
    if (!panel->is_open)
        workspace_layout(&t->stage);
    else
        panel_draw(panel);
    return true;
}

static void restart(struct tui *t)
{
    if (work_finish_saving(&t->work) && render_control_has_unsaved(&t->work))
        ask(t, QUESTION_RESTART);
    else
        render_control_restart(&t->work);
}

static void act(struct tui *t, enum action action)
{
    if (camera_control_act(&t->pilot, action))
        return;
    render_control_settle(&t->work);
    if (workspace_act(&t->stage, action))
        return;
    switch (action) {
    case ACTION_KEEP: ask(t, QUESTION_NUMBER); break;
    case ACTION_MODE: change_mode(t); break;
    case ACTION_START: render_control_start_or_halt(&t->work); break;
    case ACTION_STEP: render_control_step(&t->work); break;
    case ACTION_RESTART: restart(t); break;
    case ACTION_SAVE_VIEW: work_save_view(&t->work); break;
    case ACTION_RELOAD: render_control_reload(&t->work); break;
    case ACTION_BACKEND: render_control_switch_backend(&t->work); break;
    case ACTION_MOUSE: switch_mouse(t); break;
    case ACTION_QUIT: quit(t); break;
    case ACTION_INTERRUPT: end(t, 128 + SIGINT); break;
    case ACTION_ABORT: end(t, 128 + SIGQUIT); break;
    case ACTION_SUSPEND: suspend(t); break;
    default: break;
    }
}

static void answer_question(struct tui *t, int key)
{
    enum question question = t->question;
    enum answer answer = question_answer(question, key);

    ask(t, QUESTION_NONE);
    if (question == QUESTION_NUMBER) {
        camera_control_keep_view(&t->pilot,
                                 keymap_action(&t->work.session->options->keys,
                                               key));
    } else if (answer == ANSWER_SAVE && question == QUESTION_EDIT) {
        if (work_save_edit(&t->work))
            quit(t);
    } else if (answer == ANSWER_SAVE) {
        work_save_picture(&t->work, "png");
    } else if (answer == ANSWER_YES) {
        if (question == QUESTION_LIVE)
            set_live(t, true);
        else if (question == QUESTION_RESTART)
            render_control_restart(&t->work);
        else
            end(t, 0);
    }
}

static void take_key(struct tui *t, int key)
{
    enum action action = keymap_action(&t->work.session->options->keys, key);
    bool is_urgent = action == ACTION_INTERRUPT || action == ACTION_ABORT ||
                     action == ACTION_SUSPEND || action == ACTION_REDRAW;

    render_control_be_heard(&t->work);
    if (is_urgent)
        act(t, action);
    else if (t->question != QUESTION_NONE)
        answer_question(t, key);
    else if (t->stage.help_left > 0)
        workspace_turn_help(&t->stage, action == ACTION_CANCEL);
    else if (t->stage.canvas.is_too_small && action != ACTION_QUIT)
        return;
    else if (!panel_takes(t, key))
        act(t, action);
    follow_pick(t);
}

static void take_mouse(struct tui *t, const struct event *event)
{
    if (editor_panel_mouse(&t->stage.panel, event))
        panel_draw(&t->stage.panel);
    else
        camera_control_mouse(&t->pilot, event);
    follow_pick(t);
}

static void take_event(struct tui *t, const struct event *event)
{
    struct workspace *st = &t->stage;
    enum palette palette = st->canvas.display.palette;

    if (event->kind == EVENT_KEY) {
        take_key(t, event->key);
    } else if (event->kind == EVENT_MOUSE) {
        if (t->has_mouse && st->help_left == 0 && !st->canvas.is_too_small)
            take_mouse(t, event);
    } else {
        if (screen_answer(&st->canvas, event))
            workspace_layout(st);
        if (st->canvas.display.palette != palette)
            workspace_refresh(st);
    }
}

static void take_byte_events(struct tui *t, bool nothing_follows)
{
    struct event event;

    while (!t->is_ending && tty_input_next(&t->input, nothing_follows, &event))
        take_event(t, &event);
}

/* All keys that wait, so that a frame follows all of them. */
static void take_input(struct tui *t)
{
    unsigned char bytes[1024];
    int count;

    while (!t->is_ending && (count = tty_read(bytes, sizeof bytes)) != 0) {
        if (count < 0) {
            t->is_gone = true;
            end(t, 128 + SIGHUP);
            return;
        }
        t->byte_ns = clock_ns();
        tty_input_feed(&t->input, bytes, (size_t)count);
        take_byte_events(t, false);
    }
}

static void take_signals(struct tui *t)
{
    int number;

    while ((number = tty_signal()) != 0) {
        switch (number) {
        case SIGTERM:
        case SIGHUP:
        case SIGINT:
        case SIGQUIT: end(t, 128 + number); return;
        case SIGTSTP: suspend(t); break;
        case SIGCONT:
            tty_resume();
            workspace_layout(&t->stage);
            break;
        case SIGWINCH: workspace_layout(&t->stage); break;
        default: break;
        }
    }
}

/* ---- loop ---- */

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* A lone ESC becomes a key soon; an answer may come in pieces. */
static uint64_t input_deadline_ns(const struct tui *t)
{
    if (!tty_input_is_partial(&t->input))
        return NEVER;
    return t->byte_ns + (t->input.length == 1 ? ESCAPE_NS : S_NS);
}

/* When there is something to do if nothing happens. */
static uint64_t wake_ns(const struct tui *t, uint64_t now_ns)
{
    return earlier(workspace_next_ns(&t->stage, now_ns),
                   earlier(camera_control_next_ns(&t->pilot),
                           input_deadline_ns(t)));
}

static void take_reload(struct tui *t)
{
    struct selection_names names = selection_names(&t->stage.panel.selection);

    if (render_control_end_reload(&t->work)) {
        camera_control_renew(&t->pilot);
        workspace_renew(&t->stage, &names);
    }
    free(names.material);
    free(names.object);
}

/* Keys last: they find what is done by then. */
static void take_events(struct tui *t, struct pollfd fds[FDS])
{
    uint64_t now_ns;

    if (fds[1].revents)
        take_signals(t);
    if (t->is_ending)
        return;
    if (fds[2].revents)
        event_fd_clear(fds[2].fd); /* render_control_look() sees what it says */
    if (fds[3].revents)
        work_finish_saving(&t->work);
    if (fds[4].revents)
        render_control_end_device(&t->work);
    if (fds[5].revents)
        render_control_look_at_files(&t->work);
    if (fds[6].revents)
        take_reload(t);
    if (fds[0].revents)
        take_input(t);
    now_ns = clock_ns();
    if (now_ns >= input_deadline_ns(t))
        take_byte_events(t, true);
    frame_pacing_tick(&t->stage.canvas.pace, now_ns);
}

static void wait_for_events(struct tui *t)
{
    const struct cl_start *start = t->work.session->machines.start;
    struct pollfd fds[FDS] = {
        {.fd = STDIN_FILENO, .events = POLLIN},
        {.fd = tty_signal_fd(), .events = POLLIN},
        {.fd = render_event_fd(t->work.session->render), .events = POLLIN},
        {.fd = t->work.saver.event_fd, .events = POLLIN},
        {.fd = start ? cl_start_event_fd(start) : -1, .events = POLLIN},
        {.fd = t->work.watch.fd, .events = POLLIN},
        {.fd = t->work.is_live ? t->work.reload.event_fd : -1,
         .events = POLLIN},
    };
    uint64_t now_ns = clock_ns();
    uint64_t until_ns = wake_ns(t, now_ns);
    uint64_t pause_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec pause = {(time_t)(pause_ns / S_NS),
                             (long)(pause_ns % S_NS)};

    if (ppoll(fds, FDS, until_ns == NEVER ? NULL : &pause, NULL) < 0)
        memset(fds, 0, sizeof fds); /* a signal: its byte is in the pipe */
    take_events(t, fds);
}

/* The terminal takes nothing any more: why? */
static void lose_terminal(struct tui *t)
{
    take_signals(t);
    if (t->is_ending)
        return;
    t->is_gone = true;
    end(t, 128 + SIGHUP);
}

static void loop(struct tui *t)
{
    while (!t->is_ending) {
        uint64_t now_ns = clock_ns();

        camera_control_step(&t->pilot, now_ns);
        workspace_look(&t->stage);
        if (!workspace_draw(&t->stage, now_ns))
            lose_terminal(t);
        if (!t->is_ending)
            wait_for_events(t);
    }
}

/* A line that is lost is nobody's wish: the picture is kept if it is worth it.
 * SIGTERM is an orderly end, as q is, but cannot ask: what q would ask about is
 * kept. Ctrl-C and Ctrl-\ are typed, and mean it. */
static void keep_picture(struct tui *t)
{
    if (t->status == 128 + SIGHUP ||
        (t->status == 128 + SIGTERM && render_control_has_unsaved(&t->work)))
        work_keep(&t->work);
}

static void close_screen(struct tui *t)
{
    if (t->status == 128 + SIGHUP || t->status == 128 + SIGTERM)
        tty_ignore_ends(); /* shells send SIGHUP again */
    if (!t->is_gone)
        screen_drain(&t->stage.canvas, &t->input);
    /* else it might put our signals back when they are no longer ours */
    backends_abandon_device(&t->work.session->machines);
    tty_close(t->is_gone);
    render_halt(t->work.session->render);
    work_finish_saving(&t->work);
    keep_picture(t);
    for (int i = 0; i < t->work.result_count && !t->is_gone; i++)
        print_line(stdout, "%s", t->work.results[i]);
    fflush(stdout);
}

static void say_lost(struct tui *t, const char *path)
{
    char *text = xformat("picture of the lost session: %s", path);

    render_control_say_long(&t->work, "%s", text);
    render_control_add_result(&t->work,
                              text); /* it is long, and the line is not */
    free(text);
}

/* The render starts first, so that it works while the terminal is opened. */
bool event_loop_run(struct session *s, const char *lost, int *status,
                    struct error *err)
{
    const char *stats_path = s->options->stats_path;
    struct tui t = {.has_mouse = true};
    bool ok;

    workspace_expect(s);
    if (stats_path && (!session_spares(s, "--stats", stats_path, err) ||
                       !stats_json_check(stats_path, err)))
        return false;
    if (!render_control_init(&t.work, s, err))
        return false;
    camera_control_init(&t.pilot, &t.work, &t.stage.canvas);
    workspace_init(&t.stage, &t.work, &t.pilot);
    ok = tty_open(err);
    if (ok) {
        workspace_open(&t.stage);
        if (s->notice[0] != '\0')
            render_control_say_long(&t.work, "%s", s->notice);
        s->notice[0] = '\0';
        if (lost)
            say_lost(&t, lost);
        /* not before: it puts back the signals that it has found */
        if (s->options->backend != BACKEND_CPU)
            render_control_begin_device(&t.work);
        loop(&t);
        close_screen(&t);
        *status = t.status;
        session_look(s);
        ok = !stats_path || stats_json_write(s, stats_path, err);
    }
    workspace_free(&t.stage);
    camera_control_free(&t.pilot);
    render_control_free(&t.work);
    return ok;
}
