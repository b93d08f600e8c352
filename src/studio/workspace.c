// SPDX-License-Identifier: MIT
#include "studio/workspace.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"
#include "base/min_max.h"
#include "session/live_render.h"
#include "studio/error_graph.h"
#include "studio/panel_draw.h"
#include "studio/status_line.h"
#include "terminal/screen.h"

#define MS_NS UINT64_C(1000000)
#define S_NS  UINT64_C(1000000000)

/* Time between frames: during the first pass, in the first OLD_NS of a render,
 * and later, when frames differ little. */
#define FRAME_FIRST_NS (16 * MS_NS)
#define FRAME_YOUNG_NS (100 * MS_NS)
#define FRAME_OLD_NS   (250 * MS_NS)
#define OLD_NS         (10 * S_NS)

/* Cells that changed by no more than STEP of 255 are not sent from this age of
 * the render on, until its end. On a slow line STEP_SLOW applies from its
 * beginning. */
#define SETTLING_NS (2 * S_NS)
#define STEP        2
#define STEP_SLOW   8

/* Time between two updates of the status line; on a slow line the picture needs
 * the bytes. */
#define STATUS_NS      (250 * MS_NS)
#define STATUS_SLOW_NS S_NS

/* A new layout waits so long for a picture, so that text and picture appear
 * together. */
#define LAYOUT_NS (100 * MS_NS)

/* The status line says that the picture is filtered until it was not for this
 * time: the first frames after a move of the camera are not. */
#define FILTERED_NS S_NS

/* A frame that takes longer is cancelled when there is input. Frames of common
 * windows take less. */
#define PATIENCE_NS (30 * MS_NS)

/* Frames take at most 1/FRAME_SHARE of a core while only new samples arrive:
 * the rest is for the render. */
#define FRAME_SHARE 12

/* ---- the draft ---- */

/* Sets the draft's size for a picture in these cells, before tty_open(). A cell
 * of half blocks shows two pixels, one above the other. */
static void screen_draft_expect(struct session *s, const struct cells_rect *fit)
{
    s->draft_width = fit->cols;
    s->draft_height = 2 * fit->rows;
}

/* Returns true if the draft has this size. */
static bool has_size(const struct session *s, const struct film *draft,
                     int width, int height)
{
    return draft->width == int_min(width, s->engine.crop.width) &&
           draft->height == int_min(height, s->engine.crop.height);
}

/* Sets the drafts' sizes for the present layout of the screen, which the filter
 * decides when it is on. The filter needs a draft of this size at once; other
 * drafts are resampled until the next restart. */
static void screen_draft_fit(struct live_render *control,
                             const struct screen *screen)
{
    struct session *s = control->session;
    const struct film *draft = render_surfaces(s->engine.render);

    screen_draft_expect(s, &screen->fit);
    if (s->is_filtered) {
        s->draft_width = screen->moving_width;
        s->draft_height = screen->moving_height;
    }
    screen_filter_draft_size(screen->frame_width, screen->frame_height,
                             SCREEN_FILTER_PIXELS, &s->fine_width,
                             &s->fine_height);
    if (draft == NULL)
        draft = render_draft(s->engine.render);
    if (!control->is_halted && s->draft_has_surfaces && draft != NULL &&
        !screen->is_too_small &&
        !has_size(s, draft, s->draft_width, s->draft_height) &&
        !has_size(s, draft, s->fine_width, s->fine_height))
        live_render_renew_draft(control);
}

/* Renders a fine draft of a filtered picture that has only a small one. */
static void screen_draft_refine(struct live_render *control)
{
    const struct session *s = control->session;
    const struct film *draft = render_surfaces(s->engine.render);

    if (draft != NULL && s->is_filtered && !s->draft_is_fine &&
        !control->is_halted && live_render_wants_fine_draft(control) &&
        !has_size(s, draft, s->fine_width, s->fine_height))
        live_render_renew_draft(control);
}

/* ---- parts ---- */

static const struct film *film_of(const struct workspace *workspace)
{
    return render_film(workspace->control->session->engine.render);
}

void workspace_refresh(struct workspace *workspace)
{
    workspace->is_settled = false;
    workspace->frame_ns = 0;
    workspace->status_ns = 0;
    workspace->facts_ns = 0;
}

void workspace_expect(struct session *s)
{
    struct cells_rect fit =
        screen_expect(&s->options->display, s->engine.crop.width,
                      s->engine.crop.height);

    screen_draft_expect(s, &fit);
}

/* Makes the frame in the size that the screen wants; none if the window is too
 * small. */
static bool resize_frame(struct workspace *workspace, struct error *err)
{
    const struct screen *screen = &workspace->screen;

    frame_free(&workspace->frame);
    return screen->is_too_small ||
           frame_init(&workspace->frame, screen->frame_width,
                      screen->frame_height, err);
}

static const struct keymap *keys_of(const struct workspace *workspace)
{
    return &workspace->control->session->options->keys;
}

bool workspace_has_list(const struct workspace *workspace)
{
    return workspace->commands.list.is_open || workspace->scenes.list.is_open ||
           workspace->views.list.is_open;
}

/* Opens the list that a person reads, or else the inspector's table. */
static void open_window(struct workspace *workspace)
{
    if (!workspace_has_list(workspace))
        inspector_open_table(&workspace->inspector);
    else if (workspace->screen.is_too_small)
        return;
    else if (workspace->scenes.list.is_open)
        scene_list_open(&workspace->scenes, &workspace->screen);
    else if (workspace->views.list.is_open)
        view_list_open(&workspace->views, &workspace->screen);
    else
        command_list_open(&workspace->commands, keys_of(workspace),
                          &workspace->screen);
}

void workspace_layout(struct workspace *workspace)
{
    const struct film *film = film_of(workspace);
    struct error err;

    workspace->layout_ns = clock_ns();
    workspace->width_px = film->width;
    workspace->height_px = film->height;
    workspace_refresh(workspace);
    workspace->screen.has_panel = workspace->panel.is_open;
    if (!screen_layout(&workspace->screen, film->width, film->height, &err) ||
        !resize_frame(workspace, &err)) {
        workspace->screen.is_too_small = true; /* so nothing is drawn */
        live_render_say_error(workspace->control, err.text);
    }
    keys_bar_lay_out(&workspace->keys_bar, &workspace->screen);
    panel_draw(&workspace->panel);
    screen_draft_fit(workspace->control, &workspace->screen);
    open_window(workspace); /* the layout closed it */
}

void workspace_redraw(struct workspace *workspace)
{
    tty_relayout(true);
    workspace_layout(workspace);
}

void workspace_init(struct workspace *workspace, struct live_render *control,
                    struct camera_control *camera)
{
    *workspace = (struct workspace){.control = control, .camera = camera};
    editor_panel_init(&workspace->panel, control, &workspace->screen);
    comparison_init(&workspace->comparison, control);
}

void workspace_open(struct workspace *workspace)
{
    screen_init(&workspace->screen,
                &workspace->control->session->options->display);
    inspector_init(&workspace->inspector, workspace->control,
                   &workspace->screen, &workspace->camera->cursor);
    glyph_choice_init(&workspace->glyph_choice, workspace->control,
                      &workspace->screen);
    workspace_layout(workspace);
}

void workspace_renew(struct workspace *workspace,
                     const struct selection_names *names)
{
    inspector_stop_drawing(&workspace->inspector);
    editor_panel_renew(&workspace->panel, names);
    panel_draw(&workspace->panel);
}

void workspace_ask(struct workspace *workspace, const char *prompt)
{
    workspace->prompt = prompt;
    workspace->status_ns = 0;
}

/* ---- windows ---- */

/* Closes the window about the render: there is one window at a time. */
static void close_about(struct workspace *workspace)
{
    if (workspace->has_about)
        screen_close_window(&workspace->screen);
    workspace->has_about = false;
}

void workspace_switch_about(struct workspace *workspace)
{
    bool opens = !workspace->has_about;

    close_about(workspace);
    if (opens) {
        inspector_stop_drawing(&workspace->inspector);
        if (workspace->panel.is_open) { /* there is no room for both */
            editor_panel_close(&workspace->panel);
            workspace_layout(workspace);
        }
    }
    workspace->has_about = opens;
    workspace_refresh(workspace);
}

void workspace_keep_render(struct workspace *workspace)
{
    const struct frame *frame = &workspace->frame;
    struct inspector *inspector = &workspace->inspector;
    struct frame shown = {.rgb = NULL};
    struct error ignored;

    if (inspector->view_mode.kind == SHOW_LIGHT &&
        inspector->view_mode.is_filtered && frame->width > 0 &&
        frame_init(&shown, frame->width, frame->height, &ignored))
        inspector_picture(inspector, &shown);
    comparison_keep(&workspace->comparison, &shown);
    frame_free(&shown); /* if it was not taken */
}

void workspace_next_drawing(struct workspace *workspace)
{
    close_about(workspace);
    inspector_next_drawing(&workspace->inspector);
}

void workspace_next_colors(struct workspace *workspace)
{
    term_caps_next_palette(&workspace->screen.display);
    live_render_say(workspace->control, "%s",
                    palette_name(workspace->screen.display.palette));
    workspace_layout(workspace);
}

void workspace_next_theme(struct workspace *workspace)
{
    static const char *const names[] = {[THEME_DARK] = "dark",
                                        [THEME_LIGHT] = "light",
                                        [THEME_PLAIN] = "plain"};
    enum theme *theme = &workspace->screen.display.theme;

    *theme = (enum theme)((*theme + 1) % (THEME_PLAIN + 1));
    workspace->screen.display.theme_is_final = true;
    live_render_say(workspace->control, "text: %s", names[*theme]);
    workspace_layout(workspace);
}

void workspace_next_glyphs(struct workspace *workspace)
{
    glyph_choice_next(&workspace->glyph_choice);
    workspace_layout(workspace);
    glyph_choice_say(&workspace->glyph_choice);
}

bool workspace_take_back_glyphs(struct workspace *workspace)
{
    if (!glyph_choice_take_back(&workspace->glyph_choice))
        return false;
    workspace_layout(workspace);
    glyph_choice_say(&workspace->glyph_choice);
    return true;
}

void workspace_switch_status(struct workspace *workspace)
{
    workspace->screen.has_status_row = !workspace->screen.has_status_row;
    workspace->has_about = false;
    workspace_layout(workspace);
}

void workspace_open_panel(struct workspace *workspace)
{
    if (workspace->camera->cursor.has_pick)
        editor_panel_select(&workspace->panel, &workspace->camera->cursor.pick);
    editor_panel_open(&workspace->panel);
    workspace->has_about = false; /* there is no room for both */
    workspace_layout(workspace);
}

void workspace_open_light(struct workspace *workspace)
{
    editor_panel_show(&workspace->panel, PAGE_LIGHT);
    workspace_open_panel(workspace);
}

/* Closes the windows that are open, for a list. */
static void begin_list(struct workspace *workspace)
{
    inspector_close_table(&workspace->inspector);
    screen_close_window(&workspace->screen); /* about the render */
    workspace_refresh(workspace);
}

static void open_list(struct workspace *workspace, bool is_menu)
{
    char *changes = session_unsaved(workspace->control->session);

    begin_list(workspace);
    workspace->commands =
        (struct command_list){.is_menu = is_menu,
                              .in_panel = workspace->panel.is_open,
                              .has_kept = workspace->has_kept};
    if (changes != NULL)
        snprintf(workspace->commands.changes,
                 sizeof workspace->commands.changes, "save %s", changes);
    free(changes);
    command_list_open(&workspace->commands, keys_of(workspace),
                      &workspace->screen);
}

void workspace_open_commands(struct workspace *workspace)
{
    open_list(workspace, false);
}

void workspace_open_menu(struct workspace *workspace)
{
    open_list(workspace, true);
}

void workspace_keep_picture(struct workspace *workspace)
{
    struct session *session = workspace->control->session;
    struct film *film = render_film(session->engine.render);
    int longest = int_max(film->width, film->height);
    int side = int_min(longest, SCENE_PICTURE_SIDE);
    struct frame frame;
    struct error ignored;

    if (workspace->control->progress.samples == 0 ||
        !frame_init(&frame, int_max(film->width * side / longest, 1),
                    int_max(film->height * side / longest, 1), &ignored))
        return;
    film_preview(film, NULL, session_develop(session), &frame);
    scene_picture_keep(session->options->scene_path, &frame);
    frame_free(&frame);
}

void workspace_open_scenes(struct workspace *workspace)
{
    begin_list(workspace);
    workspace_keep_picture(workspace);
    scene_list_free(&workspace->scenes); /* files may have changed */
    scene_list_open(&workspace->scenes, &workspace->screen);
}

void workspace_open_views(struct workspace *workspace)
{
    view_list_free(&workspace->views);
    workspace->views.view_mode = &workspace->inspector.view_mode;
    begin_list(workspace);
    if (view_list_open(&workspace->views, &workspace->screen))
        return;
    live_render_say(workspace->control,
                    "no view has a number: %s gives this one a number",
                    live_render_key(workspace->control, ACTION_KEEP).text);
    open_window(workspace);
}

static enum action take_list(struct workspace *workspace,
                             const struct event *event)
{
    struct screen *screen = &workspace->screen;

    if (workspace->scenes.list.is_open) {
        workspace->chosen_scene =
            scene_list_take(&workspace->scenes, screen, event);
        return ACTION_NONE;
    }
    if (workspace->views.list.is_open)
        return view_list_take(&workspace->views, screen, event);
    return command_list_take(&workspace->commands, keys_of(workspace), screen,
                             event);
}

/* Shows what was there before a list. */
static void end_list(struct workspace *workspace)
{
    screen_close_window(&workspace->screen);
    open_window(workspace);
    workspace_refresh(workspace);
}

enum action workspace_take_list(struct workspace *workspace,
                                const struct event *event)
{
    enum action chosen = take_list(workspace, event);

    if (!workspace_has_list(workspace))
        end_list(workspace);
    return chosen;
}

void workspace_close_list(struct workspace *workspace)
{
    if (!workspace_has_list(workspace))
        return;
    workspace->commands.list.is_open = false;
    workspace->scenes.list.is_open = false;
    workspace->views.list.is_open = false;
    end_list(workspace);
}

/* ---- drawing ---- */

static bool says_filtered(const struct workspace *workspace, uint64_t now_ns)
{
    const struct live_render *control = workspace->control;

    return control->session->is_filtered &&
           (workspace->inspector.view_mode.is_filtered ||
            (control->is_live && control->progress.state == RENDER_RUNNING &&
             now_ns < workspace->filtered_until_ns));
}

static void update_status(struct workspace *workspace, uint64_t now_ns)
{
    const struct live_render *control = workspace->control;
    struct keymap_name load = live_render_key(control, ACTION_RELOAD);
    struct keymap_name restore = live_render_key(control, ACTION_RESTORE);
    struct keymap_name help = live_render_key(control, ACTION_HELP);
    const char *legend = workspace->comparison.legend[0] != '\0'
                             ? workspace->comparison.legend
                             : workspace->inspector.view_mode.legend;
    struct status_line status = {
        .is_live = control->is_live,
        .is_orbiting = workspace->camera->input.is_orbiting,
        .passes_walls = workspace->camera->passes_walls,
        .is_filtered = says_filtered(workspace, now_ns),
        .filtered_error = workspace->inspector.view_mode.filter.error,
        .is_halted = control->is_halted,
        .is_started = control->is_started,
        .has_device =
            render_backend(control->session->engine.render)->device != NULL,
        .load_key = control->has_changed_files ? load.text : NULL,
        .restore_key = workspace->has_kept ? restore.text : NULL,
        .help_key = help.text,
        .progress = &control->progress,
    };
    int cols = term_size().cols;
    struct status_row row;

    if (workspace->prompt) {
        status_line_message(&row, cols, &status, workspace->prompt,
                            ROLE_MESSAGE);
    } else if (now_ns < control->message.until_ns) {
        status_line_message(&row, cols, &status, control->message.text,
                            ROLE_MESSAGE);
    } else if (!workspace->screen.has_status_row) {
        if (workspace->screen.has_status)
            workspace->is_settled = false; /* the picture is drawn there */
        screen_status(&workspace->screen, NULL);
        return;
    } else if (legend[0] != '\0') {
        status_line_message(&row, cols, &status, legend, ROLE_STATUS);
    } else {
        status_line_format(&row, cols, &status);
    }
    screen_status(&workspace->screen, &row);
}

/* The status line ends with the hint of the help. */
enum action workspace_hint_at(const struct workspace *workspace, int col,
                              int row)
{
    const struct status_row *status = &workspace->screen.status;

    if (row != term_size().rows - 1)
        return keys_bar_action_at(&workspace->keys_bar, col, row);
    for (int i = 0; i < status->span_count && workspace->screen.has_status; i++)
        if (status->spans[i].role == ROLE_STATUS_KEY &&
            col >= status->spans[i].col)
            return ACTION_HELP;
    return ACTION_NONE;
}

/* Processor time of the calling thread. */
static uint64_t used_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (uint64_t)t.tv_sec * S_NS + (uint64_t)t.tv_nsec;
}

/* Time from one frame to the next. The last one took took_ns by the clock and
 * cpu_ns of processor time. */
static uint64_t frame_interval(const struct workspace *workspace,
                               uint64_t took_ns, uint64_t cpu_ns)
{
    uint64_t interval_ns = FRAME_FIRST_NS;

    if (workspace->control->progress.spp_done > 0)
        interval_ns = workspace->control->progress.render_ns > OLD_NS
                          ? FRAME_OLD_NS
                          : FRAME_YOUNG_NS;
    interval_ns = u64_max(interval_ns, FRAME_SHARE * cpu_ns);
    return u64_max(interval_ns, 2 * took_ns); /* for terminals that block */
}

static int frame_step(const struct workspace *workspace)
{
    if (workspace->control->progress.state != RENDER_RUNNING)
        return 0;
    if (frame_pacing_is_slow(&workspace->screen.pace))
        return STEP_SLOW;
    return workspace->control->progress.render_ns > SETTLING_NS ? STEP : 0;
}

static void show_messages(struct workspace *workspace, uint64_t now_ns)
{
    glyph_choice_say_lack(&workspace->glyph_choice, now_ns);
    if (workspace->control->message.until_ns != 0 &&
        now_ns >= workspace->control->message.until_ns) {
        workspace->control->message.until_ns = 0;
        workspace->status_ns = 0;
    }
    if (now_ns < workspace->status_ns)
        return;
    update_status(workspace, now_ns);
    workspace->status_ns =
        now_ns + (frame_pacing_is_slow(&workspace->screen.pace) ? STATUS_SLOW_NS
                                                                : STATUS_NS);
}

/* Time between two updates of the graph and the window about the render, long
 * enough to read the numbers; on a slow line the picture needs the bytes. */
#define FACTS_NS      (500 * MS_NS)
#define FACTS_SLOW_NS (2 * S_NS)

static void draw_facts(struct workspace *workspace, uint64_t now_ns)
{
    struct screen *screen = &workspace->screen;
    struct window_rect room;

    if (now_ns < workspace->facts_ns || screen->is_too_small)
        return;
    if (keys_bar_room(&workspace->keys_bar, &room))
        error_graph_draw(workspace->control, screen, &room);
    if (workspace->has_about && !workspace_has_list(workspace))
        about_window_draw(workspace->control, screen);
    workspace->facts_ns =
        now_ns +
        (frame_pacing_is_slow(&screen->pace) ? FACTS_SLOW_NS : FACTS_NS);
}

static void outline_selection(struct workspace *workspace)
{
    struct view_mode *view_mode = &workspace->inspector.view_mode;
    struct world w;
    struct camera camera;
    bool is_picked = workspace->camera->input.is_orbiting ||
                     clock_ns() < workspace->picked_until_ns;

    if (!(workspace->panel.is_open || is_picked) ||
        !view_mode_world(view_mode, &w))
        return;
    camera = view_mode_camera(view_mode, &w.settings.camera, &workspace->frame);
    editor_panel_outline(&workspace->panel, &camera, &workspace->frame);
}

static void dim(struct frame *frame)
{
    size_t count = 3 * (size_t)frame->width * (size_t)frame->height;

    for (size_t i = 0; i < count; i++)
        frame->rgb[i] = (uint8_t)(frame->rgb[i] * 2 / 5);
}

static void paint(struct workspace *workspace)
{
    if (workspace->comparison.mode != COMPARISON_OFF) {
        inspector_picture(&workspace->inspector, &workspace->frame);
        comparison_paint(&workspace->comparison, &workspace->frame);
    } else {
        inspector_preview(&workspace->inspector, &workspace->frame);
        outline_selection(workspace);
    }
    if (workspace_has_list(workspace))
        dim(&workspace->frame);
}

static enum pixel_graphics_pace pace_of(const struct workspace *workspace)
{
    const struct live_render *control = workspace->control;

    if (!control->is_live || control->progress.state != RENDER_RUNNING)
        return PIXEL_GRAPHICS_RESTS;
    if (!live_render_rests(control))
        return PIXEL_GRAPHICS_MOVES;
    return control->progress.spp_done == 0 ? PIXEL_GRAPHICS_BEGINS
                                           : PIXEL_GRAPHICS_RESTS;
}

/* Returns true if frames may have the pixels of a picture that rests. A
 * filtered one has them from its fine draft on. */
static bool is_fine(const struct workspace *workspace,
                    enum pixel_graphics_pace pace)
{
    const struct session *s = workspace->control->session;
    const struct film *draft = render_surfaces(s->engine.render);

    return draft != NULL && s->is_filtered
               ? has_size(s, draft, s->fine_width, s->fine_height)
               : pace == PIXEL_GRAPHICS_RESTS;
}

/* Paints a frame again if the fine draft, which does not fit small frames, has
 * become whole meanwhile. */
static void make_frame(struct workspace *workspace,
                       enum pixel_graphics_pace pace)
{
    const struct screen *screen = &workspace->screen;
    struct frame *frame = &workspace->frame;
    bool was_fine;

    do {
        was_fine = is_fine(workspace, pace);
        frame->width = was_fine ? screen->frame_width : screen->moving_width;
        frame->height = was_fine ? screen->frame_height : screen->moving_height;
        paint(workspace);
    } while (is_fine(workspace, pace) != was_fine);
    workspace->has_frame = !frame_is_cancelled(frame);
}

/* Lets input cancel the frame, unless it has cancelled the one before: pictures
 * are shown while a key is held. */
static void limit_frame(struct workspace *workspace, uint64_t now_ns)
{
    workspace->cancel.is_due = tty_has_input;
    workspace->cancel.deadline_ns = now_ns + PATIENCE_NS;
    workspace->frame.cancel =
        workspace->is_cancelled ? NULL : &workspace->cancel;
}

/* Writes text that has changed, then a frame if `has_frame`, which is a new one
 * if `is_new`. The text of a new layout waits for the frame. */
static enum screen_result send(struct workspace *workspace, bool has_frame,
                               bool is_new)
{
    struct screen *screen = &workspace->screen;
    struct view_mode *view_mode = &workspace->inspector.view_mode;
    uint64_t now_ns = clock_ns();
    bool said_filtered = says_filtered(workspace, now_ns);
    struct screen_frame frame = {.pixels = &workspace->frame};
    enum screen_result result;

    if (workspace->layout_ns == 0 || !has_frame || screen->is_too_small)
        screen_draw_text(screen);
    if (!has_frame || screen->is_too_small)
        return screen_draw(screen, &(struct screen_frame){.pixels = NULL});
    frame.pace = pace_of(workspace);
    frame.step = frame_step(workspace);
    limit_frame(workspace, now_ns);
    if (is_new)
        make_frame(workspace, frame.pace);
    if (workspace->has_frame)
        screen_draw_text(screen);
    else
        frame.pixels = NULL;
    result = screen_draw(screen, &frame);
    workspace->is_cancelled = frame_is_cancelled(&workspace->frame);
    if (!workspace->has_frame)
        return result;
    workspace->layout_ns = 0;
    if (view_mode->is_filtered)
        workspace->filtered_until_ns = now_ns + FILTERED_NS;
    if (view_mode->legend_is_new ||
        says_filtered(workspace, now_ns) != said_filtered)
        workspace->status_ns = 0; /* it was written before the frame */
    view_mode->legend_is_new = false;
    return result;
}

/* When a new frame or the rest of this one is due. */
static uint64_t frame_due_ns(const struct workspace *workspace)
{
    return workspace->has_more ? 0 : workspace->frame_ns;
}

/* Plans the next frame, after cpu_ns of processor time for this one or a rest
 * of it. */
static void plan_frame(struct workspace *workspace, bool was_new,
                       uint64_t now_ns, uint64_t cpu_ns)
{
    uint64_t took_ns = clock_ns() - now_ns;

    if (!workspace->has_frame)
        workspace->frame_ns = 0;
    else if (was_new)
        workspace->frame_ns =
            now_ns + frame_interval(workspace, took_ns, cpu_ns);
    else
        workspace->frame_ns += FRAME_SHARE * cpu_ns;
}

bool workspace_draw(struct workspace *workspace, enum keys_state keys,
                    uint64_t now_ns)
{
    struct screen *screen = &workspace->screen;
    bool is_running = workspace->control->progress.state == RENDER_RUNNING;
    bool is_new = workspace->frame_ns <= now_ns;
    bool shows = !live_render_awaits_picture(workspace->control) &&
                 !workspace->is_settled && frame_due_ns(workspace) <= now_ns;
    uint64_t begin_ns = used_ns();
    enum screen_result result;

    show_messages(workspace, now_ns);
    keys_bar_draw(&workspace->keys_bar, workspace->control, screen, keys);
    draw_facts(workspace, now_ns);
    if ((!shows && !screen->must_update) ||
        !frame_pacing_may_send(&screen->pace))
        return true;
    if (!shows && now_ns < workspace->layout_ns + LAYOUT_NS &&
        live_render_awaits_picture(workspace->control))
        return true;
    if (shows && is_new) {
        workspace->has_frame = true;
        workspace->is_final = !is_running;
    }
    result = send(workspace, shows, is_new);
    if (shows && result != SCREEN_GONE) {
        workspace->has_more = result == SCREEN_MORE;
        workspace->is_settled = result == SCREEN_DONE && workspace->has_frame &&
                                workspace->is_final && !is_running;
        plan_frame(workspace, is_new, now_ns, used_ns() - begin_ns);
    }
    return result != SCREEN_GONE;
}

/* ---- what has to be drawn ---- */

/* A restart draws the picture at once, but not the status line: a moving camera
 * restarts the render 60 times a second. */
void workspace_look(struct workspace *workspace)
{
    const struct film *film = film_of(workspace);
    uint64_t before_ns = workspace->control->restarted_ns;

    inspector_step(&workspace->inspector);
    live_render_update(workspace->control);
    screen_draft_refine(workspace->control);
    if (film->width != workspace->width_px ||
        film->height != workspace->height_px)
        workspace_layout(workspace);
    if (workspace->control->restarted_ns != before_ns) {
        workspace->is_settled = false;
        workspace->frame_ns = 0;
    }
    if (workspace->control->has_changed)
        workspace_refresh(workspace);
    workspace->control->has_changed = false;
    if (editor_panel_step(&workspace->panel))
        panel_draw(&workspace->panel);
}

/* When to look for the first picture after a restart: often at first, seldom
 * while a tree is built. */
static uint64_t next_look_ns(const struct workspace *workspace, uint64_t now_ns)
{
    uint64_t waited_ns = now_ns - workspace->control->restarted_ns;
    uint64_t pause_ns = waited_ns / 8;

    pause_ns = pause_ns < MS_NS / 2 ? MS_NS / 2 : pause_ns;
    return now_ns + (pause_ns < 20 * MS_NS ? pause_ns : 20 * MS_NS);
}

uint64_t workspace_next_ns(const struct workspace *workspace, uint64_t now_ns)
{
    const struct live_render *control = workspace->control;
    uint64_t next = control->files_ns;

    if (live_render_awaits_picture(control))
        next = u64_min(next, next_look_ns(workspace, now_ns));
    else if (live_render_is_outdated(control))
        next = now_ns;
    else if (!workspace->is_settled &&
             frame_pacing_may_send(&workspace->screen.pace))
        next = u64_min(next, frame_due_ns(workspace));
    if (control->progress.state == RENDER_RUNNING || workspace->status_ns == 0)
        next = u64_min(next, workspace->status_ns);
    if (control->progress.state == RENDER_RUNNING || workspace->facts_ns == 0)
        next = u64_min(next, workspace->facts_ns);
    if (editor_panel_is_busy(&workspace->panel))
        next = u64_min(next, now_ns + FRAME_FIRST_NS);
    if (control->message.until_ns != 0)
        next = u64_min(next, control->message.until_ns);
    else if (workspace->glyph_choice.lack_ns != 0)
        next = u64_min(next, workspace->glyph_choice.lack_ns);
    return u64_min(next, frame_pacing_deadline_ns(&workspace->screen.pace));
}

void workspace_free(struct workspace *workspace)
{
    scene_list_free(&workspace->scenes);
    view_list_free(&workspace->views);
    free(workspace->chosen_scene);
    inspector_free(&workspace->inspector);
    editor_panel_free(&workspace->panel);
    comparison_free(&workspace->comparison);
    screen_free(&workspace->screen);
    frame_free(&workspace->frame);
}
