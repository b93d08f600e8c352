// SPDX-License-Identifier: MIT
#include "studio/camera_control.h"

#include <string.h>

#include "studio/camera_moves.h"

/* The same key again within this time goes on with its step of undo: longer
 * than keyboards wait before they repeat. */
#define HELD_NS UINT64_C(700000000)

/* Actions that last as long as their key is held. */
static const struct move {
    enum action action;
    enum motion_axis axis;
    int sign;
} moves[] = {
    {ACTION_FORWARD, MOTION_FORWARD, 1},
    {ACTION_BACK, MOTION_FORWARD, -1},
    {ACTION_LEFT, MOTION_RIGHT, -1},
    {ACTION_RIGHT, MOTION_RIGHT, 1},
    {ACTION_DOWN, MOTION_UP, -1},
    {ACTION_UP, MOTION_UP, 1},
    {ACTION_LOOK_UP, MOTION_LOOK_UP, 1},
    {ACTION_LOOK_DOWN, MOTION_LOOK_UP, -1},
    {ACTION_LOOK_LEFT, MOTION_LOOK_RIGHT, -1},
    {ACTION_LOOK_RIGHT, MOTION_LOOK_RIGHT, 1},
    {ACTION_NARROWER, MOTION_WIDEN, -1},
    {ACTION_WIDER, MOTION_WIDEN, 1},
    {ACTION_CLOSE, MOTION_OPEN, -1},
    {ACTION_OPEN, MOTION_OPEN, 1},
};

static struct view *view_of(const struct pilot *p)
{
    return &p->work->session->view;
}

static const struct scene *scene_of(const struct pilot *p)
{
    return &p->work->session->scene;
}

void pilot_init(struct pilot *p, struct work *work, struct canvas *canvas)
{
    const struct scene *scene = &work->session->scene;

    *p = (struct pilot){.work = work,
                        .canvas = canvas,
                        .cursor = {.work = work, .canvas = canvas}};
    steer_init(&p->steer, scene->bounds_lo, scene->bounds_hi);
}

void pilot_stop(struct pilot *p)
{
    motion_stop(&p->steer.motion);
    p->steer.is_dragging = false;
    p->held = ACTION_NONE;
}

/* The eye is somewhere else, without a way there. */
static void forget_place(struct pilot *p)
{
    clearance_forget(&p->around);
    p->said = CLEARANCE_AMONG;
}

void pilot_renew(struct pilot *p)
{
    p->cursor.has_pick = false;
    p->cursor.is_pick_new = false;
    p->cursor.must_look = p->canvas->has_cursor;
    forget_place(p);
    steer_resize(&p->steer, scene_of(p)->bounds_lo, scene_of(p)->bounds_hi);
}

/* ---- where the eye is ---- */

/* The tree is the render thread's until it is loaded. */
static void look_around(struct pilot *p)
{
    const struct scene *s = scene_of(p);

    if (!render_is_loaded(p->work->session->render) || s->tree.nodes == NULL)
        return;
    clearance_follow(&p->around, s, view_of(p));
    steer_adapt(&p->steer, p->around.near, p->around.away);
}

static void say_place(struct pilot *p)
{
    const struct clearance *c = &p->around;
    struct keys_name key = work_key(p->work, ACTION_RESET);
    const char *name;

    if (c->place == CLEARANCE_INSIDE) {
        name = cursor_object_name(&p->cursor, c->passed);
        work_say_long(p->work, "inside of %.60s: %s returns", name, key.text);
    } else if (c->place == CLEARANCE_OUTSIDE) {
        work_say_long(p->work, "outside%s, behind a wall: %s returns",
                      c->away > 0 ? " the scene" : "", key.text);
    } else {
        work_say_long(p->work, "nothing of the scene is in view: %s returns",
                      key.text);
    }
    p->said_ns = p->work->message.said_ns;
}

/* After a move: who loses the scene is told so once; the message goes with its
 * reason. */
static void judge(struct pilot *p)
{
    look_around(p);
    if (p->around.place == p->said)
        return;
    p->said = p->around.place;
    if (p->said != CLEARANCE_AMONG)
        say_place(p);
    else if (p->said_ns == p->work->message.said_ns)
        work_be_silent(p->work);
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

static void add_step(struct pilot *p)
{
    struct pose pose = view_pose(view_of(p));

    history_add(&p->history, &pose);
}

static void say_lens(struct pilot *p)
{
    const struct view *v = view_of(p);

    if (p->held == ACTION_NARROWER || p->held == ACTION_WIDER)
        work_say(p->work, "field of view %.3g degrees", v->fovy_deg);
    else if (p->held != ACTION_CLOSE && p->held != ACTION_OPEN)
        return;
    else if (v->aperture > 0)
        work_say(p->work, "lens open by %.3g", v->aperture);
    else
        work_say(p->work, "a pinhole: everything is sharp");
}

static void steer_held(struct pilot *p, uint64_t now_ns)
{
    uint64_t next_ns;
    bool has_moved = false;

    /* each step as long as what is around allows, also where the loop is late
     */
    while ((next_ns = motion_next_ns(&p->steer.motion)) <= now_ns &&
           next_ns != UINT64_MAX) {
        look_around(p);
        has_moved |= steer_step(&p->steer, view_of(p), next_ns);
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
static void land(struct pilot *p)
{
    steer_held(p, UINT64_MAX);
}

/* What was held until now is not lost where the loop was late. */
static void press(struct pilot *p, const struct move *move)
{
    uint64_t now_ns = clock_ns();

    if (!work_may_move(p->work))
        return;
    steer_held(p, now_ns);
    if (move->action != p->held || now_ns - p->held_ns > HELD_NS) {
        add_step(p);
        steer_begin(&p->steer, now_ns);
    }
    p->held = move->action;
    p->held_ns = now_ns;
    motion_press(&p->steer.motion, move->axis, move->sign, now_ns);
    steer_held(p, now_ns);
}

/* True if the camera may jump now; what is held is let go. */
static bool may_jump(struct pilot *p)
{
    if (!work_may_move(p->work))
        return false;
    pilot_stop(p);
    return true;
}

static void jump(struct pilot *p, const struct pose *pose)
{
    add_step(p);
    view_set_pose(view_of(p), pose);
    forget_place(p);
    p->work->must_restart = true;
}

static void change_speed(struct pilot *p, int steps)
{
    steer_change_speed(&p->steer, steps);
    look_around(p);
    work_say(p->work, "speed times %.3g: %.3g a second here", p->steer.speed,
             steer_speed(&p->steer));
}

static void reset(struct pilot *p)
{
    struct pose pose = view_pose(&p->work->session->opened);

    if (!may_jump(p))
        return;
    jump(p, &pose);
    work_say(p->work, "the view as it was opened");
}

static void travel(struct pilot *p, bool is_back)
{
    struct pose pose = view_pose(view_of(p));

    if (!may_jump(p))
        return;
    if (is_back ? !history_undo(&p->history, &pose)
                : !history_redo(&p->history, &pose)) {
        work_say(p->work, is_back ? "nothing to undo" : "nothing to do again");
        return;
    }
    view_set_pose(view_of(p), &pose);
    forget_place(p);
    p->work->must_restart = true;
    work_say(p->work, is_back ? "undone" : "done again");
}

/* ---- orbit, frame, focus ---- */

/* What is picked, or what is in the middle of the picture, or of the scene. */
static void find_pivot(struct pilot *p)
{
    struct pick pick = p->cursor.pick;

    if (!p->cursor.has_pick && !cursor_look_ahead(&p->cursor, &pick))
        memcpy(pick.position, scene_of(p)->center, sizeof pick.position);
    memcpy(p->steer.pivot, pick.position, sizeof p->steer.pivot);
}

static bool need_pick(struct pilot *p)
{
    if (!cursor_need_pick(&p->cursor))
        return false;
    find_pivot(p);
    return true;
}

static void switch_orbit(struct pilot *p)
{
    bool picks = p->canvas->has_cursor;

    if (picks && !need_pick(p))
        return;
    motion_stop(&p->steer.motion);
    p->steer.is_orbiting = picks || !p->steer.is_orbiting;
    find_pivot(p);
    work_say(p->work, !p->steer.is_orbiting ? "arrows and mouse look around"
                      : p->cursor.has_pick
                          ? "arrows and mouse orbit what is picked"
                          : "arrows and mouse orbit the middle");
}

static void frame(struct pilot *p, const double lo[3], const double hi[3],
                  const char *name)
{
    struct view framed = *view_of(p);
    struct pose pose;

    if (!may_jump(p))
        return;
    camera_frame(&framed, lo, hi);
    pose = view_pose(&framed);
    jump(p, &pose);
    work_say(p->work, "%s", name);
}

static void frame_object(struct pilot *p)
{
    uint32_t object;
    double lo[3], hi[3];

    if (!need_pick(p))
        return;
    object = p->cursor.pick.object;
    pick_bounds(scene_of(p), object, lo, hi);
    frame(p, lo, hi, cursor_object_name(&p->cursor, object));
}

static void frame_all(struct pilot *p)
{
    const struct scene *s = scene_of(p);

    if (s->tri_count > 0)
        frame(p, s->bounds_lo, s->bounds_hi, "the whole scene");
    else
        work_say(p->work, "no faces to frame");
}

static void focus(struct pilot *p)
{
    struct pose pose = view_pose(view_of(p));

    if (!need_pick(p) || !may_jump(p))
        return;
    pose.focus = camera_depth(view_of(p), p->cursor.pick.position);
    if (!(pose.focus > 0)) {
        work_say(p->work, "what is picked lies behind the camera");
        return;
    }
    jump(p, &pose);
    if (pose.aperture > 0)
        work_say(p->work, "sharp %.4g away", pose.focus);
    else
        work_say(p->work, "sharp %.4g away once the lens is open: %s",
                 pose.focus, work_key(p->work, ACTION_OPEN).text);
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

void pilot_keep_view(struct pilot *p, enum action action)
{
    int number = number_of(action);
    struct view *v = view_of(p);

    if (!is_number(action))
        return;
    v->shots[number - 1] = view_pose(v);
    v->has_shot[number - 1] = true;
    work_say(p->work, "this is view %d: %s writes it to the view file", number,
             work_key(p->work, ACTION_SAVE_VIEW).text);
}

static void go_to_view(struct pilot *p, int number)
{
    if (!view_of(p)->has_shot[number - 1]) {
        work_say(p->work, "no view %d yet: %s %d makes this one so", number,
                 work_key(p->work, ACTION_KEEP).text, number);
    } else if (may_jump(p)) {
        jump(p, &view_of(p)->shots[number - 1]);
        work_say(p->work, "view %d", number);
    }
}

/* ---- all of it ---- */

bool pilot_act(struct pilot *p, enum action action)
{
    const struct move *move = find_move(action);

    if (!move)
        land(p);
    if (is_number(action)) {
        go_to_view(p, number_of(action));
        return true;
    }
    if (cursor_act(&p->cursor, action)) {
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

static void wheel(struct pilot *p, bool is_up, bool is_modified)
{
    if (is_modified)
        press(p, find_move(is_up ? ACTION_NARROWER : ACTION_WIDER));
    else
        change_speed(p, is_up ? 1 : -1);
}

static bool steer_by(struct pilot *p, const struct event *event)
{
    struct rect r = cursor_shown_rect(&p->cursor);

    return steer_mouse(&p->steer, view_of(p), event, &p->canvas->fit, r.width,
                       r.height);
}

static void drag(struct pilot *p, const struct event *event)
{
    struct pose before = view_pose(view_of(p));

    if (!work_may_move(p->work)) {
        p->steer.is_dragging = false; /* nor is it a click */
        return;
    }
    if (!steer_by(p, event))
        return;
    if (p->drag_is_new)
        history_add(&p->history, &before);
    p->drag_is_new = false;
    p->held = ACTION_NONE;
    p->work->must_restart = true;
    judge(p);
}

void pilot_mouse(struct pilot *p, const struct event *event)
{
    switch (event->mouse) {
    case MOUSE_WHEEL_UP: wheel(p, true, event->is_modified); break;
    case MOUSE_WHEEL_DOWN: wheel(p, false, event->is_modified); break;
    case MOUSE_DRAG: drag(p, event); break;
    case MOUSE_PRESS:
        p->drag_is_new = true;
        if (steer_orbits(&p->steer, event) && !p->steer.is_orbiting)
            find_pivot(p);
        steer_by(p, event);
        break;
    case MOUSE_RELEASE:
        if (p->steer.is_dragging && !p->steer.has_dragged &&
            event->button == 0 &&
            cursor_click(&p->cursor, event->x - 1, event->y - 1))
            find_pivot(p);
        steer_by(p, event);
        break;
    case MOUSE_OTHER: break;
    }
}

void pilot_step(struct pilot *p, uint64_t now_ns)
{
    steer_held(p, now_ns);
    cursor_step(&p->cursor);
}

uint64_t pilot_next_ns(const struct pilot *p)
{
    return motion_next_ns(&p->steer.motion);
}

void pilot_free(struct pilot *p)
{
    history_free(&p->history);
}
