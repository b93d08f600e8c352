// SPDX-License-Identifier: MIT
#include "studio/camera_control.h"

#include <string.h>

#include "base/clock.h"
#include "studio/camera_moves.h"

/* The same key again within this time goes on with its step of undo: longer
 * than keyboards wait before they repeat. */
#define HELD_NS UINT64_C(700000000)

/* Actions that last as long as their key is held. */
static const struct move {
    enum action action;
    enum held_keys_axis axis;
    int sign;
} moves[] = {
    {ACTION_FORWARD, HELD_KEYS_FORWARD, 1},
    {ACTION_BACK, HELD_KEYS_FORWARD, -1},
    {ACTION_LEFT, HELD_KEYS_RIGHT, -1},
    {ACTION_RIGHT, HELD_KEYS_RIGHT, 1},
    {ACTION_DOWN, HELD_KEYS_UP, -1},
    {ACTION_UP, HELD_KEYS_UP, 1},
    {ACTION_LOOK_UP, HELD_KEYS_LOOK_UP, 1},
    {ACTION_LOOK_DOWN, HELD_KEYS_LOOK_UP, -1},
    {ACTION_LOOK_LEFT, HELD_KEYS_LOOK_RIGHT, -1},
    {ACTION_LOOK_RIGHT, HELD_KEYS_LOOK_RIGHT, 1},
    {ACTION_NARROWER, HELD_KEYS_WIDEN, -1},
    {ACTION_WIDER, HELD_KEYS_WIDEN, 1},
    {ACTION_CLOSE, HELD_KEYS_OPEN, -1},
    {ACTION_OPEN, HELD_KEYS_OPEN, 1},
};

static struct view *view_of(const struct camera_control *p)
{
    return &p->work->session->view;
}

static const struct scene *scene_of(const struct camera_control *p)
{
    return &p->work->session->scene;
}

void camera_control_init(struct camera_control *p, struct render_control *work,
                         struct screen *canvas)
{
    const struct scene *scene = &work->session->scene;

    *p = (struct camera_control){.work = work,
                                 .canvas = canvas,
                                 .cursor = {.work = work, .canvas = canvas}};
    camera_input_init(&p->steer, scene->bounds_lo, scene->bounds_hi);
}

void camera_control_stop(struct camera_control *p)
{
    held_keys_stop(&p->steer.motion);
    p->steer.is_dragging = false;
    p->held = ACTION_NONE;
}

/* The eye is somewhere else, without a way there. */
static void forget_place(struct camera_control *p)
{
    clearance_forget(&p->around);
    p->said = CLEARANCE_AMONG;
}

void camera_control_renew(struct camera_control *p)
{
    p->cursor.has_pick = false;
    p->cursor.is_pick_new = false;
    p->cursor.must_look = p->canvas->has_cursor;
    forget_place(p);
    camera_input_resize(&p->steer, scene_of(p)->bounds_lo,
                        scene_of(p)->bounds_hi);
}

/* ---- where the eye is ---- */

/* The tree is the render thread's until it is loaded. */
static void look_around(struct camera_control *p)
{
    const struct scene *s = scene_of(p);

    if (!render_is_loaded(p->work->session->render) || s->tree.nodes == NULL)
        return;
    clearance_follow(&p->around, s, view_of(p));
    camera_input_adapt(&p->steer, p->around.near, p->around.away);
}

static void say_place(struct camera_control *p)
{
    const struct clearance *c = &p->around;
    struct keymap_name key = render_control_key(p->work, ACTION_RESET);
    const char *name;

    if (c->place == CLEARANCE_INSIDE) {
        name = pick_cursor_object_name(&p->cursor, c->passed);
        render_control_say_long(p->work, "inside of %.60s: %s returns", name,
                                key.text);
    } else if (c->place == CLEARANCE_OUTSIDE) {
        render_control_say_long(p->work, "outside%s, behind a wall: %s returns",
                                c->away > 0 ? " the scene" : "", key.text);
    } else {
        render_control_say_long(p->work,
                                "nothing of the scene is in view: %s returns",
                                key.text);
    }
    p->said_ns = p->work->message.said_ns;
}

/* After a move: who loses the scene is told so once; the message goes with its
 * reason. */
static void judge(struct camera_control *p)
{
    look_around(p);
    if (p->around.place == p->said)
        return;
    p->said = p->around.place;
    if (p->said != CLEARANCE_AMONG)
        say_place(p);
    else if (p->said_ns == p->work->message.said_ns)
        render_control_be_silent(p->work);
}

/* ---- moves ---- */

static const struct move *find_move(enum action action)
{
    for (size_t i = 0; i < sizeof moves / sizeof moves[0]; i++) {
        if (moves[i].action == action)
            return &moves[i];
    }
    return NULL;
}

static void add_step(struct camera_control *p)
{
    struct pose pose = view_pose(view_of(p));

    camera_history_add(&p->history, &pose);
}

static void say_lens(struct camera_control *p)
{
    const struct view *v = view_of(p);

    if (p->held == ACTION_NARROWER || p->held == ACTION_WIDER)
        render_control_say(p->work, "field of view %.3g degrees", v->fovy_deg);
    else if (p->held != ACTION_CLOSE && p->held != ACTION_OPEN)
        return;
    else if (v->aperture > 0)
        render_control_say(p->work, "lens open by %.3g", v->aperture);
    else
        render_control_say(p->work, "a pinhole: everything is sharp");
}

static void steer_held(struct camera_control *p, uint64_t now_ns)
{
    uint64_t next_ns;
    bool has_moved = false;

    /* each step as long as what is around allows, also where the loop is late
     */
    while ((next_ns = held_keys_next_ns(&p->steer.motion)) <= now_ns &&
           next_ns != UINT64_MAX) {
        look_around(p);
        has_moved |= camera_input_step(&p->steer, view_of(p), next_ns);
    }
    if (!has_moved)
        return;
    p->work->must_restart = true;
    p->cursor.must_look = p->canvas->has_cursor;
    say_lens(p);
    judge(p);
}

/* The rest of a tap at once: what looks at the view then finds the same,
 * however soon its key comes. */
static void land(struct camera_control *p)
{
    steer_held(p, UINT64_MAX);
}

/* What was held until now is not lost where the loop was late. */
static void press(struct camera_control *p, const struct move *move)
{
    uint64_t now_ns = clock_ns();

    if (!render_control_may_move(p->work))
        return;
    steer_held(p, now_ns);
    if (move->action != p->held || now_ns - p->held_ns > HELD_NS) {
        add_step(p);
        camera_input_begin(&p->steer, now_ns);
    }
    p->held = move->action;
    p->held_ns = now_ns;
    held_keys_press(&p->steer.motion, move->axis, move->sign, now_ns);
    steer_held(p, now_ns);
}

/* True if the camera may jump now; what is held is let go. */
static bool may_jump(struct camera_control *p)
{
    if (!render_control_may_move(p->work))
        return false;
    camera_control_stop(p);
    return true;
}

static void jump(struct camera_control *p, const struct pose *pose)
{
    add_step(p);
    view_set_pose(view_of(p), pose);
    forget_place(p);
    p->work->must_restart = true;
}

static void change_speed(struct camera_control *p, int steps)
{
    camera_input_change_speed(&p->steer, steps);
    look_around(p);
    render_control_say(p->work, "speed times %.3g: %.3g a second here",
                       p->steer.speed, camera_input_speed(&p->steer));
}

static void reset(struct camera_control *p)
{
    struct pose pose = view_pose(&p->work->session->opened);

    if (!may_jump(p))
        return;
    jump(p, &pose);
    render_control_say(p->work, "the view as it was opened");
}

static void travel(struct camera_control *p, bool is_back)
{
    struct pose pose = view_pose(view_of(p));

    if (!may_jump(p))
        return;
    if (is_back ? !camera_history_undo(&p->history, &pose)
                : !camera_history_redo(&p->history, &pose)) {
        render_control_say(p->work,
                           is_back ? "nothing to undo" : "nothing to do again");
        return;
    }
    view_set_pose(view_of(p), &pose);
    forget_place(p);
    p->work->must_restart = true;
    render_control_say(p->work, is_back ? "undone" : "done again");
}

/* ---- orbit, frame, focus ---- */

/* What is picked, or what is in the middle of the picture, or of the scene. */
static void find_pivot(struct camera_control *p)
{
    struct pick pick = p->cursor.pick;

    if (!p->cursor.has_pick && !pick_cursor_look_ahead(&p->cursor, &pick))
        memcpy(pick.position, scene_of(p)->center, sizeof pick.position);
    memcpy(p->steer.pivot, pick.position, sizeof p->steer.pivot);
}

static bool need_pick(struct camera_control *p)
{
    if (!pick_cursor_need_pick(&p->cursor))
        return false;
    find_pivot(p);
    return true;
}

static void switch_orbit(struct camera_control *p)
{
    bool picks = p->canvas->has_cursor;

    if (picks && !need_pick(p))
        return;
    held_keys_stop(&p->steer.motion);
    p->steer.is_orbiting = picks || !p->steer.is_orbiting;
    find_pivot(p);
    render_control_say(p->work, !p->steer.is_orbiting
                                    ? "arrows and mouse look around"
                                : p->cursor.has_pick
                                    ? "arrows and mouse orbit what is picked"
                                    : "arrows and mouse orbit the middle");
}

static void frame(struct camera_control *p, const double lo[3],
                  const double hi[3], const char *name)
{
    struct view framed = *view_of(p);
    struct pose pose;

    if (!may_jump(p))
        return;
    camera_frame(&framed, lo, hi);
    pose = view_pose(&framed);
    jump(p, &pose);
    render_control_say(p->work, "%s", name);
}

static void frame_object(struct camera_control *p)
{
    uint32_t object;
    double lo[3], hi[3];

    if (!need_pick(p))
        return;
    object = p->cursor.pick.object;
    pick_bounds(scene_of(p), object, lo, hi);
    frame(p, lo, hi, pick_cursor_object_name(&p->cursor, object));
}

static void frame_all(struct camera_control *p)
{
    const struct scene *s = scene_of(p);

    if (s->tri_count > 0)
        frame(p, s->bounds_lo, s->bounds_hi, "the whole scene");
    else
        render_control_say(p->work, "no faces to frame");
}

static void focus(struct camera_control *p)
{
    struct pose pose = view_pose(view_of(p));

    if (!need_pick(p) || !may_jump(p))
        return;
    pose.focus = camera_depth(view_of(p), p->cursor.pick.position);
    if (!(pose.focus > 0)) {
        render_control_say(p->work, "what is picked lies behind the camera");
        return;
    }
    jump(p, &pose);
    if (pose.aperture > 0)
        render_control_say(p->work, "sharp %.4g away", pose.focus);
    else
        render_control_say(p->work, "sharp %.4g away once the lens is open: %s",
                           pose.focus,
                           render_control_key(p->work, ACTION_OPEN).text);
}

/* ---- numbered views ---- */

static int number_of(enum action action)
{
    return (int)action - ACTION_VIEW_1 + 1;
}

static bool is_number(enum action action)
{
    return action >= ACTION_VIEW_1 && action <= ACTION_VIEW_9;
}

void camera_control_keep_view(struct camera_control *p, enum action action)
{
    int number = number_of(action);
    struct view *v = view_of(p);

    if (!is_number(action))
        return;
    v->shots[number - 1] = view_pose(v);
    v->has_shot[number - 1] = true;
    render_control_say(p->work,
                       "this is view %d: %s writes it to the view file", number,
                       render_control_key(p->work, ACTION_SAVE_VIEW).text);
}

static void go_to_view(struct camera_control *p, int number)
{
    if (!view_of(p)->has_shot[number - 1]) {
        render_control_say(p->work, "no view %d yet: %s %d makes this one so",
                           number,
                           render_control_key(p->work, ACTION_KEEP).text,
                           number);
    } else if (may_jump(p)) {
        jump(p, &view_of(p)->shots[number - 1]);
        render_control_say(p->work, "view %d", number);
    }
}

/* ---- all of it ---- */

bool camera_control_act(struct camera_control *p, enum action action)
{
    const struct move *move = find_move(action);

    if (!move)
        land(p);
    if (is_number(action)) {
        go_to_view(p, number_of(action));
        return true;
    }
    if (pick_cursor_act(&p->cursor, action)) {
        if (p->cursor.has_pick)
            find_pivot(p);
        return true;
    }
    if (move) {
        press(p, move);
        return true;
    }
    switch (action) {
    case ACTION_FASTER: change_speed(p, 1); break;
    case ACTION_SLOWER: change_speed(p, -1); break;
    case ACTION_ORBIT: switch_orbit(p); break;
    case ACTION_FRAME: frame_object(p); break;
    case ACTION_FRAME_ALL: frame_all(p); break;
    case ACTION_FOCUS: focus(p); break;
    case ACTION_UNDO: travel(p, true); break;
    case ACTION_REDO: travel(p, false); break;
    case ACTION_RESET: reset(p); break;
    default: return false;
    }
    return true;
}

static void wheel(struct camera_control *p, bool is_up, bool is_modified)
{
    if (is_modified)
        press(p, find_move(is_up ? ACTION_NARROWER : ACTION_WIDER));
    else
        change_speed(p, is_up ? 1 : -1);
}

static bool steer_by(struct camera_control *p, const struct event *event)
{
    struct rect r = pick_cursor_shown_rect(&p->cursor);

    return camera_input_mouse(&p->steer, view_of(p), event, &p->canvas->fit,
                              r.width, r.height);
}

static void drag(struct camera_control *p, const struct event *event)
{
    struct pose before = view_pose(view_of(p));

    if (!render_control_may_move(p->work)) {
        p->steer.is_dragging = false; /* nor is it a click */
        return;
    }
    if (!steer_by(p, event))
        return;
    if (p->drag_is_new)
        camera_history_add(&p->history, &before);
    p->drag_is_new = false;
    p->held = ACTION_NONE;
    p->work->must_restart = true;
    judge(p);
}

void camera_control_mouse(struct camera_control *p, const struct event *event)
{
    switch (event->mouse) {
    case MOUSE_WHEEL_UP: wheel(p, true, event->is_modified); break;
    case MOUSE_WHEEL_DOWN: wheel(p, false, event->is_modified); break;
    case MOUSE_DRAG: drag(p, event); break;
    case MOUSE_PRESS:
        p->drag_is_new = true;
        if (camera_input_orbits(&p->steer, event) && !p->steer.is_orbiting)
            find_pivot(p);
        steer_by(p, event);
        break;
    case MOUSE_RELEASE:
        if (p->steer.is_dragging && !p->steer.has_dragged &&
            event->button == 0 &&
            pick_cursor_click(&p->cursor, event->x - 1, event->y - 1))
            find_pivot(p);
        steer_by(p, event);
        break;
    case MOUSE_OTHER: break;
    }
}

void camera_control_step(struct camera_control *p, uint64_t now_ns)
{
    steer_held(p, now_ns);
    pick_cursor_step(&p->cursor);
}

uint64_t camera_control_next_ns(const struct camera_control *p)
{
    return held_keys_next_ns(&p->steer.motion);
}

void camera_control_free(struct camera_control *p)
{
    camera_history_free(&p->history);
}
