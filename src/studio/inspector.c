// SPDX-License-Identifier: MIT
#include "studio/inspector.h"

#include <stdio.h>
#include <string.h>

#include "base/print.h"
#include "inspect/overlay.h"
#include "render/projection.h"
#include "session/save.h"
#include "kernels/vec.h"

#define TEXT_BYTES 256

static struct session *session_of(const struct inspector *inspector)
{
    return inspector->control->session;
}

/* ---- drawings ---- */

static bool draws_path(const struct inspector *inspector)
{
    return inspector->drawing == INSPECTOR_PATH ||
           inspector->drawing == INSPECTOR_NUMBERS;
}

static void draw_over(struct inspector *inspector, struct frame *frame)
{
    struct world w;
    struct camera camera;

    if (inspector->drawing == INSPECTOR_NOTHING ||
        !view_mode_world(&inspector->view_mode, &w))
        return;
    camera = view_mode_camera(&inspector->view_mode, &w.settings.camera, frame);
    if (inspector->drawing == INSPECTOR_BOXES)
        overlay_boxes(frame, &camera, &w, inspector->level);
    else if (inspector->drawing == INSPECTOR_LOBES && inspector->is_surface)
        overlay_lobes(frame, &camera, &inspector->lobes);
    else if (draws_path(inspector))
        overlay_path(frame, &camera, &w, &inspector->trail, inspector->step);
}

void inspector_picture(struct inspector *inspector, struct frame *frame)
{
    struct render *render = session_of(inspector)->engine.render;

    view_mode_preview(&inspector->view_mode, render_film(render),
                      render_draft(render),
                      session_of(inspector)->is_filtered
                          ? render_surfaces(render)
                          : NULL,
                      frame);
}

void inspector_preview(struct inspector *inspector, struct frame *frame)
{
    inspector_picture(inspector, frame);
    draw_over(inspector, frame);
}

void inspector_close_table(struct inspector *inspector)
{
    if (inspector->has_table)
        screen_close_window(inspector->screen);
    inspector->has_table = false;
    inspector->control->has_changed = true;
}

void inspector_open_table(struct inspector *inspector)
{
    const struct session *s = session_of(inspector);
    const struct world world = world_arrays(&s->engine.world, &s->engine.scene);
    const struct overlay_names names = {&world, s->edit.names};
    const char *lines[OVERLAY_TEXT_LINES];
    struct overlay_text legend;
    char title[TEXT_BYTES];

    inspector_close_table(inspector);
    if (inspector->screen->is_too_small)
        return;
    if (inspector->drawing == INSPECTOR_LOBES && inspector->is_surface) {
        overlay_text_lobes(&legend, &names, &inspector->lobes);
        snprintf(title, sizeof title, " directions from pixel %u %u ",
                 inspector->x, inspector->y);
    } else if (draws_path(inspector)) {
        overlay_text_path(&legend,
                          inspector->drawing == INSPECTOR_NUMBERS
                              ? &s->engine.scene
                              : NULL,
                          &names, &inspector->trail, inspector->step);
        snprintf(title, sizeof title, " sample %llu of pixel %u %u - %s %s ",
                 (unsigned long long)inspector->sample, inspector->x,
                 inspector->y,
                 live_render_key(inspector->control, ACTION_LESS).text,
                 live_render_key(inspector->control, ACTION_MORE).text);
    } else {
        return;
    }
    for (int i = 0; i < legend.count; i++)
        lines[i] = legend.lines[i];
    screen_open_window(inspector->screen, WINDOW_BOTTOM_LEFT, title, lines,
                       legend.count);
    inspector->has_table = true;
}

static void say_boxes(struct inspector *inspector)
{
    struct frame nothing = {0};
    struct camera any = {0};
    struct world w;
    uint32_t boxes;

    if (!view_mode_world(&inspector->view_mode, &w))
        return;
    boxes = overlay_boxes(&nothing, &any, &w, inspector->level);
    live_render_say_long(
        inspector->control,
        "boxes of level %u of %u: %u box%s; %s %s go up and down",
        inspector->level + 1, overlay_levels(&w), boxes, boxes == 1 ? "" : "es",
        live_render_key(inspector->control, ACTION_LESS).text,
        live_render_key(inspector->control, ACTION_MORE).text);
}

static bool is_new_pick(const struct inspector *inspector)
{
    const struct pick_cursor *cursor = inspector->cursor;

    return cursor->has_pick &&
           (!inspector->is_picked ||
            memcmp(inspector->position, cursor->pick.position,
                   sizeof inspector->position) != 0);
}

/* Finds the pixel that shows the picked point now. Without a pick, or if the
 * point is out of view, it is the middle of the picture. */
static void find_pixel(struct inspector *inspector)
{
    const struct scene *scene = &session_of(inspector)->engine.scene;
    struct rect r = session_of(inspector)->engine.crop;
    struct projected at;

    inspector->x = (uint32_t)(r.x + r.width / 2);
    inspector->y = (uint32_t)(r.y + r.height / 2);
    inspector->is_picked = inspector->cursor->has_pick;
    if (!inspector->is_picked)
        return;
    memcpy(inspector->position, inspector->cursor->pick.position,
           sizeof inspector->position);
    if (projection_point(&inspector->camera,
                         scene_point(scene, inspector->position), &at) &&
        at.x >= r.x && at.x < r.x + r.width && at.y >= r.y &&
        at.y < r.y + r.height) {
        inspector->x = (uint32_t)at.x;
        inspector->y = (uint32_t)at.y;
    }
}

static void follow_path(struct inspector *inspector)
{
    struct world w;

    if (!view_mode_world(&inspector->view_mode, &w))
        return;
    w.settings.camera = inspector->camera;
    path_record_follow(&inspector->trail, &w, inspector->x, inspector->y,
                       inspector->sample);
}

/* Begins the drawings of directions and path at the picked point. */
static void begin_at_pick(struct inspector *inspector)
{
    struct world w;

    if (!view_mode_world(&inspector->view_mode, &w))
        return;
    inspector->camera = w.settings.camera;
    find_pixel(inspector);
    inspector->sample = 0;
    inspector->step = 1;
    follow_path(inspector);
    inspector->is_surface =
        path_record_scatter(&inspector->lobes, &w, inspector->x, inspector->y);
}

static void say_drawing(struct inspector *inspector)
{
    if (inspector->drawing == INSPECTOR_BOXES)
        say_boxes(inspector);
    else if (inspector->drawing == INSPECTOR_LOBES && !inspector->is_surface)
        live_render_say(
            inspector->control,
            "only the sky is there: %s picks something else",
            live_render_key(inspector->control, ACTION_CURSOR).text);
    inspector_open_table(inspector);
}

/* The path follows the directions and begins at the same pixel. */
void inspector_next_drawing(struct inspector *inspector)
{
    struct error err;
    struct world w;

    inspector->drawing =
        (enum inspector_drawing)((inspector->drawing + 1) % INSPECTOR_DRAWINGS);
    live_render_clear_message(inspector->control);
    if (inspector->drawing != INSPECTOR_NOTHING &&
        !view_mode_traced(&inspector->view_mode, &w, &err)) {
        inspector->drawing = INSPECTOR_NOTHING;
        live_render_say_error(inspector->control, err.text);
    }
    if (inspector->drawing == INSPECTOR_LOBES)
        begin_at_pick(inspector);
    say_drawing(inspector);
}

static void change_level(struct inspector *inspector, int by)
{
    struct world w;

    if (!view_mode_world(&inspector->view_mode, &w))
        return;
    if (by < 0 ? inspector->level > 0
               : inspector->level + 1 < overlay_levels(&w))
        inspector->level += (uint32_t)by;
    say_boxes(inspector);
}

/* Changes the step of the path. The first step of the next sample follows the
 * last step, and the last step of the sample before precedes the first. */
static void change_step(struct inspector *inspector, int by)
{
    inspector->step += by;
    if (inspector->step < 1 && inspector->sample == 0) {
        inspector->step = 1;
    } else if (inspector->step < 1) {
        inspector->sample--;
        follow_path(inspector);
        inspector->step = inspector->trail.count;
    } else if (inspector->step > inspector->trail.count) {
        inspector->sample++;
        follow_path(inspector);
        inspector->step = 1;
    }
    inspector_open_table(inspector);
}

void inspector_change(struct inspector *inspector, int by)
{
    inspector->control->has_changed = true;
    if (inspector->drawing == INSPECTOR_BOXES)
        change_level(inspector, by);
    else if (draws_path(inspector))
        change_step(inspector, by);
    else
        live_render_say(
            inspector->control,
            "%s %s go through boxes or a path: %s draws them",
            live_render_key(inspector->control, ACTION_LESS).text,
            live_render_key(inspector->control, ACTION_MORE).text,
            live_render_key(inspector->control, ACTION_DRAWING).text);
}

/* ---- saving ---- */

/* Returns true if there is a picture to save. Light needs a sample first. */
static bool has_picture(struct inspector *inspector)
{
    if (view_mode_sample(inspector->view_mode.kind) != SAMPLE_LIGHT ||
        render_progress(session_of(inspector)->engine.render).samples > 0)
        return true;
    live_render_say(inspector->control, "nothing to save yet");
    return false;
}

/* Fills a frame of any size with the picture and its drawings. */
static bool paint_all(struct inspector *inspector, struct frame *frame,
                      struct error *err)
{
    struct film *film = render_film(session_of(inspector)->engine.render);

    if (!view_mode_picture(&inspector->view_mode, film, frame, err))
        return false;
    draw_over(inspector, frame);
    return true;
}

static void save_shown_frame(struct inspector *inspector)
{
    struct rect r = session_of(inspector)->engine.crop;
    struct frame frame = {0};
    struct error err;

    if (frame_init(&frame, r.width, r.height, &err) &&
        paint_all(inspector, &frame, &err)) {
        save_frame(inspector->control, &frame);
        return;
    }
    live_render_say_error(inspector->control, err.text);
    frame_free(&frame);
}

void inspector_save_text(struct inspector *inspector)
{
    struct ansi_text_style style = screen_style(inspector->screen);
    struct frame frame = {0};
    struct error err;

    if (!has_picture(inspector))
        return;
    if (ansi_text_frame_init(&frame, &style, &err) &&
        paint_all(inspector, &frame, &err))
        save_text(inspector->control, &frame, &style);
    else
        live_render_say_error(inspector->control, err.text);
    frame_free(&frame);
}

static void save_filtered_light(struct inspector *inspector)
{
    const struct film *film = render_film(session_of(inspector)->engine.render);
    struct error err;
    struct world w;

    if (view_mode_scaled(&inspector->view_mode, film->width, film->height, &w,
                         &err))
        save_filtered(inspector->control, &w);
    else
        live_render_say_error(inspector->control, err.text);
}

/* Saves the picture as it is shown. A thread saves light without drawings from
 * the film. */
void inspector_save(struct inspector *inspector)
{
    if (inspector->view_mode.kind != SHOW_LIGHT ||
        inspector->drawing != INSPECTOR_NOTHING) {
        if (has_picture(inspector))
            save_shown_frame(inspector);
    } else if (inspector->view_mode.is_filtered) {
        save_filtered_light(inspector);
    } else {
        save_picture(inspector->control, "png");
    }
}

void inspector_save_raw(struct inspector *inspector)
{
    if (view_mode_sample(inspector->view_mode.kind) == SAMPLE_LIGHT)
        save_picture(inspector->control, "png");
    else
        inspector_save(inspector);
}

static void save_linear(struct inspector *inspector, const char *ending)
{
    if (view_mode_sample(inspector->view_mode.kind) == SAMPLE_LIGHT)
        save_picture(inspector->control, ending);
    else
        live_render_say(
            inspector->control, "only light is saved as %s: %s goes back to it",
            ending, live_render_key(inspector->control, ACTION_CANCEL).text);
}

void inspector_save_hdr(struct inspector *inspector)
{
    save_linear(inspector, "hdr");
}

void inspector_save_exr(struct inspector *inspector)
{
    save_linear(inspector, "exr");
}

/* ---- actions ---- */

/* A draft without surfaces is rendered again. */
void inspector_switch_filter(struct inspector *inspector)
{
    struct session *s = session_of(inspector);

    s->is_filtered = !s->is_filtered;
    if (s->is_filtered && !s->draft_has_surfaces)
        live_render_renew_draft(inspector->control);
    live_render_say(inspector->control,
                    s->is_filtered ? "the screen's picture is filtered"
                                   : "the screen's picture is not filtered");
    inspector->control->has_changed = true;
}

static void show(struct inspector *inspector, enum show_kind kind)
{
    struct session *s = session_of(inspector);
    enum sample_kind before = s->sample;
    struct error err;

    live_render_clear_message(inspector->control);
    if (!view_mode_set(&inspector->view_mode, kind, &err))
        live_render_say_error(inspector->control, err.text);
    s->sample = view_mode_sample(inspector->view_mode.kind);
    inspector->control->has_changed = true;
    if (s->sample != before) /* the draft has samples of the old kind */
        live_render_renew_draft(inspector->control);
}

void inspector_turn_view(struct inspector *inspector, int by)
{
    int kind = (int)inspector->view_mode.kind;

    do
        kind = (kind + by + SHOW_KINDS) % SHOW_KINDS;
    while (!inspector->control->is_live &&
           view_mode_sample((enum show_kind)kind) != SAMPLE_LIGHT);
    show(inspector, (enum show_kind)kind);
}

void inspector_step(struct inspector *inspector)
{
    if ((inspector->drawing == INSPECTOR_LOBES || draws_path(inspector)) &&
        is_new_pick(inspector)) {
        begin_at_pick(inspector);
        say_drawing(inspector);
    }
}

void inspector_show_light(struct inspector *inspector)
{
    show(inspector, SHOW_LIGHT);
}

void inspector_leave(struct inspector *inspector)
{
    if (view_mode_sample(inspector->view_mode.kind) != SAMPLE_LIGHT)
        show(inspector, SHOW_LIGHT);
}

void inspector_stop_drawing(struct inspector *inspector)
{
    inspector_close_table(inspector);
    inspector->drawing = INSPECTOR_NOTHING;
}

void inspector_init(struct inspector *inspector, struct live_render *control,
                    struct screen *screen, struct pick_cursor *cursor)
{
    *inspector = (struct inspector){.control = control,
                                    .screen = screen,
                                    .cursor = cursor};
    view_mode_init(&inspector->view_mode, control->session);
}

void inspector_free(struct inspector *inspector)
{
    view_mode_free(&inspector->view_mode);
    *inspector = (struct inspector){0};
}
