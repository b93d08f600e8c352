// SPDX-License-Identifier: MIT
#include "glim/steer.h"

#include <math.h>

#include "glim/camera.h"

/* Through the whole scene in about three seconds. */
#define SPEED_START 0.3
#define SPEED_STEP  1.25
#define SPEED_MIN   1e-4
#define SPEED_MAX   100.0

/* Radians a second. */
#define LOOK_SPEED 0.9

#define RAD_PER_DEG 0.017453292519943295

void steer_init(struct steer *s, const double lo[3], const double hi[3])
{
    double square = 0;

    for (int i = 0; i < 3; i++)
        square += (hi[i] - lo[i]) * (hi[i] - lo[i]);
    *s = (struct steer){.speed = SPEED_START, .scene_size = sqrt(square)};
    if (!(s->scene_size > 0) || isinf(s->scene_size))
        s->scene_size = 1; /* a scene without extent */
}

bool steer_step(struct steer *s, struct view *view, uint64_t now_ns)
{
    double seconds[MOTION_AXES];
    double speed = s->speed * s->scene_size;

    if (!motion_step(&s->motion, now_ns, seconds))
        return false;
    camera_move(view, speed * seconds[MOTION_RIGHT], speed * seconds[MOTION_UP],
                speed * seconds[MOTION_FORWARD]);
    camera_turn(view, LOOK_SPEED * seconds[MOTION_LOOK_RIGHT],
                LOOK_SPEED * seconds[MOTION_LOOK_UP]);
    return true;
}

/* The look turns by the angle that the picture shows under the pointer's way.
 */
static bool drag(struct steer *s, struct view *view, const struct event *e,
                 const struct fit *fit, double shape)
{
    int right = e->x - s->drag_x;
    int down = e->y - s->drag_y;

    s->drag_x = e->x;
    s->drag_y = e->y;
    if (!s->is_dragging || (right == 0 && down == 0))
        return false;
    double height_rad = view->fovy_deg * RAD_PER_DEG;
    camera_turn(view, right * height_rad * shape / fit->cols,
                -down * height_rad / fit->rows);
    return true;
}

bool steer_mouse(struct steer *s, struct view *view, const struct event *event,
                 const struct fit *fit, int width_px, int height_px)
{
    switch (event->mouse) {
    case MOUSE_PRESS:
        s->is_dragging = true;
        s->drag_x = event->x;
        s->drag_y = event->y;
        break;
    case MOUSE_RELEASE: s->is_dragging = false; break;
    case MOUSE_DRAG:
        return drag(s, view, event, fit, (double)width_px / height_px);
    case MOUSE_WHEEL_UP:
    case MOUSE_WHEEL_DOWN:
    case MOUSE_OTHER: break;
    }
    return false;
}

void steer_change_speed(struct steer *s, int steps)
{
    double speed = s->speed * pow(SPEED_STEP, steps);

    s->speed = fmax(SPEED_MIN, fmin(SPEED_MAX, speed));
}
