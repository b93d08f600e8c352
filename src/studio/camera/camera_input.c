// SPDX-License-Identifier: MIT
#include "studio/camera/camera_input.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "studio/camera/surfaces.h"

/* ---- moves ---- */

/* Least angle to the poles, where the picture would turn about its centre. */
#define POLE_RAD 0.01

void camera_move(struct pose *pose, double right, double up, double forward)
{
    struct axes axes;

    pose_axes(pose, &axes);
    for (int i = 0; i < 3; i++) {
        double step =
            right * axes.right[i] + up * axes.up[i] + forward * axes.forward[i];

        pose->eye[i] += step;
        pose->at[i] += step;
    }
}

void camera_turn(struct pose *pose, double right_rad, double up_rad)
{
    double reach = pose_reach(pose);
    double azimuth_cos = cos(right_rad), azimuth_sin = sin(right_rad);
    double level[3], polar;
    struct axes axes;

    pose_axes(pose, &axes);
    /* `right` and `level` span the plane perpendicular to the pole; `level` is
     * the forward axis without its part along the pole */
    vec3d_cross(axes.pole, axes.right, level);
    vec3d_normalize(level);
    polar = acos(fmax(-1, fmin(1, vec3d_dot(axes.forward, axes.pole))));
    polar = fmax(POLE_RAD, fmin(M_PI - POLE_RAD, polar - up_rad));
    for (int i = 0; i < 3; i++) {
        double around = azimuth_cos * level[i] + azimuth_sin * axes.right[i];

        pose->at[i] = pose->eye[i] +
                      reach * (cos(polar) * axes.pole[i] + sin(polar) * around);
    }
}

/* Computes the coordinates of `point` relative to `from` along the axes. */
static void to_axes(const struct axes *axes, const double from[3],
                    const double point[3], double xyz[3])
{
    double offset[3];

    vec3d_sub(point, from, offset);
    xyz[0] = vec3d_dot(offset, axes->right);
    xyz[1] = vec3d_dot(offset, axes->up);
    xyz[2] = vec3d_dot(offset, axes->forward);
}

/* `around` keeps its coordinates in the axes of the camera. */
void camera_orbit(struct pose *pose, const double around[3], double right_rad,
                  double up_rad)
{
    struct axes axes;
    double xyz[3];

    pose_axes(pose, &axes);
    to_axes(&axes, pose->eye, around, xyz);
    camera_turn(pose, -right_rad, -up_rad);
    pose_axes(pose, &axes);
    for (int i = 0; i < 3; i++) {
        double eye = around[i] - xyz[0] * axes.right[i] - xyz[1] * axes.up[i] -
                     xyz[2] * axes.forward[i];

        pose->at[i] += eye - pose->eye[i];
        pose->eye[i] = eye;
    }
}

/* Returns one of the eight corners of a box. */
static void corner_of(const double lo[3], const double hi[3], int corner,
                      double p[3])
{
    for (int i = 0; i < 3; i++)
        p[i] = corner >> i & 1 ? hi[i] : lo[i];
}

void camera_frame(struct pose *pose, double aspect, const double lo[3],
                  const double hi[3])
{
    double center[3], half[3];
    struct pose_fit fit;

    for (int i = 0; i < 3; i++) {
        center[i] = lo[i] / 2 + hi[i] / 2;
        half[i] = hi[i] / 2 - lo[i] / 2;
    }
    pose_fit_begin(&fit, pose, aspect);
    pose_fit_add_box(&fit, half);
    pose_fit_place(&fit, center, 1, vec3d_length(half), pose);
}

/* The box is invisible if all corners are beyond the same plane of the
 * frustum. */
bool camera_sees_box(const struct pose *pose, double aspect, const double lo[3],
                     const double hi[3])
{
    double slope_y = tan(angle_rad(pose->fovy_deg) / 2);
    double slope_x = slope_y * aspect;
    double most[5] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
    struct axes axes;

    pose_axes(pose, &axes);
    for (int corner = 0; corner < 8; corner++) {
        double p[3], xyz[3];

        corner_of(lo, hi, corner, p);
        to_axes(&axes, pose->eye, p, xyz);
        most[0] = fmax(most[0], xyz[2]);
        most[1] = fmax(most[1], slope_x * xyz[2] - xyz[0]);
        most[2] = fmax(most[2], slope_x * xyz[2] + xyz[0]);
        most[3] = fmax(most[3], slope_y * xyz[2] - xyz[1]);
        most[4] = fmax(most[4], slope_y * xyz[2] + xyz[1]);
    }
    for (int i = 0; i < 5; i++)
        if (!(most[i] >= 0))
            return false;
    return true;
}

double camera_depth(const struct pose *pose, const double point[3])
{
    struct axes axes;
    double xyz[3];

    pose_axes(pose, &axes);
    to_axes(&axes, pose->eye, point, xyz);
    return xyz[2];
}

void camera_widen(struct pose *pose, double factor)
{
    double half_rad = atan(factor * tan(angle_rad(pose->fovy_deg) / 2));

    pose->fovy_deg =
        fmax(FOVY_MIN_DEG, fmin(FOVY_MAX_DEG, angle_deg(2 * half_rad)));
}

/* ---- input ---- */

/* ---- held keys ---- */

/* Time after which a key without repeats counts as released: longer than the 33
 * to 40 ms between repeats, and too short to be felt as a delay of the stop. */
#define HELD_NS 150000000u

void held_keys_press(struct held_keys *m, enum held_keys_axis axis, int sign,
                     uint64_t now_ns)
{
    bool is_held = m->sign[axis] == sign && now_ns <= m->until_ns[axis];

    if (!is_held)
        m->from_ns[axis] = now_ns - HELD_KEYS_STEP_NS;
    m->sign[axis] = sign;
    m->until_ns[axis] = now_ns + HELD_NS - HELD_KEYS_STEP_NS;
}

bool held_keys_step(struct held_keys *m, uint64_t now_ns,
                    double seconds[HELD_KEYS_AXES])
{
    bool has_moved = false;

    for (int i = 0; i < HELD_KEYS_AXES; i++) {
        uint64_t to_ns = now_ns < m->until_ns[i] ? now_ns : m->until_ns[i];

        seconds[i] = 0;
        if (m->sign[i] == 0)
            continue;
        if (to_ns > m->from_ns[i]) {
            seconds[i] = m->sign[i] * (double)(to_ns - m->from_ns[i]) * 1e-9;
            m->from_ns[i] = to_ns;
            has_moved = true;
        }
        if (now_ns >= m->until_ns[i])
            m->sign[i] = 0;
    }
    return has_moved;
}

uint64_t held_keys_next_ns(const struct held_keys *m)
{
    uint64_t next_ns = UINT64_MAX;

    for (int i = 0; i < HELD_KEYS_AXES; i++) {
        uint64_t due_ns = m->from_ns[i] + HELD_KEYS_STEP_NS;

        if (m->sign[i] != 0 && due_ns < next_ns)
            next_ns = due_ns;
    }
    return next_ns;
}

void held_keys_stop(struct held_keys *m)
{
    *m = (struct held_keys){0};
}

/* ---- keys and the mouse ---- */

/* Initial speed in reaches per second. A tap, which lasts 150 ms, moves by
 * about a fifth of the distance to the nearest surface; a key that is held
 * towards a wall approaches it ever more slowly. */
#define PACE 1.0

/* Bounds of the reach, in units of the scene's size. REACH_MIN lets the eye
 * leave a surface, and pass it if walls do not stop it; REACH_MAX crosses the
 * scene in a few seconds; REACH_FIRST is used until the clearance is known. */
#define REACH_MIN   0.002
#define REACH_MAX   0.25
#define REACH_FIRST 0.05

/* Outside of the scene the reach grows with the distance, up to AWAY_MAX scene
 * sizes: a key that is held for a minute must not move the eye to infinity. */
#define AWAY     0.1
#define AWAY_MAX 10.0

/* Increase of the speed factor per second that a key is held, and its
 * maximum. */
#define RAMP     0.75
#define RAMP_MAX 8.0

#define SPEED_STEP 1.25
#define SPEED_MIN  1e-3
#define SPEED_MAX  1e3

/* Radians per second. */
#define LOOK_SPEED  0.9
#define ORBIT_SPEED 1.5

/* Largest turn of an orbit between two tests for surfaces: the eye is then
 * within a thousandth of the distance from the arc. */
#define ORBIT_STEP_RAD 0.08

/* Exponents per second. A tap, which lasts 150 ms, changes the field of view by
 * a tenth and the lens by one stop: half the light, a diameter of 1/sqrt 2. */
#define WIDEN_SPEED 0.7
#define OPEN_SPEED  2.3105

/* Bounds of the aperture, in units of the focus distance. A smaller lens is
 * like a pinhole: the blur of distant points, as many radians, is less than a
 * pixel. */
#define APERTURE_MIN 1e-3
#define APERTURE_MAX 1.0

void camera_input_init(struct camera_input *s, const double lo[3],
                       const double hi[3])
{
    *s = (struct camera_input){.speed = 1};
    camera_input_resize(s, lo, hi);
}

void camera_input_resize(struct camera_input *s, const double lo[3],
                         const double hi[3])
{
    double diagonal[3];

    vec3d_sub(hi, lo, diagonal);
    s->scene_size = vec3d_length(diagonal);
    if (!(s->scene_size > 0) || isinf(s->scene_size))
        s->scene_size = 1; /* the scene has no extent */
    s->reach = REACH_FIRST * s->scene_size;
}

void camera_input_adapt(struct camera_input *s, double near, double away)
{
    double far = fmin(away, AWAY_MAX * s->scene_size);
    double least = fmax(REACH_MIN * s->scene_size, AWAY * far);

    s->reach = fmax(least, fmin(near, REACH_MAX * s->scene_size));
}

double camera_input_speed(const struct camera_input *s)
{
    return s->speed * PACE * s->reach;
}

void camera_input_begin(struct camera_input *s, uint64_t now_ns)
{
    s->begun_ns = now_ns;
}

/* Returns the speed factor of a key that was held for some seconds. */
static double ramp(double seconds)
{
    return fmin(1 + RAMP * fmax(seconds, 0), RAMP_MAX);
}

void camera_input_set_pivot(struct camera_input *s, const double pivot[3])
{
    if (memcmp(s->pivot, pivot, sizeof s->pivot) != 0)
        s->orbit_distance = 0;
    memcpy(s->pivot, pivot, sizeof s->pivot);
}

/* Moves the eye to a place, without turning the camera. */
static void place_eye(struct pose *pose, const double eye[3])
{
    double offset[3];

    vec3d_sub(eye, pose->eye, offset);
    point_along(pose->at, offset, 1, pose->at);
    memcpy(pose->eye, eye, sizeof pose->eye);
}

static void move(struct camera_input *s, struct pose *pose, double right,
                 double up, double forward)
{
    struct pose moved = *pose;
    double eye[3];

    if (right == 0 && up == 0 && forward == 0)
        return;
    s->is_stopped = false;
    camera_move(&moved, right, up, forward);
    if (s->walls.scene != NULL) {
        memcpy(eye, moved.eye, sizeof eye);
        s->is_stopped = collision_slide(&s->walls, pose->eye, eye, &s->blocker);
        place_eye(&moved, eye);
    }
    *pose = moved;
}

static void orbit(struct camera_input *s, struct pose *pose, double right_rad,
                  double up_rad)
{
    int count =
        (int)fmin(ceil(hypot(right_rad, up_rad) / ORBIT_STEP_RAD), 1000);
    double offset[3];

    s->is_stopped = false;
    vec3d_sub(pose->eye, s->pivot, offset);
    if (!(s->orbit_distance > 0) ||
        memcmp(s->orbit_eye, pose->eye, sizeof s->orbit_eye) != 0)
        s->orbit_distance = vec3d_length(offset);
    for (int i = 0; i < count; i++) {
        struct pose turned = *pose;

        camera_orbit(&turned, s->pivot, right_rad / count, up_rad / count);
        if (s->walls.scene != NULL) {
            double eye[3];

            memcpy(eye, turned.eye, sizeof eye);
            s->blocker = NO_INDEX;
            s->is_stopped = !collision_orbit(&s->walls, s->pivot,
                                             s->orbit_distance, pose->eye, eye);
            if (s->is_stopped)
                break;
            place_eye(&turned, eye);
        }
        *pose = turned;
    }
    memcpy(s->orbit_eye, pose->eye, sizeof s->orbit_eye);
}

static void turn(struct camera_input *s, struct pose *pose,
                 const double seconds[HELD_KEYS_AXES])
{
    double right = seconds[HELD_KEYS_LOOK_RIGHT];
    double up = seconds[HELD_KEYS_LOOK_UP];

    if (right == 0 && up == 0)
        return;
    if (s->is_orbiting)
        orbit(s, pose, ORBIT_SPEED * right, ORBIT_SPEED * up);
    else
        camera_turn(pose, LOOK_SPEED * right, LOOK_SPEED * up);
}

/* Changes the aperture. Below APERTURE_MIN it becomes 0, a pinhole. */
static void open_lens(struct pose *pose, double seconds)
{
    double sharp = pose->focus > 0 ? pose->focus : camera_depth(pose, pose->at);
    double least = APERTURE_MIN * sharp;
    double aperture = fmax(pose->aperture, least) * exp(OPEN_SPEED * seconds);

    pose->aperture =
        aperture > least ? fmin(aperture, APERTURE_MAX * sharp) : 0;
}

bool camera_input_step(struct camera_input *s, struct pose *pose,
                       uint64_t now_ns)
{
    double seconds[HELD_KEYS_AXES];
    double held =
        now_ns > s->begun_ns ? (double)(now_ns - s->begun_ns) * 1e-9 : 0;
    double speed = camera_input_speed(s) * ramp(held);

    if (!held_keys_step(&s->motion, now_ns, seconds))
        return false;
    move(s, pose, speed * seconds[HELD_KEYS_RIGHT],
         speed * seconds[HELD_KEYS_UP], speed * seconds[HELD_KEYS_FORWARD]);
    turn(s, pose, seconds);
    if (seconds[HELD_KEYS_WIDEN] != 0)
        camera_widen(pose, exp(WIDEN_SPEED * seconds[HELD_KEYS_WIDEN]));
    if (seconds[HELD_KEYS_OPEN] != 0)
        open_lens(pose, seconds[HELD_KEYS_OPEN]);
    return true;
}

/* Turns by the angle that corresponds to the pointer's motion in the picture.
 * An orbit follows the pointer with the pivot's front, half a turn for the
 * height of the picture. */
static bool drag(struct camera_input *s, struct pose *pose,
                 const struct event *e, const struct cells_rect *fit,
                 double shape)
{
    double right = (e->x - s->drag_x) * shape / fit->cols;
    double down = (double)(e->y - s->drag_y) / fit->rows;
    double height_rad = angle_rad(pose->fovy_deg);

    s->drag_x = e->x;
    s->drag_y = e->y;
    if (!s->is_dragging || (right == 0 && down == 0))
        return false;
    s->has_dragged = true;
    if (s->drag_orbits)
        orbit(s, pose, -right * M_PI, down * M_PI);
    else
        camera_turn(pose, right * height_rad, -down * height_rad);
    return true;
}

bool camera_input_orbits(const struct camera_input *s,
                         const struct event *event)
{
    return s->is_orbiting || event->button != 0 || event->is_modified;
}

bool camera_input_mouse(struct camera_input *s, struct pose *pose,
                        const struct event *event, const struct cells_rect *fit,
                        int width_px, int height_px)
{
    switch (event->mouse) {
    case MOUSE_PRESS:
        s->is_dragging = true;
        s->drag_orbits = camera_input_orbits(s, event);
        s->has_dragged = false;
        s->drag_x = event->x;
        s->drag_y = event->y;
        break;
    case MOUSE_RELEASE: s->is_dragging = false; break;
    case MOUSE_DRAG:
        return drag(s, pose, event, fit, (double)width_px / height_px);
    case MOUSE_WHEEL_UP:
    case MOUSE_WHEEL_DOWN:
    case MOUSE_OTHER: break;
    }
    return false;
}

void camera_input_change_speed(struct camera_input *s, int steps)
{
    double speed = s->speed * pow(SPEED_STEP, steps);

    s->speed = fmax(SPEED_MIN, fmin(SPEED_MAX, speed));
}
