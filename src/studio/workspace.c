// SPDX-License-Identifier: MIT
#include "studio/workspace.h"

#include <stdio.h>
#include <time.h>

#include "base/clock.h"
#include "base/version.h"
#include "studio/help.h"
#include "studio/panel_draw.h"
#include "studio/status_line.h"

#define MS_NS UINT64_C(1000000)
#define S_NS  UINT64_C(1000000000)

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

/* A terminal that has not answered by then has no pixels. */
#define LACK_NS S_NS

/* While nothing but samples come, frames have a twelfth of a core: the rest is
 * the render's. */
#define FRAME_SHARE 12

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t later(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static const struct film *film_of(const struct workspace *st)
{
    return render_film(st->work->session->render);
}

void workspace_refresh(struct workspace *st)
{
    st->is_settled = false;
    st->frame_ns = 0;
    st->status_ns = 0;
    st->gauge.due_ns = 0;
}

/* From the next restart on: a cell shows two pixels, one above the other. */
static void set_draft(struct session *s, const struct fit *fit)
{
    s->draft_width = fit->cols;
    s->draft_height = 2 * fit->rows;
}

void workspace_expect(struct session *s)
{
    struct fit fit =
        screen_expect(&s->options->display, s->crop.width, s->crop.height);

    set_draft(s, &fit);
}

void workspace_layout(struct workspace *st)
{
    const struct film *film = film_of(st);
    struct error err;

    st->help_left = 0;
    st->width_px = film->width;
    st->height_px = film->height;
    workspace_refresh(st);
    st->canvas.has_panel = st->panel.is_open;
    if (!screen_layout(&st->canvas, film->width, film->height, &err)) {
        st->canvas.is_too_small = true; /* nothing can be drawn */
        render_control_say_error(st->work, err.text);
    }
    panel_draw(&st->panel);
    /* until then the old draft is resampled */
    set_draft(st->work->session, &st->canvas.fit);
    inspector_open_panel(&st->inside); /* it went with the layout */
}

void workspace_init(struct workspace *st, struct render_control *work,
                    struct camera_control *pilot)
{
    *st = (struct workspace){.work = work, .pilot = pilot};
    editor_panel_init(&st->panel, work, &st->canvas);
}

void workspace_open(struct workspace *st)
{
    screen_init(&st->canvas, &st->work->session->options->display);
    inspector_init(&st->inside, st->work, &st->canvas, &st->pilot->cursor);
    st->lack_ns = clock_ns() + LACK_NS;
    workspace_layout(st);
}

void workspace_renew(struct workspace *st, const struct selection_names *names)
{
    inspector_renew(&st->inside);
    editor_panel_renew(&st->panel, names);
    panel_draw(&st->panel);
}

void workspace_ask(struct workspace *st, const char *prompt)
{
    st->prompt = prompt;
    st->status_ns = 0;
}

/* ---- windows ---- */

static bool shows_gauge(const struct workspace *st)
{
    return st->gauge.is_on && st->help_left == 0 && !st->canvas.is_too_small;
}

static void switch_gauge(struct workspace *st)
{
    inspector_stop_drawing(&st->inside); /* there is one window at a time */
    progress_panel_switch(&st->gauge, st->work);
    if (!st->gauge.is_on)
        screen_close_window(&st->canvas);
    if (st->panel.is_open) { /* there is no room for both */
        editor_panel_close(&st->panel);
        workspace_layout(st);
    }
    workspace_refresh(st);
}

static void open_help(struct workspace *st, int number)
{
    const struct frame_pacing *pace = &st->canvas.pace;
    const char *lines[HELP_ROWS_MAX];
    struct tty_size size = term_size();
    struct help_page page;
    char note[64], title[64];

    snprintf(note, sizeof note, "%s, %s",
             palette_name(st->canvas.display.palette),
             screen_glyphs_name(&st->canvas));
    if (pace->state == FRAME_PACING_ANSWERS)
        snprintf(note, sizeof note, "%s, %s, %.3g ms away",
                 palette_name(st->canvas.display.palette),
                 screen_glyphs_name(&st->canvas),
                 (double)pace->rtt_min_ns * 1e-6);
    /* within a frame, with a blank on each side, above the status line */
    help_page(&page, &st->work->session->options->keys, st->panel.is_open, note,
              number, size.cols - 4, size.rows - 3);
    if (number + 1 < page.page_count)
        snprintf(title, sizeof title, " keys %d/%d - any key goes on ",
                 number + 1, page.page_count);
    else
        snprintf(title, sizeof title,
                 " glim " GLIM_VERSION " - any key closes ");
    for (int i = 0; i < page.line_count; i++)
        lines[i] = page.lines[i];
    if (st->help_left > 0 || st->gauge.is_on)
        screen_close_window(&st->canvas);
    inspector_close_panel(&st->inside);
    screen_open_window(&st->canvas, title, lines, page.line_count);
    st->help_number = number;
    st->help_left = page.page_count - number;
    st->is_settled = false;
}

static void close_help(struct workspace *st)
{
    screen_close_window(&st->canvas);
    inspector_open_panel(&st->inside);
    st->help_left = 0;
    panel_draw(&st->panel);
    workspace_refresh(st);
}

static void next_colors(struct workspace *st)
{
    term_caps_next_palette(&st->canvas.display);
    render_control_say(st->work, "%s",
                       palette_name(st->canvas.display.palette));
    workspace_layout(st);
}

static void next_glyphs(struct workspace *st)
{
    term_caps_next_glyphs(&st->canvas.display);
    workspace_layout(st);
    render_control_say(st->work, "%s", screen_glyphs_name(&st->canvas));
}

static void hide(struct workspace *st)
{
    st->canvas.has_status_row = !st->canvas.has_status_row;
    st->gauge.is_on = false;
    workspace_layout(st);
}

static void open_panel(struct workspace *st)
{
    if (st->pilot->cursor.has_pick)
        editor_panel_select(&st->panel, &st->pilot->cursor.pick);
    editor_panel_open(&st->panel);
    st->gauge.is_on = false; /* there is no room for both */
    workspace_layout(st);
}

bool workspace_act(struct workspace *st, enum action action)
{
    if (action == ACTION_DRAWING && st->gauge.is_on)
        switch_gauge(st);
    if (inspector_act(&st->inside, action))
        return true;
    switch (action) {
    case ACTION_METER: switch_gauge(st); break;
    case ACTION_HIDE: hide(st); break;
    case ACTION_COLORS: next_colors(st); break;
    case ACTION_GLYPHS: next_glyphs(st); break;
    case ACTION_REDRAW: workspace_layout(st); break;
    case ACTION_PANEL: open_panel(st); break;
    case ACTION_HELP: open_help(st, 0); break;
    default: return false;
    }
    return true;
}

void workspace_turn_help(struct workspace *st, bool closes)
{
    if (st->help_left > 1 && !closes)
        open_help(st, st->help_number + 1);
    else
        close_help(st);
}

/* ---- drawing ---- */

static void format_status(struct workspace *st, char text[STATUS_BYTES])
{
    const struct film *film = film_of(st);
    const struct backend *backend = render_backend(st->work->session->render);
    struct keymap_name load = render_control_key(st->work, ACTION_RELOAD);
    char hint[48];
    struct status_line status = {
        .is_live = st->work->is_live,
        .is_orbiting = st->pilot->steer.is_orbiting,
        .is_halted = st->work->is_halted,
        .is_started = st->work->is_started,
        .load_key = st->work->has_changed_files ? load.text : NULL,
        .progress = &st->work->progress,
        .device = backend->device,
        .thread_count = backend->thread_count,
        .width_px = film->width,
        .height_px = film->height,
        .colors = palette_name(st->canvas.display.palette),
        .hint = hint,
    };

    snprintf(hint, sizeof hint, "%s help  %s quit",
             render_control_key(st->work, ACTION_HELP).text,
             render_control_key(st->work, ACTION_QUIT).text);
    status_line_format(text, term_size().cols, &status);
}

static void update_status(struct workspace *st, uint64_t now_ns)
{
    char text[STATUS_BYTES];

    if (st->prompt) {
        status_line_message(text, term_size().cols, st->prompt);
    } else if (now_ns < st->work->message.until_ns) {
        status_line_message(text, term_size().cols, st->work->message.text);
    } else if (st->canvas.has_status_row && st->inside.show.legend[0] != '\0') {
        status_line_message(text, term_size().cols, st->inside.show.legend);
    } else if (st->canvas.has_status_row) {
        format_status(st, text);
    } else {
        if (st->canvas.has_status)
            st->is_settled = false; /* the picture comes back there */
        screen_status(&st->canvas, NULL);
        return;
    }
    screen_status(&st->canvas, text);
}

/* Processor time of this thread. */
static uint64_t used_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (uint64_t)t.tv_sec * S_NS + (uint64_t)t.tv_nsec;
}

/* Until the next frame after one that took so long, of which it used so much of
 * the processor. */
static uint64_t frame_interval(const struct workspace *st, uint64_t took_ns,
                               uint64_t cpu_ns)
{
    uint64_t interval_ns = FRAME_FIRST_NS;

    if (st->work->progress.spp_done > 0)
        interval_ns = st->work->progress.render_ns > OLD_NS ? FRAME_OLD_NS
                                                            : FRAME_YOUNG_NS;
    interval_ns = later(interval_ns, FRAME_SHARE * cpu_ns);
    return later(interval_ns, 2 * took_ns); /* where writing blocks */
}

static int frame_step(const struct workspace *st)
{
    if (st->work->progress.state != RENDER_RUNNING)
        return 0;
    if (frame_pacing_is_slow(&st->canvas.pace))
        return STEP_SLOW;
    return st->work->progress.render_ns > SETTLING_NS ? STEP : 0;
}

/* Says it once if the pixels that the person has asked for are not there. */
static void say_lack(struct workspace *st, uint64_t now_ns)
{
    const struct screen *c = &st->canvas;
    const char *lack = term_caps_lack(&c->display);
    bool is_known = c->has_all_answers || now_ns >= st->lack_ns;

    if (st->lack_ns == 0 || !is_known || st->work->message.until_ns != 0)
        return;
    st->lack_ns = 0;
    if (lack && c->graphics.shape.kind == PIXEL_GRAPHICS_NONE)
        render_control_say(st->work, "%s: %s", screen_glyphs_name(c), lack);
}

static void show_messages(struct workspace *st, uint64_t now_ns)
{
    say_lack(st, now_ns);
    if (st->work->message.until_ns != 0 &&
        now_ns >= st->work->message.until_ns) {
        st->work->message.until_ns = 0;
        st->status_ns = 0;
    }
    if (now_ns < st->status_ns)
        return;
    update_status(st, now_ns);
    st->status_ns = now_ns + STATUS_NS;
}

bool workspace_draw(struct workspace *st, uint64_t now_ns)
{
    struct screen *c = &st->canvas;
    struct render *render = st->work->session->render;
    bool is_running = st->work->progress.state == RENDER_RUNNING;
    bool shows = !render_control_awaits_picture(st->work) && !st->is_settled &&
                 now_ns >= st->frame_ns;
    uint64_t begin_ns = used_ns();
    enum screen_result result;

    show_messages(st, now_ns);
    if (shows_gauge(st) &&
        now_ns >= progress_panel_next_ns(&st->gauge, st->work))
        progress_panel_draw(&st->gauge, st->work, c, now_ns);
    if ((!shows && !c->must_update) || !frame_pacing_may_send(&c->pace))
        return true;
    result =
        screen_draw(c, shows ? render_film(render) : NULL, render_draft(render),
                    view_mode_develop(&st->inside.show), frame_step(st));
    if (st->inside.show.has_news)
        st->status_ns = 0;
    st->inside.show.has_news = false;
    if (shows && result != SCREEN_GONE) {
        uint64_t took_ns = clock_ns() - now_ns;

        st->is_settled = result == SCREEN_DONE && !is_running;
        st->frame_ns =
            result == SCREEN_MORE
                ? 0
                : now_ns + frame_interval(st, took_ns, used_ns() - begin_ns);
    }
    return result != SCREEN_GONE;
}

/* ---- what there is to draw ---- */

/* A restart changes the picture, but the status line only in its time: while
 * the camera moves there are 60 a second. */
void workspace_look(struct workspace *st)
{
    const struct film *film = film_of(st);
    uint64_t before_ns = st->work->restarted_ns;

    inspector_step(&st->inside);
    render_control_look(st->work);
    if (film->width != st->width_px || film->height != st->height_px)
        workspace_layout(st);
    if (st->work->restarted_ns != before_ns) {
        st->is_settled = false;
        st->frame_ns = 0;
    }
    if (st->work->has_changed)
        workspace_refresh(st);
    st->work->has_changed = false;
}

/* For the first picture after a restart: looked for often at first, seldom
 * while a tree is built. */
static uint64_t next_look_ns(const struct workspace *st, uint64_t now_ns)
{
    uint64_t waited_ns = now_ns - st->work->restarted_ns;
    uint64_t pause_ns = waited_ns / 8;

    pause_ns = pause_ns < MS_NS / 2 ? MS_NS / 2 : pause_ns;
    return now_ns + (pause_ns < 20 * MS_NS ? pause_ns : 20 * MS_NS);
}

uint64_t workspace_next_ns(const struct workspace *st, uint64_t now_ns)
{
    const struct render_control *w = st->work;
    uint64_t next = w->files_ns;

    if (render_control_awaits_picture(w))
        next = earlier(next, next_look_ns(st, now_ns));
    else if (w->must_restart)
        next = now_ns;
    else if (!st->is_settled && frame_pacing_may_send(&st->canvas.pace))
        next = earlier(next, st->frame_ns);
    if (w->progress.state == RENDER_RUNNING || st->status_ns == 0)
        next = earlier(next, st->status_ns);
    if (shows_gauge(st))
        next = earlier(next, progress_panel_next_ns(&st->gauge, w));
    if (w->message.until_ns != 0)
        next = earlier(next, w->message.until_ns);
    else if (st->lack_ns != 0)
        next = earlier(next, st->lack_ns);
    return earlier(next, frame_pacing_deadline_ns(&st->canvas.pace));
}

void workspace_free(struct workspace *st)
{
    progress_panel_free(&st->gauge);
    inspector_free(&st->inside);
    editor_panel_free(&st->panel);
    screen_free(&st->canvas);
}
