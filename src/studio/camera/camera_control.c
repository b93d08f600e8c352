// SPDX-License-Identifier: MIT
#include "studio/camera/camera_control.h"

#include <string.h>

#include "base/clock.h"
#include "studio/camera/camera_input.h"
#include "studio/camera/framing.h"

/* Share of an object that is seen from which it counts as not hidden. */
#define SEEN_WELL 0.5

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
    return &camera->control->session->engine.scene;
}

void camera_control_init(struct camera_control *camera,
                         struct live_render *control, struct screen *screen)
{
    const struct scene *scene = &control->session->engine.scene;

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

void camera_control_set_scene(struct camera_control *camera)
{
    camera->cursor.has_pick = false;
    camera->cursor.is_pick_new = false;
    camera->cursor.is_outdated = camera->screen->has_cursor;
    camera->reported = CAMERA_FREE;
    camera_input_resize(&camera->input, scene_of(camera)->bounds_lo,
                        scene_of(camera)->bounds_hi);
}

/* ---- surfaces around the camera ---- */

/* Returns the surfaces, with NULL for the scene while there is no tree, which
 * the render thread may be building. */
static struct surfaces surfaces_of(const struct camera_control *camera)
{
    const struct session *s = camera->control->session;

    return world_tree(&s->engine.world) != NULL
               ? (struct surfaces){&s->engine.scene, &s->engine.world}
               : (struct surfaces){0};
}

static void set_walls(struct camera_control *camera)
{
    const struct surfaces none = {0};

    camera->input.walls = camera->passes_walls ? none : surfaces_of(camera);
}

/* Adapts the speed to the place of the camera. */
static void adapt_speed(struct camera_control *camera)
{
    struct surfaces surfaces = surfaces_of(camera);
    struct clearance c;

    if (surfaces.scene == NULL)
        return;
    c = surfaces_clearance(&surfaces, pose_of(camera)->eye);
    camera_input_adapt(&camera->input, c.near, c.box_distance);
}

static enum camera_trouble find_trouble(const struct camera_control *camera)
{
    const struct scene *s = scene_of(camera);

    if (s->tri_count > 0 && !camera_sees_box(pose_of(camera), aspect_of(camera),
                                             s->bounds_lo, s->bounds_hi))
        return CAMERA_OUT_OF_VIEW;
    return camera->input.is_stopped ? CAMERA_STOPPED : CAMERA_FREE;
}

static void say_trouble(struct camera_control *camera)
{
    uint32_t object = camera->input.blocker;

    if (camera->reported == CAMERA_OUT_OF_VIEW)
        live_render_say_long(
            camera->control, "nothing of the scene is in view: %s returns",
            live_render_key(camera->control, ACTION_RESET).text);
    else
        live_render_say_long(
            camera->control, "%.60s %s the camera: %s goes through",
            object == NO_INDEX
                ? "surfaces"
                : pick_cursor_object_name(&camera->cursor, object),
            object == NO_INDEX ? "stop" : "stops",
            live_render_key(camera->control, ACTION_WALLS).text);
    camera->reported_ns = camera->control->message.said_ns;
}

/* Reports what is wrong after a move. A message about it is removed when the
 * camera is free again. */
static void report_trouble(struct camera_control *camera)
{
    enum camera_trouble trouble = find_trouble(camera);

    if (trouble == camera->reported)
        return;
    camera->reported = trouble;
    if (trouble != CAMERA_FREE)
        say_trouble(camera);
    else if (camera->reported_ns == camera->control->message.said_ns)
        live_render_clear_message(camera->control);
}

void camera_control_switch_walls(struct camera_control *camera)
{
    camera->passes_walls = !camera->passes_walls;
    camera->reported = CAMERA_FREE;
    live_render_say(camera->control, camera->passes_walls
                                         ? "the camera goes through walls"
                                         : "walls stop the camera");
}

/* ---- moves ---- */

static bool may_move(struct camera_control *camera)
{
    return live_render_need_live(camera->control, "the camera moves");
}

static void say_lens(struct camera_control *camera)
{
    const struct pose *pose = pose_of(camera);

    if (camera->held == HELD_KEYS_WIDEN)
        live_render_say(camera->control, "field of view %.3g degrees",
                        pose->fovy_deg);
    else if (camera->held != HELD_KEYS_OPEN)
        return;
    else if (pose->aperture > 0)
        live_render_say(camera->control, "aperture %.3g", pose->aperture);
    else
        live_render_say(camera->control,
                        "pinhole lens: everything is in focus");
}

static void steer_held(struct camera_control *camera, uint64_t now_ns)
{
    struct pose pose = *pose_of(camera);
    uint64_t next_ns;
    bool has_moved = false;

    set_walls(camera);
    /* the speed of each step depends on the place where it begins, even if the
     * event loop is late */
    while ((next_ns = held_keys_next_ns(&camera->input.motion)) <= now_ns &&
           next_ns != UINT64_MAX) {
        adapt_speed(camera);
        has_moved |= camera_input_step(&camera->input, &pose, next_ns);
        edit_pose(edit_of(camera), &pose);
    }
    if (!has_moved)
        return;
    camera->cursor.is_outdated = camera->screen->has_cursor;
    say_lens(camera);
    report_trouble(camera);
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

    if (!may_move(camera))
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
    if (!may_move(camera))
        return false;
    camera_control_stop(camera);
    return true;
}

static void jump(struct camera_control *camera, const struct pose *pose)
{
    edit_end_step(edit_of(camera));
    edit_pose(edit_of(camera), pose);
    edit_end_step(edit_of(camera));
    camera->reported = CAMERA_FREE;
}

void camera_control_change_speed(struct camera_control *camera, int steps)
{
    camera_input_change_speed(&camera->input, steps);
    adapt_speed(camera);
    live_render_say(camera->control,
                    "speed factor %.3g: %.3g units a second here",
                    camera->input.speed, camera_input_speed(&camera->input));
}

void camera_control_step_history(struct camera_control *camera, int by)
{
    struct pose before = *pose_of(camera);
    bool is_back = by < 0;
    const char *step;

    if (!live_render_may_edit(camera->control, "undo works"))
        return;
    camera_control_stop(camera);
    step = is_back ? edit_undo(edit_of(camera)) : edit_redo(edit_of(camera));
    if (step == NULL)
        live_render_say(camera->control,
                        is_back ? "nothing to undo" : "nothing to redo");
    else
        live_render_say(camera->control, "%s: %s",
                        is_back ? "undone" : "redone", step);
    if (memcmp(&before, pose_of(camera), sizeof before) != 0)
        camera->reported = CAMERA_FREE;
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
    camera_input_set_pivot(&camera->input, pick.position);
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
    live_render_say(camera->control,
                    !camera->input.is_orbiting ? "arrows and mouse look around"
                    : camera->cursor.has_pick
                        ? "arrows and mouse orbit the picked point"
                        : "arrows and mouse orbit the centre of the picture");
}

/* Frames an object, or the whole scene if it is NO_INDEX. */
static void frame(struct camera_control *camera, uint32_t object,
                  const char *name)
{
    struct surfaces surfaces = surfaces_of(camera);
    struct pose pose = *pose_of(camera);
    struct framing framing;
    double share;

    if (surfaces.scene == NULL || !may_jump(camera))
        return;
    framing_init(&framing, &surfaces, object, aspect_of(camera));
    share = framing_find(&framing, &pose);
    if (!(share > 0) && object == NO_INDEX)
        camera_frame(&pose, framing.aspect, framing.lo, framing.hi);
    if (share > 0 || object == NO_INDEX)
        jump(camera, &pose);
    live_render_say(camera->control, "%s%s", name,
                    share > SEEN_WELL || object == NO_INDEX ? ""
                    : share > 0                             ? ", partly hidden"
                                : " is hidden from all sides");
}

void camera_control_frame_object(struct camera_control *camera)
{
    uint32_t object;

    if (!need_pick(camera))
        return;
    object = camera->cursor.pick.object;
    frame(camera, object, pick_cursor_object_name(&camera->cursor, object));
}

void camera_control_frame_all(struct camera_control *camera)
{
    if (scene_of(camera)->tri_count > 0)
        frame(camera, NO_INDEX, "the whole scene");
    else
        live_render_say(camera->control, "no faces to frame");
}

void camera_control_reset(struct camera_control *camera)
{
    const struct pose *opened = &camera->control->session->opened_pose;
    bool is_there = memcmp(opened, pose_of(camera), sizeof *opened) == 0;

    if (!may_jump(camera))
        return;
    camera->input.is_orbiting = camera->passes_walls = false;
    camera->input.speed = 1;
    if (is_there) {
        camera_control_frame_all(camera);
        return;
    }
    jump(camera, opened);
    live_render_say(camera->control,
                    "the view as it was opened; %s again shows the whole scene",
                    live_render_key(camera->control, ACTION_RESET).text);
}

void camera_control_focus(struct camera_control *camera)
{
    struct pose pose = *pose_of(camera);

    if (!need_pick(camera) || !may_jump(camera))
        return;
    pose.focus = camera_depth(pose_of(camera), camera->cursor.pick.position);
    if (!(pose.focus > 0)) {
        live_render_say(camera->control,
                        "the picked point is behind the camera");
        return;
    }
    jump(camera, &pose);
    if (pose.aperture > 0)
        live_render_say(camera->control, "focus at %.4g", pose.focus);
    else
        live_render_say(camera->control,
                        "focus at %.4g, once the lens is open: %s", pose.focus,
                        live_render_key(camera->control, ACTION_OPEN).text);
}

/* ---- numbered views ---- */

void camera_control_keep_view(struct camera_control *camera, int number)
{
    edit_shot(edit_of(camera), (uint32_t)number - 1);
    live_render_say(camera->control,
                    "stored as view %d: %s writes it to the view file", number,
                    live_render_key(camera->control, ACTION_SAVE_VIEW).text);
}

void camera_control_go_to_view(struct camera_control *camera, int number)
{
    if (!view_of(camera)->has_shot[number - 1]) {
        live_render_say(camera->control,
                        "view %d is not set: %s %d stores this view there",
                        number,
                        live_render_key(camera->control, ACTION_KEEP).text,
                        number);
    } else if (may_jump(camera)) {
        jump(camera, &view_of(camera)->shots[number - 1]);
        live_render_say(camera->control, "view %d", number);
    }
}

/* ---- mouse ---- */

static void wheel(struct camera_control *camera, bool is_up, bool is_modified)
{
    if (is_modified)
        camera_control_move(camera, HELD_KEYS_WIDEN, is_up ? -1 : 1);
    else
        camera_control_change_speed(camera, is_up ? 1 : -1);
}

static bool steer_by(struct camera_control *camera, const struct event *event)
{
    struct rect r = pick_cursor_shown_rect(&camera->cursor);
    struct pose pose = *pose_of(camera);

    set_walls(camera);
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
    if (!may_move(camera))
        camera->input.is_dragging = false; /* the release is no click */
    else if (steer_by(camera, event))
        report_trouble(camera);
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
