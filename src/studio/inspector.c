// SPDX-License-Identifier: MIT
#include "studio/inspector.h"

#include <stdio.h>
#include <string.h>

#include "inspect/overlay_text.h"
#include "render/projection.h"
#include "inspect/overlay.h"
#include "studio/save_commands.h"
#include "kernels/vec.h"

#define TEXT_BYTES 256

static struct session *session_of(const struct inside *in)
{
    return in->work->session;
}

/* ---- drawings ---- */

static void paint_drawing(struct inside *in, struct frame *frame)
{
    struct world w;
    struct camera camera;

    if (in->drawing == INSIDE_NOTHING || !show_world(&in->show, &w))
        return;
    camera = show_camera(&in->show, &w.settings.camera, frame);
    if (in->drawing == INSIDE_BOXES)
        sketch_boxes(frame, &camera, &in->show.bvh, in->level);
    else if (in->drawing == INSIDE_LOBES && in->is_surface)
        sketch_lobes(frame, &camera, &in->lobes);
    else if (in->drawing == INSIDE_PATH)
        sketch_trail(frame, &camera, &in->trail, in->step);
}

static void paint(void *context, struct film *film, struct film *draft,
                  struct frame *frame)
{
    struct inside *in = context;

    show_paint(&in->show, film, draft, frame);
    paint_drawing(in, frame);
}

void inside_close_panel(struct inside *in)
{
    if (in->has_panel)
        canvas_close_window(in->canvas);
    in->has_panel = false;
    in->work->has_changed = true;
}

void inside_open_panel(struct inside *in)
{
    const struct scene *scene = &session_of(in)->scene;
    const char *lines[LEGEND_LINES];
    struct legend legend;
    char title[TEXT_BYTES];

    inside_close_panel(in);
    if (in->canvas->is_too_small)
        return;
    if (in->drawing == INSIDE_LOBES && in->is_surface) {
        legend_lobes(&legend, scene, &in->lobes);
        snprintf(title, sizeof title, " directions from pixel %u %u ", in->x,
                 in->y);
    } else if (in->drawing == INSIDE_PATH) {
        legend_trail(&legend, scene, &in->trail, in->step);
        snprintf(title, sizeof title, " sample %llu of pixel %u %u - %s %s ",
                 (unsigned long long)in->sample, in->x, in->y,
                 work_key(in->work, ACTION_LESS).text,
                 work_key(in->work, ACTION_MORE).text);
    } else {
        return;
    }
    for (int i = 0; i < legend.count; i++)
        lines[i] = legend.lines[i];
    canvas_open_panel(in->canvas, title, lines, legend.count);
    in->has_panel = true;
}

static void say_boxes(struct inside *in)
{
    struct frame nothing = {0};
    struct camera any = {0};

    work_say_long(in->work,
                  "boxes of level %u of %u: %u nodes; %s %s go up and down",
                  in->level, in->show.bvh.depth,
                  sketch_boxes(&nothing, &any, &in->show.bvh, in->level),
                  work_key(in->work, ACTION_LESS).text,
                  work_key(in->work, ACTION_MORE).text);
}

static bool is_new_pick(const struct inside *in)
{
    const struct cursor *c = in->cursor;

    return c->has_pick && (!in->is_picked || memcmp(in->place, c->pick.position,
                                                    sizeof in->place) != 0);
}

/* Where the pick is in the picture now, or its middle. */
static void find_pixel(struct inside *in)
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

static void follow(struct inside *in)
{
    struct world w;

    if (!show_world(&in->show, &w))
        return;
    w.settings.camera = in->camera;
    trail_follow(&in->trail, &w, in->x, in->y, in->sample);
}

/* Begins to draw from what is picked. */
static void place(struct inside *in)
{
    struct world w;

    if (!show_world(&in->show, &w))
        return;
    in->camera = w.settings.camera;
    find_pixel(in);
    in->sample = 0;
    in->step = 1;
    follow(in);
    in->is_surface = trail_scatter(&in->lobes, &w, in->x, in->y);
}

static void say_drawing(struct inside *in)
{
    if (in->drawing == INSIDE_BOXES)
        say_boxes(in);
    else if (in->drawing == INSIDE_LOBES && !in->is_surface)
        work_say(in->work, "only the sky is there: %s picks something else",
                 work_key(in->work, ACTION_CURSOR).text);
    inside_open_panel(in);
}

/* A path goes on from where the directions were drawn. */
static void next_drawing(struct inside *in)
{
    struct error err;

    in->drawing = (enum inside_drawing)((in->drawing + 1) % INSIDE_DRAWINGS);
    work_be_silent(in->work);
    if (in->drawing != INSIDE_NOTHING && !show_need_tree(&in->show, &err)) {
        in->drawing = INSIDE_NOTHING;
        work_say_error(in->work, err.text);
    }
    if (in->drawing == INSIDE_LOBES)
        place(in);
    say_drawing(in);
}

static void change_level(struct inside *in, int by)
{
    if (by < 0 ? in->level > 0 : in->level < in->show.bvh.depth)
        in->level += (uint32_t)by;
    say_boxes(in);
}

/* Behind the last step comes the next sample, before the first the last. */
static void change_step(struct inside *in, int by)
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
    inside_open_panel(in);
}

static void change(struct inside *in, int by)
{
    in->work->has_changed = true;
    if (in->drawing == INSIDE_BOXES)
        change_level(in, by);
    else if (in->drawing == INSIDE_PATH)
        change_step(in, by);
    else
        work_say(in->work, "%s %s go through boxes or a path: %s draws them",
                 work_key(in->work, ACTION_LESS).text,
                 work_key(in->work, ACTION_MORE).text,
                 work_key(in->work, ACTION_DRAWING).text);
}

/* ---- saving ---- */

/* Light is there from its first sample on. */
static bool has_picture(struct inside *in)
{
    if (show_sample(in->show.kind) != SAMPLE_LIGHT ||
        render_progress(session_of(in)->render).samples > 0)
        return true;
    work_say(in->work, "nothing to save yet");
    return false;
}

/* As it is shown, in pixels of the frame. */
static bool paint_all(struct inside *in, struct frame *frame, struct error *err)
{
    struct film *film = render_film(session_of(in)->render);

    if (!show_picture(&in->show, film, frame, err))
        return false;
    paint_drawing(in, frame);
    return true;
}

static void save_shown(struct inside *in)
{
    struct rect r = session_of(in)->crop;
    struct frame frame = {0};
    struct error err;

    if (frame_init(&frame, r.width, r.height, &err) &&
        paint_all(in, &frame, &err))
        work_save_frame(in->work, &frame);
    else
        work_say_error(in->work, err.text);
    frame_free(&frame);
}

static void save_text(struct inside *in)
{
    struct text_style style = canvas_style(in->canvas);
    struct frame frame = {0};
    struct error err;

    if (text_frame_init(&frame, &style, &err) && paint_all(in, &frame, &err))
        work_save_text(in->work, &frame, &style);
    else
        work_say_error(in->work, err.text);
    frame_free(&frame);
}

/* A picture of light without drawings is a film: a thread saves that. */
static void save(struct inside *in)
{
    if (in->show.kind == SHOW_LIGHT && in->drawing == INSIDE_NOTHING)
        work_save_picture(in->work, "png");
    else if (has_picture(in))
        save_shown(in);
}

static void save_linear(struct inside *in)
{
    if (show_sample(in->show.kind) == SAMPLE_LIGHT)
        work_save_picture(in->work, "hdr");
    else
        work_say(in->work, "only light is saved as HDR: %s goes back to it",
                 work_key(in->work, ACTION_VIEW_BACK).text);
}

/* ---- actions ---- */

static void show(struct inside *in, enum show_kind kind)
{
    struct session *s = session_of(in);
    enum sample_kind before = s->sample;
    struct error err;

    work_be_silent(in->work);
    if (!show_set(&in->show, kind, &err))
        work_say_error(in->work, err.text);
    s->sample = show_sample(in->show.kind);
    in->work->has_changed = true;
    if (in->work->is_live && s->sample != before)
        work_restart(in->work); /* the film has other numbers until then */
}

/* Normal mode renders light and nothing else. */
static void turn(struct inside *in, int by)
{
    int kind = (int)in->show.kind;

    do
        kind = (kind + by + SHOW_KINDS) % SHOW_KINDS;
    while (!in->work->is_live &&
           show_sample((enum show_kind)kind) != SAMPLE_LIGHT);
    show(in, (enum show_kind)kind);
}

bool inside_act(struct inside *in, enum action action)
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

void inside_step(struct inside *in)
{
    if ((in->drawing == INSIDE_LOBES || in->drawing == INSIDE_PATH) &&
        is_new_pick(in)) {
        place(in);
        say_drawing(in);
    }
}

void inside_leave(struct inside *in)
{
    if (show_sample(in->show.kind) != SAMPLE_LIGHT)
        show(in, SHOW_LIGHT);
}

void inside_stop_drawing(struct inside *in)
{
    inside_close_panel(in);
    in->drawing = INSIDE_NOTHING;
}

void inside_renew(struct inside *in)
{
    inside_stop_drawing(in);
    show_renew(&in->show);
}

void inside_init(struct inside *in, struct work *work, struct canvas *canvas,
                 struct cursor *cursor)
{
    *in = (struct inside){.work = work, .canvas = canvas, .cursor = cursor};
    show_init(&in->show, work->session);
    canvas->painter = (struct painter){paint, in};
}

void inside_free(struct inside *in)
{
    show_free(&in->show);
    *in = (struct inside){0};
}
