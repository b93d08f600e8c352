// SPDX-License-Identifier: MIT
#include "glim/tui.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "glim/canvas.h"
#include "glim/gauge.h"
#include "glim/help.h"
#include "glim/inside.h"
#include "glim/panel_draw.h"
#include "glim/pilot.h"
#include "glim/stats.h"
#include "glim/version.h"
#include "glim/work_save.h"

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

#define STATUS_NS (250 * MS_NS)

/* A lone ESC is the key when nothing has followed for so long. */
#define ESCAPE_NS (50 * MS_NS)

/* What the loop waits for: keys, signals, the render, the saver, a device,
 * files that change, and those that are loaded. */
#define FDS 7

enum question {
    QUESTION_NONE,
    QUESTION_QUIT,
    QUESTION_EDIT, /* quit without what was edited */
    QUESTION_LIVE, /* leave normal mode */
    QUESTION_RESTART
};

struct tui {
    struct work work;
    struct canvas canvas;
    struct input input;
    struct pilot pilot;
    struct inside inside;
    struct panel panel;
    bool has_mouse;
    int help_number;    /* the page that is shown, */
    int help_left;      /* with those behind it; 0: no help */
    struct gauge gauge; /* hidden while the help is open */
    enum question question;

    bool is_settled;         /* nothing of the picture is left to be shown */
    uint64_t frame_ns;       /* when the next frame is due */
    uint64_t status_ns;      /* when to look for a new status line */
    uint64_t byte_ns;        /* when the last one came */
    int width_px, height_px; /* of the picture that has been laid out */

    bool is_ending;
    bool is_gone; /* the terminal */
    int status;   /* exit status */
};

static const struct film *film_of(const struct tui *t)
{
    return render_film(t->work.session->render);
}

/* Draw again as soon as possible. */
static void refresh_soon(struct tui *t)
{
    t->is_settled = false;
    t->frame_ns = 0;
    t->status_ns = 0;
    t->gauge.due_ns = 0;
}

static void end(struct tui *t, int status)
{
    t->is_ending = true;
    t->status = status;
}

/* From the next restart on: a cell shows two pixels, one above the other. */
static void set_draft(struct session *s, const struct fit *fit)
{
    s->draft_width = fit->cols;
    s->draft_height = 2 * fit->rows;
}

static void layout(struct tui *t)
{
    const struct film *film = film_of(t);
    struct error err;

    t->help_left = 0;
    t->width_px = film->width;
    t->height_px = film->height;
    refresh_soon(t);
    t->canvas.has_panel = t->panel.is_open;
    if (!canvas_layout(&t->canvas, film->width, film->height, &err)) {
        t->canvas.is_too_small = true; /* nothing can be drawn */
        work_say_error(&t->work, err.text);
    }
    panel_draw(&t->panel);
    /* until then the old draft is resampled */
    set_draft(t->work.session, &t->canvas.fit);
    inside_open_panel(&t->inside); /* it went with the layout */
}

/* ---- help, screen ---- */

static bool shows_gauge(const struct tui *t)
{
    return t->gauge.is_on && t->help_left == 0 && !t->canvas.is_too_small;
}

static void switch_gauge(struct tui *t)
{
    inside_stop_drawing(&t->inside); /* there is one window at a time */
    gauge_switch(&t->gauge, &t->work);
    if (!t->gauge.is_on)
        canvas_close_window(&t->canvas);
    if (t->panel.is_open) { /* there is no room for both */
        panel_close(&t->panel);
        layout(t);
    }
    refresh_soon(t);
}

static void open_help(struct tui *t, int number)
{
    const struct pace *pace = &t->canvas.pace;
    const char *lines[HELP_ROWS_MAX];
    struct term_size size = term_size();
    struct help_page page;
    char note[64], title[64];

    snprintf(note, sizeof note, "%s, %s",
             palette_name(t->canvas.display.palette),
             canvas_glyphs_name(&t->canvas));
    if (pace->state == PACE_ANSWERS)
        snprintf(note, sizeof note, "%s, %s, answers in %.1f ms",
                 palette_name(t->canvas.display.palette),
                 canvas_glyphs_name(&t->canvas),
                 (double)pace->rtt_min_ns * 1e-6);
    /* within a frame, with a blank on each side, above the status line */
    help_page(&page, &t->work.session->options->keys, note, number,
              size.cols - 4, size.rows - 3);
    if (number + 1 < page.page_count)
        snprintf(title, sizeof title, " keys %d/%d - any key goes on ",
                 number + 1, page.page_count);
    else
        snprintf(title, sizeof title,
                 " glim " GLIM_VERSION " - any key closes ");
    for (int i = 0; i < page.line_count; i++)
        lines[i] = page.lines[i];
    if (t->help_left > 0 || t->gauge.is_on)
        canvas_close_window(&t->canvas);
    inside_close_panel(&t->inside);
    canvas_open_window(&t->canvas, title, lines, page.line_count);
    t->help_number = number;
    t->help_left = page.page_count - number;
    t->is_settled = false;
}

static void close_help(struct tui *t)
{
    canvas_close_window(&t->canvas);
    inside_open_panel(&t->inside);
    t->help_left = 0;
    panel_draw(&t->panel);
    refresh_soon(t);
}

static void next_colors(struct tui *t)
{
    display_next_palette(&t->canvas.display);
    work_say(&t->work, "%s", palette_name(t->canvas.display.palette));
    layout(t);
}

static void next_glyphs(struct tui *t)
{
    display_next_glyphs(&t->canvas.display);
    layout(t);
    work_say(&t->work, "%s", canvas_glyphs_name(&t->canvas));
}

static void save_text(struct tui *t)
{
    struct text_style style = canvas_style(&t->canvas);

    work_save_text(&t->work, &style);
}

static void hide(struct tui *t)
{
    t->canvas.has_status_row = !t->canvas.has_status_row;
    t->gauge.is_on = false;
    layout(t);
}

static void switch_mouse(struct tui *t)
{
    t->has_mouse = !t->has_mouse;
    pilot_stop(&t->pilot);
    term_set_mouse(t->has_mouse);
    work_say(&t->work,
             t->has_mouse ? "mouse on: drag to look around" : "mouse off");
}

/* ---- input ---- */

static void suspend(struct tui *t)
{
    canvas_drain(&t->canvas, &t->input);
    term_suspend();
    layout(t);
}

static void set_live(struct tui *t, bool is_live)
{
    pilot_stop(&t->pilot);
    inside_leave(&t->inside);
    work_set_live(&t->work, is_live);
}

static void ask(struct tui *t, enum question question)
{
    t->question = question;
    t->status_ns = 0;
}

static void change_mode(struct tui *t)
{
    if (work_finish_saving(&t->work) && work_has_unsaved(&t->work))
        ask(t, QUESTION_LIVE);
    else
        set_live(t, !t->work.is_live);
}

static void quit(struct tui *t)
{
    if (!work_finish_saving(&t->work))
        return;
    if (work_has_unsaved(&t->work))
        ask(t, QUESTION_QUIT);
    else if (work_has_unsaved_edit(&t->work))
        ask(t, QUESTION_EDIT);
    else
        end(t, 0);
}

/* ---- the panel ---- */

static void open_panel(struct tui *t)
{
    if (t->pilot.cursor.has_pick)
        panel_select(&t->panel, &t->pilot.cursor.pick);
    panel_open(&t->panel);
    t->gauge.is_on = false; /* there is no room for both */
    layout(t);
}

/* What was picked while the panel is open is selected in it. */
static void follow_pick(struct tui *t)
{
    if (t->pilot.cursor.is_pick_new && t->panel.is_open) {
        panel_select(&t->panel, &t->pilot.cursor.pick);
        panel_draw(&t->panel);
    }
    t->pilot.cursor.is_pick_new = false;
}

/* The cursor on the picture has its keys first. */
static bool panel_takes(struct tui *t, int key)
{
    if (!t->panel.is_open || (t->canvas.has_cursor && !t->panel.is_typing) ||
        !panel_key(&t->panel, key))
        return false;
    if (!t->panel.is_open)
        layout(t);
    else
        panel_draw(&t->panel);
    return true;
}

static void restart(struct tui *t)
{
    if (work_finish_saving(&t->work) && work_has_unsaved(&t->work))
        ask(t, QUESTION_RESTART);
    else
        work_restart(&t->work);
}

static void act(struct tui *t, enum action action)
{
    if (action == ACTION_DRAWING && t->gauge.is_on)
        switch_gauge(t);
    if (inside_act(&t->inside, action) || pilot_act(&t->pilot, action))
        return;
    switch (action) {
    case ACTION_MODE: change_mode(t); break;
    case ACTION_START: work_start_or_halt(&t->work); break;
    case ACTION_STEP: work_step(&t->work); break;
    case ACTION_RESTART: restart(t); break;
    case ACTION_SAVE: work_save_picture(&t->work, "png"); break;
    case ACTION_SAVE_TEXT: save_text(t); break;
    case ACTION_SAVE_LINEAR: work_save_picture(&t->work, "hdr"); break;
    case ACTION_SAVE_VIEW: work_save_view(&t->work); break;
    case ACTION_METER: switch_gauge(t); break;
    case ACTION_HIDE: hide(t); break;
    case ACTION_RELOAD: work_reload(&t->work); break;
    case ACTION_BACKEND: work_switch_backend(&t->work); break;
    case ACTION_COLORS: next_colors(t); break;
    case ACTION_GLYPHS: next_glyphs(t); break;
    case ACTION_MOUSE: switch_mouse(t); break;
    case ACTION_REDRAW: layout(t); break;
    case ACTION_PANEL: open_panel(t); break;
    case ACTION_HELP: open_help(t, 0); break;
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

    ask(t, QUESTION_NONE);
    if (question == QUESTION_EDIT && (key == 's' || key == 'S')) {
        if (work_save_edit(&t->work))
            quit(t);
    } else if (question != QUESTION_EDIT && (key == 'p' || key == 'P')) {
        work_save_picture(&t->work, "png");
    } else if (key == 'y' || key == 'Y') {
        if (question == QUESTION_LIVE)
            set_live(t, true);
        else if (question == QUESTION_RESTART)
            work_restart(&t->work);
        else
            end(t, 0);
    }
}

static void take_key(struct tui *t, int key)
{
    enum action action = keys_action(&t->work.session->options->keys, key);
    bool is_urgent = action == ACTION_INTERRUPT || action == ACTION_ABORT ||
                     action == ACTION_SUSPEND || action == ACTION_REDRAW;

    if (t->work.message.is_error) {
        t->work.message = (struct message){0};
        t->status_ns = 0;
    }
    if (is_urgent)
        act(t, action);
    else if (t->question != QUESTION_NONE)
        answer_question(t, key);
    else if (t->help_left > 1 && action != ACTION_CANCEL)
        open_help(t, t->help_number + 1);
    else if (t->help_left > 0)
        close_help(t);
    else if (t->canvas.is_too_small && action != ACTION_QUIT)
        return;
    else if (!panel_takes(t, key))
        act(t, action);
    follow_pick(t);
}

static void take_mouse(struct tui *t, const struct event *event)
{
    if (panel_mouse(&t->panel, event))
        panel_draw(&t->panel);
    else
        pilot_mouse(&t->pilot, event);
    follow_pick(t);
}

static void take_event(struct tui *t, const struct event *event)
{
    enum palette palette = t->canvas.display.palette;

    if (event->kind == EVENT_KEY) {
        take_key(t, event->key);
    } else if (event->kind == EVENT_MOUSE) {
        if (t->has_mouse && t->help_left == 0 && !t->canvas.is_too_small)
            take_mouse(t, event);
    } else {
        if (canvas_answer(&t->canvas, event))
            layout(t);
        if (t->canvas.display.palette != palette)
            refresh_soon(t);
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
    const struct film *film = film_of(t);
    const struct backend *backend = render_backend(t->work.session->render);
    struct keys_name load = work_key(&t->work, ACTION_RELOAD);
    char hint[48];
    struct status status = {
        .is_live = t->work.is_live,
        .is_orbiting = t->pilot.steer.is_orbiting,
        .is_halted = t->work.is_halted,
        .is_started = t->work.is_started,
        .load_key = t->work.has_changed_files ? load.text : NULL,
        .progress = &t->work.progress,
        .device = backend->device,
        .thread_count = backend->thread_count,
        .width_px = film->width,
        .height_px = film->height,
        .colors = palette_name(t->canvas.display.palette),
        .hint = hint,
    };

    snprintf(hint, sizeof hint, "%s help  %s quit",
             work_key(&t->work, ACTION_HELP).text,
             work_key(&t->work, ACTION_QUIT).text);
    status_format(text, term_size().cols, &status);
}

static void update_status(struct tui *t, uint64_t now_ns)
{
    static const char *const questions[] = {
        [QUESTION_QUIT] =
            "The render is not saved. Quit? y: yes, p: save it, other: no",
        [QUESTION_EDIT] = "Changes of materials or light are not saved. Quit? "
                          "y: yes, s: save, other: no",
        [QUESTION_LIVE] =
            "The render is not saved. Leave it? y: yes, p: save it, other: no",
        [QUESTION_RESTART] = "The render is not saved. Start anew? y: yes, p: "
                             "save it, other: no",
    };
    char text[STATUS_BYTES];

    if (t->question != QUESTION_NONE) {
        status_message(text, term_size().cols, questions[t->question]);
    } else if (now_ns < t->work.message.until_ns) {
        status_message(text, term_size().cols, t->work.message.text);
    } else if (t->canvas.has_status_row && t->inside.show.legend[0] != '\0') {
        status_message(text, term_size().cols, t->inside.show.legend);
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

    if (t->work.progress.spp_done > 0)
        interval_ns =
            t->work.progress.render_ns > OLD_NS ? FRAME_OLD_NS : FRAME_YOUNG_NS;
    /* large windows must not take the time away from the render */
    return interval_ns > 2 * took_ns ? interval_ns : 2 * took_ns;
}

static int frame_step(const struct tui *t)
{
    if (t->work.progress.state != RENDER_RUNNING)
        return 0;
    if (pace_is_slow(&t->canvas.pace))
        return STEP_SLOW;
    return t->work.progress.render_ns > SETTLING_NS ? STEP : 0;
}

static void show_messages(struct tui *t, uint64_t now_ns)
{
    if (t->work.message.until_ns != 0 && now_ns >= t->work.message.until_ns) {
        t->work.message.until_ns = 0;
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
    struct render *render = t->work.session->render;
    bool is_running = t->work.progress.state == RENDER_RUNNING;
    bool shows = !work_awaits_picture(&t->work) && !t->is_settled &&
                 now_ns >= t->frame_ns;
    enum canvas_result result;

    show_messages(t, now_ns);
    if (shows_gauge(t) && now_ns >= gauge_next_ns(&t->gauge, &t->work))
        gauge_draw(&t->gauge, &t->work, c, now_ns);
    if ((!shows && !c->must_update) || !pace_may_send(&c->pace))
        return;
    result =
        canvas_draw(c, shows ? render_film(render) : NULL, render_draft(render),
                    show_develop(&t->inside.show), frame_step(t));
    if (t->inside.show.has_news)
        t->status_ns = 0;
    t->inside.show.has_news = false;
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
    uint64_t wake = earlier(pilot_next_ns(&t->pilot),
                            earlier(input_deadline_ns(t),
                                    pace_deadline_ns(&t->canvas.pace)));

    wake = earlier(wake, t->work.files_ns);
    if (work_awaits_picture(&t->work)) {
        /* looked for often at first, seldom while a tree is built */
        uint64_t waited_ns = now_ns - t->work.restarted_ns;
        uint64_t pause_ns = waited_ns / 8;

        pause_ns = pause_ns < MS_NS / 2 ? MS_NS / 2 : pause_ns;
        wake = earlier(wake, now_ns + earlier(pause_ns, 20 * MS_NS));
    } else if (t->work.must_restart) {
        wake = now_ns;
    } else if (!t->is_settled && pace_may_send(&t->canvas.pace)) {
        wake = earlier(wake, t->frame_ns);
    }
    if (t->work.progress.state == RENDER_RUNNING || t->status_ns == 0)
        wake = earlier(wake, t->status_ns);
    if (shows_gauge(t))
        wake = earlier(wake, gauge_next_ns(&t->gauge, &t->work));
    if (t->work.message.until_ns != 0)
        wake = earlier(wake, t->work.message.until_ns);
    return wake;
}

static void empty_events(int fd)
{
    uint64_t count;

    if (read(fd, &count, sizeof count) < 0) {
        /* nothing there */
    }
}

static void take_reload(struct tui *t)
{
    if (!work_end_reload(&t->work))
        return;
    pilot_renew(&t->pilot);
    inside_renew(&t->inside);
    panel_renew(&t->panel);
    panel_draw(&t->panel);
}

static void take_events(struct tui *t, struct pollfd fds[FDS])
{
    uint64_t now_ns;

    if (fds[1].revents)
        take_signals(t);
    if (fds[0].revents && !t->is_ending)
        take_input(t);
    if (fds[2].revents) {
        empty_events(fds[2].fd); /* work_look() sees what it says */
    }
    if (fds[3].revents)
        work_finish_saving(&t->work);
    if (fds[4].revents)
        work_end_device(&t->work);
    if (fds[5].revents)
        work_look_at_files(&t->work);
    if (fds[6].revents)
        take_reload(t);
    now_ns = clock_ns();
    if (now_ns >= input_deadline_ns(t))
        take_byte_events(t, true);
    pace_tick(&t->canvas.pace, now_ns);
}

static void wait_for_events(struct tui *t)
{
    const struct cl_start *start = t->work.session->machines.start;
    struct pollfd fds[FDS] = {
        {.fd = STDIN_FILENO, .events = POLLIN},
        {.fd = term_signal_fd(), .events = POLLIN},
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

/* A restart changes the picture, but the status line only in its time: while
 * the camera moves there are 60 a second. */
static void look_at_work(struct tui *t)
{
    const struct film *film = film_of(t);
    uint64_t before_ns = t->work.restarted_ns;

    work_look(&t->work);
    if (film->width != t->width_px || film->height != t->height_px)
        layout(t);
    if (t->work.restarted_ns != before_ns) {
        t->is_settled = false;
        t->frame_ns = 0;
    }
    if (t->work.has_changed)
        refresh_soon(t);
    t->work.has_changed = false;
}

static void loop(struct tui *t)
{
    while (!t->is_ending) {
        uint64_t now_ns = clock_ns();

        pilot_step(&t->pilot, now_ns);
        inside_step(&t->inside);
        look_at_work(t);
        draw(t, now_ns);
        if (!t->is_ending)
            wait_for_events(t);
    }
}

static bool open_screen(struct tui *t, struct error *err)
{
    if (!term_open(err))
        return false;
    canvas_init(&t->canvas, t->work.session->options);
    inside_init(&t->inside, &t->work, &t->canvas, &t->pilot.cursor);
    layout(t);
    return true;
}

/* A line that is lost is nobody's wish: the picture is kept, whatever it is.
 * SIGTERM is an orderly end, as q is, but cannot ask: what q would ask about is
 * kept. Ctrl-C and Ctrl-\ are typed, and mean it. */
static void keep_picture(struct tui *t)
{
    if (t->status == 128 + SIGHUP ||
        (t->status == 128 + SIGTERM && work_has_unsaved(&t->work)))
        work_keep(&t->work);
}

static void close_screen(struct tui *t)
{
    if (t->status == 128 + SIGHUP || t->status == 128 + SIGTERM)
        term_ignore_ends(); /* shells send SIGHUP again */
    if (!t->is_gone)
        canvas_drain(&t->canvas, &t->input);
    /* else it might put our signals back when they are no longer ours */
    machines_abandon_device(&t->work.session->machines);
    term_close(t->is_gone);
    canvas_free(&t->canvas);
    gauge_free(&t->gauge);
    render_halt(t->work.session->render);
    work_finish_saving(&t->work);
    keep_picture(t);
    for (int i = 0; i < t->work.result_count && !t->is_gone; i++)
        printf("%s\n", t->work.results[i]);
    fflush(stdout);
}

/* The render starts first, so that it works while the terminal is opened. */
bool tui_run(struct session *s, int *status, struct error *err)
{
    const char *stats_path = s->options->stats_path;
    struct tui t = {.has_mouse = true};
    struct fit fit = canvas_expect(s->options, s->crop.width, s->crop.height);
    bool ok;

    set_draft(s, &fit);
    if (stats_path && !stats_check(stats_path, err))
        return false;
    if (!work_init(&t.work, s, err))
        return false;
    pilot_init(&t.pilot, &t.work, &t.canvas);
    panel_init(&t.panel, &t.work, &t.canvas);
    ok = open_screen(&t, err);
    if (ok) {
        if (s->notice[0] != '\0')
            work_say_long(&t.work, "%s", s->notice);
        s->notice[0] = '\0';
        /* not before: it puts back the signals that it has found */
        if (s->options->backend != BACKEND_CPU)
            work_begin_device(&t.work);
        loop(&t);
        close_screen(&t);
        *status = t.status;
        session_look(s);
        ok = !stats_path || stats_write(s, stats_path, err);
    }
    inside_free(&t.inside);
    panel_free(&t.panel);
    pilot_free(&t.pilot);
    work_free(&t.work);
    return ok;
}
