// SPDX-License-Identifier: MIT
#include "studio/camera_control.h"

#include <string.h>

#include "base/clock.h"
#include "studio/camera_moves.h"

static struct edit *edit_of(const struct camera_control *camera)
{
    return &camera->control->session->edit;
}

static const struct view *view_of(const struct camera_control *camera)
{
    return &edit_of(camera)->now.view;
}

static const struct pose *pose_of(const struct camera_control *camera)
{
    return &view_of(camera)->pose;
}

static double aspect_of(const struct camera_control *camera)
{
    const struct view *view = view_of(camera);

    return (double)view->width_px / view->height_px;
}

static const struct scene *scene_of(const struct camera_control *camera)
{
    return &camera->control->session->scene;
}

void camera_control_init(struct camera_control *camera,
                         struct render_control *control, struct screen *screen)
{
    const struct scene *scene = &control->session->scene;

    *camera = (struct camera_control){.control = control,
                                      .screen = screen,
                                      .cursor = {.control = control,
                                                 .screen = screen}};
    camera_input_init(&camera->input, scene->bounds_lo, scene->bounds_hi);
}

void camera_control_stop(struct camera_control *camera)
{
    held_keys_stop(&camera->input.motion);
    camera->input.is_dragging = false;
    edit_end_step(edit_of(camera));
}

/* Resets the clearance after a jump of the eye. */
static void reset_clearance(struct camera_control *camera)
{
    clearance_reset(&camera->clearance);
    camera->reported_state = CLEARANCE_IN_SCENE;
}

void camera_control_set_scene(struct camera_control *camera)
{
    camera->cursor.has_pick = false;
    camera->cursor.is_pick_new = false;
    camera->cursor.is_outdated = camera->screen->has_cursor;
    reset_clearance(camera);
    camera_input_resize(&camera->input, scene_of(camera)->bounds_lo,
                        scene_of(camera)->bounds_hi);
}

/* ---- clearance ---- */

static void update_clearance(struct camera_control *camera)
{
    const struct session *s = camera->control->session;

    if (world_tree(&s->world) == NULL)
        return; /* the render thread may be building it */
    clearance_update(&camera->clearance, &s->scene, &s->world, pose_of(camera),
                     aspect_of(camera));
    camera_input_adapt(&camera->input, camera->clearance.near,
                       camera->clearance.box_distance);
}

static void say_state(struct camera_control *camera)
{
    const struct clearance *c = &camera->clearance;
    struct keymap_name key = render_control_key(camera->control, ACTION_RESET);
    const char *name;

    if (c->state == CLEARANCE_INSIDE_SOLID) {
        name = pick_cursor_object_name(&camera->cursor, c->passed);
        render_control_say_long(camera->control, "inside of %.60s: %s returns",
                                name, key.text);
    } else if (c->state == CLEARANCE_OUTSIDE_ROOM) {
        render_control_say_long(camera->control,
                                "outside%s, behind a wall: %s returns",
                                c->box_distance > 0 ? " the scene" : "",
                                key.text);
    } else {
        render_control_say_long(camera->control,
                                "nothing of the scene is in view: %s returns",
                                key.text);
    }
    camera->reported_ns = camera->control->message.said_ns;
}

/* Updates the clearance after a move. A bad state has one message, which is
 * removed when the state is good again. */
static void report_state(struct camera_control *camera)
{
    update_clearance(camera);
    if (camera->clearance.state == camera->reported_state)
        return;
    camera->reported_state = camera->clearance.state;
    if (camera->reported_state != CLEARANCE_IN_SCENE)
        say_state(camera);
    else if (camera->reported_ns == camera->control->message.said_ns)
        render_control_clear_message(camera->control);
}

/* ---- moves ---- */

static void say_lens(struct camera_control *camera)
{
    const struct pose *pose = pose_of(camera);

    if (camera->held == HELD_KEYS_WIDEN)
        render_control_say(camera->control, "field of view %.3g degrees",
                           pose->fovy_deg);
    else if (camera->held != HELD_KEYS_OPEN)
        return;
    else if (pose->aperture > 0)
        render_control_say(camera->control, "aperture %.3g", pose->aperture);
    else
        render_control_say(camera->control,
                           "pinhole lens: everything is in focus");
}

static void steer_held(struct camera_control *camera, uint64_t now_ns)
{
    struct pose pose = *pose_of(camera);
    uint64_t next_ns;
    bool has_moved = false;

    /* the speed of each step depends on the clearance at its begin, even if the
     * event loop is late */
    while ((next_ns = held_keys_next_ns(&camera->input.motion)) <= now_ns &&
           next_ns != UINT64_MAX) {
        update_clearance(camera);
        has_moved |= camera_input_step(&camera->input, &pose, next_ns);
        edit_pose(edit_of(camera), &pose);
    }
    if (!has_moved)
        return;
    camera->cursor.is_outdated = camera->screen->has_cursor;
    say_lens(camera);
    report_state(camera);
}

void camera_control_end_move(struct camera_control *camera)
{
    steer_held(camera, UINT64_MAX);
}

/* Held time until now is applied first, since the event loop may be late. */
void camera_control_move(struct camera_control *camera,
                         enum held_keys_axis axis, int sign)
{
    uint64_t now_ns = clock_ns();

    if (!render_control_may_move(camera->control))
        return;
    steer_held(camera, now_ns);
    if (edit_begin_gesture(edit_of(camera), 1 + 2 * (uint32_t)axis + (sign > 0),
                           now_ns))
        camera_input_begin(&camera->input, now_ns);
    camera->held = axis;
    held_keys_press(&camera->input.motion, axis, sign, now_ns);
    steer_held(camera, now_ns);
}

/* Returns true if the camera may jump now, and releases held keys. */
static bool may_jump(struct camera_control *camera)
{
    if (!render_control_may_move(camera->control))
        return false;
    camera_control_stop(camera);
    return true;
}

static void jump(struct camera_control *camera, const struct pose *pose)
{
    edit_end_step(edit_of(camera));
    edit_pose(edit_of(camera), pose);
    edit_end_step(edit_of(camera));
    reset_clearance(camera);
}

static void change_speed(struct camera_control *camera, int steps)
{
    camera_input_change_speed(&camera->input, steps);
    update_clearance(camera);
    render_control_say(camera->control,
                       "speed factor %.3g: %.3g units a second here",
                       camera->input.speed, camera_input_speed(&camera->input));
}

void camera_control_faster(struct camera_control *camera)
{
    change_speed(camera, 1);
}

void camera_control_slower(struct camera_control *camera)
{
    change_speed(camera, -1);
}

void camera_control_reset(struct camera_control *camera)
{
    if (!may_jump(camera))
        return;
    jump(camera, &camera->control->session->opened_pose);
    render_control_say(camera->control, "the view as it was opened");
}

/* Returns true if undo is allowed now. During a reload it is not: the loaded
 * files would restore an undone change of materials. */
static bool may_undo(struct camera_control *camera)
{
    struct render_control *control = camera->control;

    if (!control->is_live)
        render_control_say(control,
                           "undo works only in live mode: %s switches to it",
                           render_control_key(control, ACTION_MODE).text);
    else if (control->reload.is_busy)
        render_control_say(control,
                           "the scene is being loaded: undo works after that");
    return control->is_live && !control->reload.is_busy;
}

static void step_history(struct camera_control *camera, bool is_back)
{
    struct pose before = *pose_of(camera);
    const char *step;

    if (!may_undo(camera))
        return;
    camera_control_stop(camera);
    step = is_back ? edit_undo(edit_of(camera)) : edit_redo(edit_of(camera));
    if (step == NULL)
        render_control_say(camera->control,
                           is_back ? "nothing to undo" : "nothing to redo");
    else
        render_control_say(camera->control, "%s: %s",
                           is_back ? "undone" : "redone", step);
    if (memcmp(&before, pose_of(camera), sizeof before) != 0)
        reset_clearance(camera);
}

void camera_control_undo(struct camera_control *camera)
{
    step_history(camera, true);
}

void camera_control_redo(struct camera_control *camera)
{
    step_history(camera, false);
}

/* ---- orbit, frame, focus ---- */

/* Sets the centre of orbits to the pick, or else to the surface in the middle
 * of the picture, or else to the centre of the scene. */
static void find_pivot(struct camera_control *camera)
{
    struct pick pick = camera->cursor.pick;

    if (!camera->cursor.has_pick &&
        !pick_cursor_find_center(&camera->cursor, &pick))
        memcpy(pick.position, scene_of(camera)->center, sizeof pick.position);
    memcpy(camera->input.pivot, pick.position, sizeof camera->input.pivot);
}

static bool need_pick(struct camera_control *camera)
{
    if (!pick_cursor_need_pick(&camera->cursor))
        return false;
    find_pivot(camera);
    return true;
}

void camera_control_pick(struct camera_control *camera)
{
    if (pick_cursor_pick(&camera->cursor))
        find_pivot(camera);
}

void camera_control_switch_orbit(struct camera_control *camera)
{
    bool picks = camera->screen->has_cursor;

    if (picks && !need_pick(camera))
        return;
    held_keys_stop(&camera->input.motion);
    camera->input.is_orbiting = picks || !camera->input.is_orbiting;
    find_pivot(camera);
    render_control_say(
        camera->control,
        !camera->input.is_orbiting ? "arrows and mouse look around"
        : camera->cursor.has_pick
            ? "arrows and mouse orbit the picked point"
            : "arrows and mouse orbit the centre of the picture");
}

static void frame(struct camera_control *camera, const double lo[3],
                  const double hi[3], const char *name)
{
    struct pose framed = *pose_of(camera);

    if (!may_jump(camera))
        return;
    camera_frame(&framed, aspect_of(camera), lo, hi);
    jump(camera, &framed);
    render_control_say(camera->control, "%s", name);
}

void camera_control_frame_object(struct camera_control *camera)
{
    uint32_t object;
    double lo[3], hi[3];

    if (!need_pick(camera))
        return;
    object = camera->cursor.pick.object;
    pick_bounds(scene_of(camera), object, lo, hi);
    frame(camera, lo, hi, pick_cursor_object_name(&camera->cursor, object));
}

void camera_control_frame_all(struct camera_control *camera)
{
    const struct scene *s = scene_of(camera);

    if (s->tri_count > 0)
        frame(camera, s->bounds_lo, s->bounds_hi, "the whole scene");
    else
        render_control_say(camera->control, "no faces to frame");
}

void camera_control_focus(struct camera_control *camera)
{
    struct pose pose = *pose_of(camera);

    if (!need_pick(camera) || !may_jump(camera))
        return;
    pose.focus = camera_depth(pose_of(camera), camera->cursor.pick.position);
    if (!(pose.focus > 0)) {
        render_control_say(camera->control,
                           "the picked point is behind the camera");
        return;
    }
    jump(camera, &pose);
    if (pose.aperture > 0)
        render_control_say(camera->control, "focus at %.4g", pose.focus);
    else
        render_control_say(
            camera->control, "focus at %.4g, once the lens is open: %s",
            pose.focus, render_control_key(camera->control, ACTION_OPEN).text);
}

/* ---- numbered views ---- */

void camera_control_keep_view(struct camera_control *camera, int number)
{
    edit_shot(edit_of(camera), (uint32_t)number - 1);
    render_control_say(
        camera->control, "stored as view %d: %s writes it to the view file",
        number, render_control_key(camera->control, ACTION_SAVE_VIEW).text);
}

void camera_control_go_to_view(struct camera_control *camera, int number)
{
    if (!view_of(camera)->has_shot[number - 1]) {
        render_control_say(
            camera->control, "view %d is not set: %s %d stores this view there",
            number, render_control_key(camera->control, ACTION_KEEP).text,
            number);
    } else if (may_jump(camera)) {
        jump(camera, &view_of(camera)->shots[number - 1]);
        render_control_say(camera->control, "view %d", number);
    }
}

/* ---- mouse ---- */

static void wheel(struct camera_control *camera, bool is_up, bool is_modified)
{
    if (is_modified)
        camera_control_move(camera, HELD_KEYS_WIDEN, is_up ? -1 : 1);
    else
        change_speed(camera, is_up ? 1 : -1);
}

static bool steer_by(struct camera_control *camera, const struct event *event)
{
    struct rect r = pick_cursor_shown_rect(&camera->cursor);
    struct pose pose = *pose_of(camera);

    if (!camera_input_mouse(&camera->input, &pose, event, &camera->screen->fit,
                            r.width, r.height))
        return false;
    if (camera->drag_is_new)
        edit_end_step(edit_of(camera));
    camera->drag_is_new = false;
    edit_pose(edit_of(camera), &pose);
    return true;
}

static void drag(struct camera_control *camera, const struct event *event)
{
    if (!render_control_may_move(camera->control))
        camera->input.is_dragging = false; /* the release is no click */
    else if (steer_by(camera, event))
        report_state(camera);
}

void camera_control_mouse(struct camera_control *camera,
                          const struct event *event)
{
    switch (event->mouse) {
    case MOUSE_WHEEL_UP: wheel(camera, true, event->is_modified); break;
    case MOUSE_WHEEL_DOWN: wheel(camera, false, event->is_modified); break;
    case MOUSE_DRAG: drag(camera, event); break;
    case MOUSE_PRESS:
        camera->drag_is_new = true;
        if (camera_input_orbits(&camera->input, event) &&
            !camera->input.is_orbiting)
            find_pivot(camera);
        steer_by(camera, event);
        break;
    case MOUSE_RELEASE:
        if (camera->input.is_dragging && !camera->input.has_dragged &&
            event->button == 0 &&
            pick_cursor_click(&camera->cursor, event->x - 1, event->y - 1))
            find_pivot(camera);
        steer_by(camera, event);
        break;
    case MOUSE_OTHER: break;
    }
}

void camera_control_step(struct camera_control *camera, uint64_t now_ns)
{
    steer_held(camera, now_ns);
    pick_cursor_step(&camera->cursor);
}

uint64_t camera_control_next_ns(const struct camera_control *camera)
{
    return held_keys_next_ns(&camera->input.motion);
}
