// SPDX-License-Identifier: MIT
#include "studio/start_screen.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/print.h"
#include "glim/version.h"
#include "studio/scene_list.h"
#include "terminal/tty_events.h"

/* Shape of the empty picture behind the list. */
#define WIDTH  1024
#define HEIGHT 576

struct start {
    const struct keymap *keys;
    struct screen screen;
    struct tty_events events;
    struct scene_list scenes;
    const char *message;
    char *path; /* that was chosen */
    bool is_ending;
    bool is_gone; /* the terminal has gone */
    int status;
};

static void draw_status(struct start *s)
{
    struct status_row row = {.role = s->message ? ROLE_MESSAGE : ROLE_STATUS};
    int cols = term_size().cols;
    const char *text = s->message ? s->message
                                  : "glim " GLIM_VERSION
                                    ": a path tracer in the terminal";

    memset(row.text, ' ', sizeof row.text - 1);
    if (cols > 2 && cols < STATUS_BYTES)
        text_width_cut(row.text + 1, sizeof row.text - 1, text, cols - 2);
    screen_status(&s->screen, &row);
}

static void lay_out(struct start *s)
{
    struct error err;

    if (!screen_layout(&s->screen, WIDTH, HEIGHT, &err)) {
        s->is_ending = true;
        return;
    }
    if (s->screen.is_too_small)
        return;
    draw_status(s);
    scene_list_open(&s->scenes, &s->screen);
}

static void end(struct start *s, int status)
{
    s->is_ending = true;
    s->status = status;
}

static bool take_event(void *context, const struct event *event)
{
    struct start *s = context;
    bool is_list = !s->screen.is_too_small;
    bool is_control = event->kind == EVENT_KEY && event->key < ' ';
    enum action action =
        is_control ? keymap_action(s->keys, event->key) : ACTION_NONE;

    if (action == ACTION_QUIT)
        end(s, 0);
    else if (action == ACTION_ABORT)
        end(s, 128 + SIGQUIT);
    else if (is_list &&
             (event->kind == EVENT_KEY || event->kind == EVENT_MOUSE))
        s->path = scene_list_take(&s->scenes, &s->screen, event);
    else if (screen_answer(&s->screen, event))
        lay_out(s);
    if (s->path != NULL || (is_list && !s->scenes.list.is_open))
        s->is_ending = true;
    return !s->is_ending;
}

static void take_signals(struct start *s)
{
    int number;

    while ((number = tty_signal()) != 0) {
        if (number == SIGWINCH) {
            tty_relayout(true);
            lay_out(s);
        } else if (number == SIGTSTP) {
            tty_suspend();
            lay_out(s);
        } else if (number == SIGCONT) {
            tty_resume();
            lay_out(s);
        } else {
            end(s, 128 + number);
        }
    }
}

static void wait_for_events(struct start *s)
{
    struct pollfd fds[] = {{.fd = STDIN_FILENO, .events = POLLIN},
                           {.fd = tty_signal_fd(), .events = POLLIN}};
    uint64_t until_ns = tty_events_deadline_ns(&s->events);
    uint64_t now_ns = clock_ns();
    int pause_ms = until_ns == UINT64_MAX ? -1
                   : until_ns <= now_ns
                       ? 0
                       : (int)((until_ns - now_ns) / 1000000) + 1;

    if (!frame_pacing_may_send(&s->screen.pace))
        pause_ms = 10;
    poll(fds, 2, pause_ms);
    take_signals(s);
    if (!s->is_ending && !tty_events_read(&s->events, take_event, s)) {
        s->is_gone = true;
        end(s, 128 + SIGHUP);
    }
    if (!s->is_ending)
        tty_events_expire(&s->events, take_event, s);
    frame_pacing_tick(&s->screen.pace, clock_ns());
}

static void loop(struct start *s)
{
    while (!s->is_ending) {
        if (s->screen.must_update && frame_pacing_may_send(&s->screen.pace)) {
            screen_draw_text(&s->screen);
            screen_draw(&s->screen, &(struct screen_frame){.pixels = NULL});
        }
        wait_for_events(s);
    }
}

bool start_screen_run(const struct options *o, const char *message, char **path,
                      int *status, struct error *err)
{
    struct start s = {.keys = &o->keys, .message = message};

    if (!tty_open(err))
        return false;
    screen_init(&s.screen, &o->display);
    lay_out(&s);
    loop(&s);
    if (!s.is_gone)
        screen_drain(&s.screen, &s.events.input);
    tty_close(s.is_gone);
    screen_free(&s.screen);
    scene_list_free(&s.scenes);
    *path = s.path;
    *status = s.status;
    return true;
}
