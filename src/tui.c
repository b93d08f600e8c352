// SPDX-License-Identifier: MIT
#include "glim/tui.h"

#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "glim/canvas.h"
#include "glim/file.h"
#include "glim/keys.h"
#include "glim/saver.h"
#include "glim/steer.h"
#include "glim/version.h"

#define MS_NS UINT64_C(1000000)
#define S_NS  UINT64_C(1000000000)
#define NEVER UINT64_MAX

/* Between frames: while the first pass fills the picture, while it is young,
 * and when a frame differs little from the one before. */
#define FRAME_FIRST_NS (16 * MS_NS)
#define FRAME_YOUNG_NS (100 * MS_NS)
#define FRAME_OLD_NS   (250 * MS_NS)
#define OLD_NS         (10 * S_NS)

/* From this age on cells that changed by no more than STEP of 255 may stay
 * until the end; on a slow line from the beginning, and more. */
#define SETTLING_NS (2 * S_NS)
#define STEP        2
#define STEP_SLOW   8

#define STATUS_NS  (250 * MS_NS)
#define MESSAGE_NS (4 * S_NS)
#define NOTICE_NS  (8 * S_NS)

/* A lone ESC is the key when nothing has followed for so long. */
#define ESCAPE_NS (50 * MS_NS)

#define HELP_LINES_MAX 32
#define HELP_LINE_MAX  64

enum question {
    QUESTION_NONE,
    QUESTION_QUIT,
    QUESTION_LIVE /* leave normal mode */
};

struct tui {
    struct session *session;
    struct canvas canvas;
    struct input input;
    struct steer steer;
    struct saver saver;
    struct render_progress progress;

    bool is_live;
    bool is_started;         /* normal mode: a render was begun */
    bool is_halted;          /* normal mode: by the person */
    uint64_t saved_samples;  /* of the normal render, in a file */
    uint64_t saving_samples; /* that the saver will have written */
    char saving_spp[32];

    bool has_mouse;

    bool is_settled; /* nothing of the picture is left to be shown */
    bool must_restart;
    uint64_t restarted_ns;
    uint64_t frame_ns; /* when the next frame is due */
    uint64_t status_ns;

    char message[STATUS_BYTES];
    bool is_error; /* stays until a key */
    uint64_t message_until_ns;
    enum question question;
    bool has_help;

    uint64_t byte_ns; /* when the last one came */
    bool is_ending;
    bool is_gone;
    int status;
    char **results; /* lines for after the end */
    int result_count;
};

static void say(struct tui *t, const char *text, uint64_t for_ns)
{
    snprintf(t->message, sizeof t->message, "%s", text);
    t->is_error = false;
    t->message_until_ns = clock_ns() + for_ns;
    t->status_ns = 0;
}

static void say_error(struct tui *t, const char *text)
{
    say(t, text, MESSAGE_NS);
    t->is_error = true;
    t->message_until_ns = NEVER;
}

static void end(struct tui *t, int status)
{
    t->is_ending = true;
    t->status = status;
}

static bool layout(struct tui *t)
{
    const struct film *film = render_film(t->session->render);
    struct error err;

    t->is_settled = false;
    t->has_help = false;
    t->frame_ns = 0;
    t->status_ns = 0;
    if (canvas_layout(&t->canvas, film->width, film->height, &err))
        return true;
    t->canvas.is_too_small = true;
    return false;
}

/* ---- render ---- */

static void restart(struct tui *t)
{
    uint64_t spp = t->is_live ? 0 : t->session->options->spp;
    struct error err;

    saver_wait_copied(&t->saver);
    if (!session_restart(t->session, spp, &err))
        say_error(t, err.text);
    t->must_restart = false;
    t->restarted_ns = clock_ns();
    t->is_settled = false;
    t->frame_ns = 0;
    t->progress = render_progress(t->session->render);
}

/* While a picture of the old place is being begun it is finished first, or a
 * scene that is slow to begin would never show anything on the way. */
static void restart_if_due(struct tui *t)
{
    bool has_begun = t->progress.first_picture_ns != 0 ||
                     t->progress.state != RENDER_RUNNING;

    if (t->must_restart && has_begun)
        restart(t);
}

static bool has_unsaved(const struct tui *t)
{
    return !t->is_live && t->is_started &&
           t->progress.samples > t->saved_samples;
}

static void set_live(struct tui *t, bool is_live)
{
    t->is_live = is_live;
    t->is_started = false;
    t->is_halted = false;
    t->saved_samples = 0;
    t->status_ns = 0;
    if (is_live) {
        say(t, "live mode: every change starts anew", MESSAGE_NS);
        restart(t);
        return;
    }
    motion_stop(&t->steer.motion);
    t->must_restart = false;
    render_halt(t->session->render);
    t->is_settled = false;
    say(t, "normal mode: Enter starts the render, space goes back", MESSAGE_NS);
}

static void change_mode(struct tui *t)
{
    if (!has_unsaved(t)) {
        set_live(t, !t->is_live);
        return;
    }
    t->question = QUESTION_LIVE;
}

static void start_or_halt(struct tui *t)
{
    struct render *render = t->session->render;

    t->status_ns = 0;
    if (t->is_live) {
        say(t, "Enter starts a render in normal mode: space goes there",
            MESSAGE_NS);
    } else if (!t->is_started) {
        t->is_started = true;
        t->is_halted = false;
        t->saved_samples = 0;
        t->saving_samples = 0; /* of the picture before */
        restart(t);
    } else if (t->progress.state == RENDER_RUNNING) {
        render_halt(render);
        t->is_halted = true;
        t->is_settled = false;
    } else if (t->progress.state == RENDER_IDLE) {
        t->is_halted = false;
        t->is_settled = false;
        render_resume(render, t->session->options->spp);
    } else {
        say(t, "the render is done: p saves it, space goes to live mode",
            MESSAGE_NS);
    }
}

/* ---- files ---- */

/* The scene's name in the current folder, without its ending. */
static char *picture_stem(const struct tui *t)
{
    char *stem = path_stem(t->session->scene.path);
    const char *slash = strrchr(stem, '/');
    char *name = xstrdup(slash ? slash + 1 : stem);

    free(stem);
    return name;
}

static void save_picture(struct tui *t)
{
    char *stem = picture_stem(t);
    struct error err;

    t->saving_samples = t->is_started ? t->progress.samples : 0;
    snprintf(t->saving_spp, sizeof t->saving_spp, "%" PRIu64 " spp",
             t->progress.spp_done);
    if (t->progress.samples == 0)
        say(t, "nothing to save yet", MESSAGE_NS);
    else if (saver_begin(&t->saver, render_film(t->session->render),
                         (float)t->session->view.exposure, stem, &err))
        say(t, "saving ...", NOTICE_NS);
    else
        say_error(t, err.text);
    free(stem);
}

static void add_result(struct tui *t, const char *text)
{
    t->results = xrealloc(t->results,
                          ((size_t)t->result_count + 1) * sizeof t->results[0]);
    t->results[t->result_count++] = xstrdup(text);
}

/* Waits for the picture that is being saved. False if it failed. */
static bool finish_saving(struct tui *t)
{
    const struct film *film = render_film(t->session->render);
    struct error err;
    char *name, *text;

    if (!t->saver.is_busy)
        return true;
    name = saver_finish(&t->saver, &err);
    if (!name) {
        say_error(t, err.text);
        add_result(t, err.text);
        return false;
    }
    text = xformat("saved %s %dx%d, %s", name, film->width, film->height,
                   t->saving_spp);
    say(t, text, MESSAGE_NS);
    add_result(t, text);
    if (t->is_started)
        t->saved_samples = t->saving_samples;
    free(text);
    free(name);
    return true;
}

static void save_view(struct tui *t)
{
    const struct session *s = t->session;
    struct error err;
    char *text;

    if (!view_write(&s->view, s->view_path, &err)) {
        say_error(t, err.text);
        return;
    }
    text = xformat("wrote the view to %s", s->view_path);
    say(t, text, MESSAGE_NS);
    add_result(t, text);
    free(text);
}

/* ---- camera ---- */

static bool may_move(struct tui *t)
{
    if (!t->is_live)
        say(t, "the camera moves in live mode: space goes there", MESSAGE_NS);
    return t->is_live;
}

static void press(struct tui *t, enum motion_axis axis, int sign)
{
    if (may_move(t))
        motion_press(&t->steer.motion, axis, sign, clock_ns());
}

static void step_motion(struct tui *t, uint64_t now_ns)
{
    if (now_ns >= motion_next_ns(&t->steer.motion) &&
        steer_step(&t->steer, &t->session->view, now_ns))
        t->must_restart = true;
}

static void change_speed(struct tui *t, int steps)
{
    char text[64];

    steer_change_speed(&t->steer, steps);
    snprintf(text, sizeof text, "speed %.3g of the scene's size a second",
             t->steer.speed);
    say(t, text, MESSAGE_NS);
}

static void reset_view(struct tui *t)
{
    if (!may_move(t))
        return;
    motion_stop(&t->steer.motion);
    view_copy(&t->session->view, &t->session->opened);
    t->must_restart = true;
    say(t, "the view as it was opened", MESSAGE_NS);
}

static void take_mouse(struct tui *t, const struct event *event)
{
    const struct film *film = render_film(t->session->render);

    if (!t->has_mouse || t->has_help || t->canvas.is_too_small)
        return;
    if (event->mouse == MOUSE_WHEEL_UP)
        change_speed(t, 1);
    else if (event->mouse == MOUSE_WHEEL_DOWN)
        change_speed(t, -1);
    else if ((event->mouse != MOUSE_DRAG || may_move(t)) &&
             steer_mouse(&t->steer, &t->session->view, event, &t->canvas.fit,
                         film->width, film->height))
        t->must_restart = true;
}

/* ---- help, screen ---- */

static void open_help(struct tui *t)
{
    static char texts[HELP_LINES_MAX][HELP_LINE_MAX];
    const char *lines[HELP_LINES_MAX];
    const struct keys_help *help;
    int count = 0;

    while (count < HELP_LINES_MAX - 2 &&
           (help = keys_help(count, t->session->options->phoe_keys))) {
        snprintf(texts[count], HELP_LINE_MAX, "%-7s %s", help->keys,
                 help->text);
        count++;
    }
    if (t->canvas.pace.state == PACE_ANSWERS)
        snprintf(texts[count++], HELP_LINE_MAX,
                 "%s; the terminal answers in %.1f ms",
                 palette_name(t->canvas.palette),
                 (double)t->canvas.pace.rtt_min_ns * 1e-6);
    else
        snprintf(texts[count++], HELP_LINE_MAX, "%s",
                 palette_name(t->canvas.palette));
    for (int i = 0; i < count; i++)
        lines[i] = texts[i];
    canvas_open_window(&t->canvas, " glim " GLIM_VERSION " - any key closes ",
                       lines, count);
    t->has_help = true;
    t->is_settled = false;
}

static void close_help(struct tui *t)
{
    canvas_close_window(&t->canvas);
    t->has_help = false;
    t->is_settled = false;
    t->frame_ns = 0;
}

static void next_colors(struct tui *t)
{
    canvas_next_palette(&t->canvas);
    say(t, palette_name(t->canvas.palette), MESSAGE_NS);
    t->is_settled = false;
    t->frame_ns = 0;
}

static void switch_mouse(struct tui *t)
{
    t->has_mouse = !t->has_mouse;
    t->steer.is_dragging = false;
    term_set_mouse(t->has_mouse);
    say(t, t->has_mouse ? "mouse on: drag to look around" : "mouse off",
        MESSAGE_NS);
}

/* ---- input ---- */

static void suspend(struct tui *t)
{
    canvas_drain(&t->canvas, &t->input);
    term_suspend();
    layout(t);
}

static void quit(struct tui *t)
{
    if (!finish_saving(t))
        return;
    if (has_unsaved(t))
        t->question = QUESTION_QUIT;
    else
        end(t, 0);
}

/* The keys that do something of their own kind. */
static void act(struct tui *t, enum action action)
{
    switch (action) {
    case ACTION_FORWARD: press(t, MOTION_FORWARD, 1); break;
    case ACTION_BACK: press(t, MOTION_FORWARD, -1); break;
    case ACTION_LEFT: press(t, MOTION_RIGHT, -1); break;
    case ACTION_RIGHT: press(t, MOTION_RIGHT, 1); break;
    case ACTION_DOWN: press(t, MOTION_UP, -1); break;
    case ACTION_UP: press(t, MOTION_UP, 1); break;
    case ACTION_LOOK_UP: press(t, MOTION_LOOK_UP, 1); break;
    case ACTION_LOOK_DOWN: press(t, MOTION_LOOK_UP, -1); break;
    case ACTION_LOOK_LEFT: press(t, MOTION_LOOK_RIGHT, -1); break;
    case ACTION_LOOK_RIGHT: press(t, MOTION_LOOK_RIGHT, 1); break;
    case ACTION_FASTER: change_speed(t, 1); break;
    case ACTION_SLOWER: change_speed(t, -1); break;
    case ACTION_MODE: change_mode(t); break;
    case ACTION_START: start_or_halt(t); break;
    case ACTION_SAVE: save_picture(t); break;
    case ACTION_SAVE_VIEW: save_view(t); break;
    case ACTION_RESET: reset_view(t); break;
    case ACTION_HIDE:
        t->canvas.has_status_row = !t->canvas.has_status_row;
        layout(t);
        break;
    case ACTION_COLORS: next_colors(t); break;
    case ACTION_MOUSE: switch_mouse(t); break;
    case ACTION_REDRAW: layout(t); break;
    case ACTION_HELP: open_help(t); break;
    case ACTION_QUIT: quit(t); break;
    case ACTION_INTERRUPT: end(t, 128 + SIGINT); break;
    case ACTION_ABORT: end(t, 128 + SIGQUIT); break;
    case ACTION_SUSPEND: suspend(t); break;
    case ACTION_NONE: break;
    }
}

static void answer_question(struct tui *t, int key)
{
    enum question question = t->question;

    t->question = QUESTION_NONE;
    t->status_ns = 0;
    if (key == 'p' || key == 'P') {
        save_picture(t);
    } else if (key == 'y' || key == 'Y') {
        if (question == QUESTION_QUIT)
            end(t, 0);
        else
            set_live(t, true);
    }
}

static void take_key(struct tui *t, int key)
{
    enum action action = keys_action(key, t->session->options->phoe_keys);
    bool is_urgent = action == ACTION_INTERRUPT || action == ACTION_ABORT ||
                     action == ACTION_SUSPEND || action == ACTION_REDRAW;

    if (t->is_error) {
        t->is_error = false;
        t->message_until_ns = 0;
        t->status_ns = 0;
    }
    if (is_urgent)
        act(t, action);
    else if (t->question != QUESTION_NONE)
        answer_question(t, key);
    else if (t->has_help)
        close_help(t);
    else if (!t->canvas.is_too_small || action == ACTION_QUIT)
        act(t, action);
}

static void take_event(struct tui *t, const struct event *event)
{
    enum palette palette = t->canvas.palette;
    enum glyphs glyphs = t->canvas.glyphs;

    if (event->kind == EVENT_KEY) {
        take_key(t, event->key);
    } else if (event->kind == EVENT_MOUSE) {
        take_mouse(t, event);
    } else {
        if (canvas_answer(&t->canvas, event))
            layout(t);
        if (t->canvas.palette != palette || t->canvas.glyphs != glyphs) {
            t->is_settled = false;
            t->frame_ns = 0;
            t->status_ns = 0;
        }
    }
}

static void take_byte_events(struct tui *t, bool nothing_follows)
{
    struct event event;

    while (!t->is_ending && input_next(&t->input, nothing_follows, &event))
        take_event(t, &event);
}

/* All keys that wait, so that a frame follows all of them. */
static void take_input(struct tui *t)
{
    unsigned char bytes[1024];
    int count;

    while (!t->is_ending && (count = term_read(bytes, sizeof bytes)) != 0) {
        if (count < 0) {
            t->is_gone = true;
            end(t, 128 + SIGHUP);
            return;
        }
        t->byte_ns = clock_ns();
        input_feed(&t->input, bytes, (size_t)count);
        take_byte_events(t, false);
    }
}

static void take_signals(struct tui *t)
{
    int number;

    while ((number = term_signal()) != 0) {
        switch (number) {
        case SIGTERM:
        case SIGHUP:
        case SIGINT:
        case SIGQUIT: end(t, 128 + number); return;
        case SIGTSTP: suspend(t); break;
        case SIGCONT:
            term_resume();
            layout(t);
            break;
        case SIGWINCH: layout(t); break;
        default: break;
        }
    }
}

/* ---- drawing ---- */

static void format_status(struct tui *t, char text[STATUS_BYTES])
{
    const struct film *film = render_film(t->session->render);
    struct status status = {
        .is_live = t->is_live,
        .is_halted = t->is_halted,
        .is_started = t->is_started,
        .progress = &t->progress,
        .thread_count = render_backend(t->session->render)->thread_count,
        .width_px = film->width,
        .height_px = film->height,
        .colors = palette_name(t->canvas.palette),
    };

    status_format(text, term_size().cols, &status);
}

static void update_status(struct tui *t, uint64_t now_ns)
{
    static const char *const questions[] = {
        [QUESTION_QUIT] =
            "The render is not saved. Quit? y: yes, p: save it, other: no",
        [QUESTION_LIVE] =
            "The render is not saved. Leave it? y: yes, p: save it, other: no",
    };
    char text[STATUS_BYTES];

    if (t->question != QUESTION_NONE) {
        status_message(text, term_size().cols, questions[t->question]);
    } else if (now_ns < t->message_until_ns) {
        status_message(text, term_size().cols, t->message);
    } else if (t->canvas.has_status_row) {
        format_status(t, text);
    } else {
        if (t->canvas.has_status)
            t->is_settled = false; /* the picture comes back there */
        canvas_status(&t->canvas, NULL);
        return;
    }
    canvas_status(&t->canvas, text);
}

static uint64_t frame_interval(const struct tui *t, uint64_t took_ns)
{
    uint64_t interval_ns = FRAME_FIRST_NS;

    if (t->progress.spp_done > 0)
        interval_ns =
            t->progress.render_ns > OLD_NS ? FRAME_OLD_NS : FRAME_YOUNG_NS;
    /* large windows must not take the time away from the render */
    return interval_ns > 2 * took_ns ? interval_ns : 2 * took_ns;
}

static int frame_step(const struct tui *t)
{
    if (t->progress.state != RENDER_RUNNING)
        return 0;
    if (pace_is_slow(&t->canvas.pace))
        return STEP_SLOW;
    return t->progress.render_ns > SETTLING_NS ? STEP : 0;
}

static void show_messages(struct tui *t, uint64_t now_ns)
{
    if (t->message_until_ns != 0 && now_ns >= t->message_until_ns) {
        t->message_until_ns = 0;
        t->status_ns = 0;
    }
    if (now_ns < t->status_ns)
        return;
    update_status(t, now_ns);
    t->status_ns = now_ns + STATUS_NS;
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

static void draw(struct tui *t, uint64_t now_ns)
{
    struct canvas *c = &t->canvas;
    bool is_running = t->progress.state == RENDER_RUNNING;
    bool has_picture = t->progress.first_picture_ns != 0 || !is_running;
    bool shows = has_picture && !t->is_settled && now_ns >= t->frame_ns;
    enum canvas_result result;

    show_messages(t, now_ns);
    if ((!shows && !c->must_update) || !pace_may_send(&c->pace))
        return;
    result = canvas_draw(c, shows ? render_film(t->session->render) : NULL,
                         (float)t->session->view.exposure, frame_step(t));
    if (result == CANVAS_GONE) {
        lose_terminal(t);
    } else if (shows) {
        uint64_t took_ns = clock_ns() - now_ns;

        t->is_settled = result == CANVAS_DONE && !is_running;
        t->frame_ns =
            result == CANVAS_MORE ? 0 : now_ns + frame_interval(t, took_ns);
    }
}

/* ---- loop ---- */

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static bool awaits_picture(const struct tui *t)
{
    return t->progress.state == RENDER_RUNNING &&
           t->progress.first_picture_ns == 0;
}

/* A lone ESC becomes a key soon; an answer may come in pieces. */
static uint64_t input_deadline_ns(const struct tui *t)
{
    if (!input_is_partial(&t->input))
        return NEVER;
    return t->byte_ns + (t->input.length == 1 ? ESCAPE_NS : S_NS);
}

/* When there is something to do if nothing happens. */
static uint64_t wake_ns(const struct tui *t, uint64_t now_ns)
{
    uint64_t wake = earlier(motion_next_ns(&t->steer.motion),
                            earlier(input_deadline_ns(t),
                                    pace_deadline_ns(&t->canvas.pace)));

    if (awaits_picture(t)) {
        /* looked for often at first, seldom while a tree is built */
        uint64_t waited_ns = now_ns - t->restarted_ns;
        uint64_t pause_ns = waited_ns / 8;

        pause_ns = pause_ns < MS_NS / 2 ? MS_NS / 2 : pause_ns;
        wake = earlier(wake, now_ns + earlier(pause_ns, 20 * MS_NS));
    } else if (!t->is_settled && pace_may_send(&t->canvas.pace)) {
        wake = earlier(wake, t->frame_ns);
    }
    if (t->progress.state == RENDER_RUNNING || t->status_ns == 0)
        wake = earlier(wake, t->status_ns);
    if (t->message_until_ns != 0)
        wake = earlier(wake, t->message_until_ns);
    return wake;
}

static void empty_events(int fd)
{
    uint64_t count;

    if (read(fd, &count, sizeof count) < 0) {
        /* nothing there */
    }
}

static void take_events(struct tui *t, struct pollfd fds[4])
{
    uint64_t now_ns;

    if (fds[1].revents)
        take_signals(t);
    if (fds[0].revents && !t->is_ending)
        take_input(t);
    if (fds[2].revents) {
        empty_events(fds[2].fd);
        t->is_settled = false;
        t->frame_ns = 0;
        t->status_ns = 0;
    }
    if (fds[3].revents)
        finish_saving(t);
    now_ns = clock_ns();
    if (now_ns >= input_deadline_ns(t))
        take_byte_events(t, true);
    pace_tick(&t->canvas.pace, now_ns);
}

static void wait_for_events(struct tui *t)
{
    struct pollfd fds[4] = {
        {.fd = STDIN_FILENO, .events = POLLIN},
        {.fd = term_signal_fd(), .events = POLLIN},
        {.fd = render_event_fd(t->session->render), .events = POLLIN},
        {.fd = t->saver.event_fd, .events = POLLIN},
    };
    uint64_t now_ns = clock_ns();
    uint64_t until_ns = wake_ns(t, now_ns);
    uint64_t pause_ns = until_ns > now_ns ? until_ns - now_ns : 0;
    struct timespec pause = {(time_t)(pause_ns / S_NS),
                             (long)(pause_ns % S_NS)};

    if (ppoll(fds, 4, until_ns == NEVER ? NULL : &pause, NULL) < 0)
        memset(fds, 0, sizeof fds); /* a signal: its byte is in the pipe */
    take_events(t, fds);
}

static void look_at_progress(struct tui *t)
{
    enum render_state before = t->progress.state;

    t->progress = render_progress(t->session->render);
    if (t->progress.state == RENDER_FAILED && before != RENDER_FAILED)
        say_error(t, t->progress.error.text);
}

static void loop(struct tui *t)
{
    while (!t->is_ending) {
        uint64_t now_ns = clock_ns();

        look_at_progress(t);
        step_motion(t, now_ns);
        restart_if_due(t);
        draw(t, now_ns);
        if (!t->is_ending)
            wait_for_events(t);
    }
}

/* After the terminal was given back. */
static void print_results(struct tui *t)
{
    for (int i = 0; i < t->result_count; i++) {
        if (!t->is_gone)
            printf("%s\n", t->results[i]);
        free(t->results[i]);
    }
    free(t->results);
    fflush(stdout);
}

static bool open_screen(struct tui *t, struct error *err)
{
    if (!term_open(err))
        return false;
    if (!canvas_init(&t->canvas, t->session->options, err)) {
        term_close(false);
        return false;
    }
    layout(t);
    return true;
}

/* The render starts first, so that it works while the terminal is opened. */
bool tui_run(struct session *s, int *status, struct error *err)
{
    struct tui t = {.session = s,
                    .is_live = true,
                    .has_mouse = true,
                    .restarted_ns = clock_ns()};

    steer_init(&t.steer, s->scene.bounds_lo, s->scene.bounds_hi);
    if (!session_restart(s, 0, err) || !saver_init(&t.saver, err))
        return false;
    if (!open_screen(&t, err)) {
        saver_free(&t.saver);
        return false;
    }
    if (s->notice[0] != '\0')
        say(&t, s->notice, NOTICE_NS);
    loop(&t);
    if (!t.is_gone)
        canvas_drain(&t.canvas, &t.input);
    term_close(t.is_gone);
    render_halt(s->render);
    finish_saving(&t);
    print_results(&t);
    canvas_free(&t.canvas);
    saver_free(&t.saver);
    *status = t.status;
    return true;
}
