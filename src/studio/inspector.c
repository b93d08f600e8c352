// SPDX-License-Identifier: MIT
#include "studio/inspector.h"

#include <stdio.h>
#include <string.h>

#include "render/projection.h"
#include "inspect/overlay.h"
#include "inspect/overlay_text.h"
#include "studio/save_commands.h"
#include "kernels/vec.h"

#define TEXT_BYTES 256

static struct session *session_of(const struct inspector *in)
{
    return in->work->session;
}

/* ---- drawings ---- */

static void paint_drawing(struct inspector *in, struct frame *frame)
{
    struct world w;
    struct camera camera;

    if (in->drawing == INSPECTOR_NOTHING || !view_mode_world(&in->show, &w))
        return;
    camera = view_mode_camera(&in->show, &w.settings.camera, frame);
    if (in->drawing == INSPECTOR_BOXES)
        overlay_boxes(frame, &camera, &in->show.bvh, in->level);
    else if (in->drawing == INSPECTOR_LOBES && in->is_surface)
        overlay_lobes(frame, &camera, &in->lobes);
    else if (in->drawing == INSPECTOR_PATH)
        overlay_trail(frame, &camera, &in->trail, in->step);
}

static void paint(void *context, struct film *film, struct film *draft,
                  struct frame *frame)
{
    struct inspector *in = context;

    view_mode_paint(&in->show, film, draft, frame);
    paint_drawing(in, frame);
}

void inspector_close_panel(struct inspector *in)
{
    if (in->has_panel)
        screen_close_window(in->canvas);
    in->has_panel = false;
    in->work->has_changed = true;
}

void inspector_open_panel(struct inspector *in)
{
    const struct scene *scene = &session_of(in)->scene;
    const char *lines[OVERLAY_TEXT_LINES];
    struct overlay_text legend;
    char title[TEXT_BYTES];

    inspector_close_panel(in);
    if (in->canvas->is_too_small)
        return;
    if (in->drawing == INSPECTOR_LOBES && in->is_surface) {
        overlay_text_lobes(&legend, scene, &in->lobes);
        snprintf(title, sizeof title, " directions from pixel %u %u ", in->x,
                 in->y);
    } else if (in->drawing == INSPECTOR_PATH) {
        overlay_text_trail(&legend, scene, &in->trail, in->step);
        snprintf(title, sizeof title, " sample %llu of pixel %u %u - %s %s ",
                 (unsigned long long)in->sample, in->x, in->y,
                 render_control_key(in->work, ACTION_LESS).text,
                 render_control_key(in->work, ACTION_MORE).text);
    } else {
        return;
    }
    for (int i = 0; i < legend.count; i++)
        lines[i] = legend.lines[i];
    screen_open_panel(in->canvas, title, lines, legend.count);
    in->has_panel = true;
}

static void say_boxes(struct inspector *in)
{
    struct frame nothing = {0};
    struct camera any = {0};

    render_control_say_long(
        in->work, "boxes of level %u of %u: %u nodes; %s %s go up and down",
        in->level, in->show.bvh.depth,
        overlay_boxes(&nothing, &any, &in->show.bvh, in->level),
        render_control_key(in->work, ACTION_LESS).text,
        render_control_key(in->work, ACTION_MORE).text);
}

static bool is_new_pick(const struct inspector *in)
{
    const struct pick_cursor *c = in->cursor;

    return c->has_pick && (!in->is_picked || memcmp(in->place, c->pick.position,
                                                    sizeof in->place) != 0);
}

/* Where the pick is in the picture now, or its middle. */
static void find_pixel(struct inspector *in)
{
    const struct scene *scene = &session_of(in)->scene;
    struct rect r = session_of(in)->crop;
    struct projected at;

    in->x = (uint32_t)(r.x + r.width / 2);
    in->y = (uint32_t)(r.y + r.height / 2);
    in->is_picked = in->cursor->has_pick;
    if (!in->is_picked)
        return;
    memcpy(in->place, in->cursor->pick.position, sizeof in->place);
    if (projection_point(
            &in->camera,
            v3((float)((in->place[0] - scene->center[0]) * scene->scale),
               (float)((in->place[1] - scene->center[1]) * scene->scale),
               (float)((in->place[2] - scene->center[2]) * scene->scale)),
            &at) &&
        at.x >= r.x && at.x < r.x + r.width && at.y >= r.y &&
        at.y < r.y + r.height) {
        in->x = (uint32_t)at.x;
        in->y = (uint32_t)at.y;
    }
}

static void follow(struct inspector *in)
{
    struct world w;

    if (!view_mode_world(&in->show, &w))
        return;
    w.settings.camera = in->camera;
    path_record_follow(&in->trail, &w, in->x, in->y, in->sample);
}

/* Begins to draw from what is picked. */
static void place(struct inspector *in)
{
    struct world w;

    if (!view_mode_world(&in->show, &w))
        return;
    in->camera = w.settings.camera;
    find_pixel(in);
    in->sample = 0;
    in->step = 1;
    follow(in);
    in->is_surface = path_record_scatter(&in->lobes, &w, in->x, in->y);
}

static void say_drawing(struct inspector *in)
{
    if (in->drawing == INSPECTOR_BOXES)
        say_boxes(in);
    else if (in->drawing == INSPECTOR_LOBES && !in->is_surface)
        render_control_say(in->work,
                           "only the sky is there: %s picks something else",
                           render_control_key(in->work, ACTION_CURSOR).text);
    inspector_open_panel(in);
}

/* A path goes on from where the directions were drawn. */
static void next_drawing(struct inspector *in)
{
    struct error err;

    in->drawing =
        (enum inspector_drawing)((in->drawing + 1) % INSPECTOR_DRAWINGS);
    render_control_be_silent(in->work);
    if (in->drawing != INSPECTOR_NOTHING &&
        !view_mode_need_tree(&in->show, &err)) {
        in->drawing = INSPECTOR_NOTHING;
        render_control_say_error(in->work, err.text);
    }
    if (in->drawing == INSPECTOR_LOBES)
        place(in);
    say_drawing(in);
}

static void change_level(struct inspector *in, int by)
{
    if (by < 0 ? in->level > 0 : in->level < in->show.bvh.depth)
        in->level += (uint32_t)by;
    say_boxes(in);
}

/* Behind the last step comes the next sample, before the first the last. */
static void change_step(struct inspector *in, int by)
{
    in->step += by;
    if (in->step < 1 && in->sample == 0) {
        in->step = 1;
    } else if (in->step < 1) {
        in->sample--;
        follow(in);
        in->step = in->trail.count;
    } else if (in->step > in->trail.count) {
        in->sample++;
        follow(in);
        in->step = 1;
    }
    inspector_open_panel(in);
}

static void change(struct inspector *in, int by)
{
    in->work->has_changed = true;
    if (in->drawing == INSPECTOR_BOXES)
        change_level(in, by);
    else if (in->drawing == INSPECTOR_PATH)
        change_step(in, by);
    else
        render_control_say(in->work,
                           "%s %s go through boxes or a path: %s draws them",
                           render_control_key(in->work, ACTION_LESS).text,
                           render_control_key(in->work, ACTION_MORE).text,
                           render_control_key(in->work, ACTION_DRAWING).text);
}

/* ---- saving ---- */

/* Light is there from its first sample on. */
static bool has_picture(struct inspector *in)
{
    if (view_mode_sample(in->show.kind) != SAMPLE_LIGHT ||
        render_progress(session_of(in)->render).samples > 0)
        return true;
    render_control_say(in->work, "nothing to save yet");
    return false;
}

/* As it is shown, in pixels of the frame. */
static bool paint_all(struct inspector *in, struct frame *frame,
                      struct error *err)
{
    struct film *film = render_film(session_of(in)->render);

    if (!view_mode_picture(&in->show, film, frame, err))
        return false;
    paint_drawing(in, frame);
    return true;
}

static void save_shown(struct inspector *in)
{
    struct rect r = session_of(in)->crop;
    struct frame frame = {0};
    struct error err;

    if (frame_init(&frame, r.width, r.height, &err) &&
        paint_all(in, &frame, &err))
        work_save_frame(in->work, &frame);
    else
        render_control_say_error(in->work, err.text);
    frame_free(&frame);
}

static void save_text(struct inspector *in)
{
    struct ansi_text_style style = screen_style(in->canvas);
    struct frame frame = {0};
    struct error err;

    if (ansi_text_frame_init(&frame, &style, &err) &&
        paint_all(in, &frame, &err))
        work_save_text(in->work, &frame, &style);
    else
        render_control_say_error(in->work, err.text);
    frame_free(&frame);
}

/* A picture of light without drawings is a film: a thread saves that. */
static void save(struct inspector *in)
{
    if (in->show.kind == SHOW_LIGHT && in->drawing == INSPECTOR_NOTHING)
        work_save_picture(in->work, "png");
    else if (has_picture(in))
        save_shown(in);
}

static void save_linear(struct inspector *in)
{
    if (view_mode_sample(in->show.kind) == SAMPLE_LIGHT)
        work_save_picture(in->work, "hdr");
    else
        render_control_say(in->work,
                           "only light is saved as HDR: %s goes back to it",
                           render_control_key(in->work, ACTION_VIEW_BACK).text);
}

/* ---- actions ---- */

static void show(struct inspector *in, enum show_kind kind)
{
    struct session *s = session_of(in);
    enum sample_kind before = s->sample;
    struct error err;

    render_control_be_silent(in->work);
    if (!view_mode_set(&in->show, kind, &err))
        render_control_say_error(in->work, err.text);
    s->sample = view_mode_sample(in->show.kind);
    in->work->has_changed = true;
    if (in->work->is_live && s->sample != before)
        render_control_restart(
            in->work); /* the film has other numbers until then */
}

/* Normal mode renders light and nothing else. */
static void turn(struct inspector *in, int by)
{
    int kind = (int)in->show.kind;

    do
        kind = (kind + by + SHOW_KINDS) % SHOW_KINDS;
    while (!in->work->is_live &&
           view_mode_sample((enum show_kind)kind) != SAMPLE_LIGHT);
    show(in, (enum show_kind)kind);
}

bool inspector_act(struct inspector *in, enum action action)
{
    switch (action) {
    case ACTION_VIEW_NEXT: turn(in, 1); break;
    case ACTION_VIEW_BACK: turn(in, -1); break;
    case ACTION_DRAWING: next_drawing(in); break;
    case ACTION_LESS: change(in, -1); break;
    case ACTION_MORE: change(in, 1); break;
    case ACTION_SAVE: save(in); break;
    case ACTION_SAVE_LINEAR: save_linear(in); break;
    case ACTION_SAVE_TEXT:
        if (has_picture(in))
            save_text(in);
        break;
    default: return false;
    }
    return true;
}

void inspector_step(struct inspector *in)
{
    if ((in->drawing == INSPECTOR_LOBES || in->drawing == INSPECTOR_PATH) &&
        is_new_pick(in)) {
        place(in);
        say_drawing(in);
    }
}

void inspector_leave(struct inspector *in)
{
    if (view_mode_sample(in->show.kind) != SAMPLE_LIGHT)
        show(in, SHOW_LIGHT);
}

void inspector_stop_drawing(struct inspector *in)
{
    inspector_close_panel(in);
    in->drawing = INSPECTOR_NOTHING;
}

void inspector_renew(struct inspector *in)
{
    inspector_stop_drawing(in);
    view_mode_renew(&in->show);
}

void inspector_init(struct inspector *in, struct render_control *work,
                    struct screen *canvas, struct pick_cursor *cursor)
{
    *in = (struct inspector){.work = work, .canvas = canvas, .cursor = cursor};
    view_mode_init(&in->show, work->session);
    canvas->painter = (struct painter){paint, in};
}

void inspector_free(struct inspector *in)
{
    view_mode_free(&in->show);
    *in = (struct inspector){0};
}
