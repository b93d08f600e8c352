// SPDX-License-Identifier: MIT
/*
 * camera_input.h - converts held keys and mouse drags to motions of a camera,
 * which moves and turns without roll
 *
 * Units:     nanoseconds of clock_ns(), terminal cells, file units, radians;
 * held times in seconds; aspect is a picture's width over its height Threads:
 * one thread at a time
 */
#ifndef GLIM_CAMERA_INPUT_H
#define GLIM_CAMERA_INPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/pose.h"
#include "scene/pose_fit.h"
#include "studio/camera/surfaces.h"
#include "terminal/cells.h"
#include "terminal/tty_input.h"

/* ---- moves ---- */

/* Moves eye and at along the camera's axes. */
void camera_move(struct pose *pose, double right, double up, double forward);

/* Turns the viewing direction to the right about the pole and up towards it,
 * but not beyond 0.01 rad from the poles. The distance from eye to at stays. */
void camera_turn(struct pose *pose, double right_rad, double up_rad);

/* Moves the eye on a sphere around a point, to the right about the pole and up
 * towards it. The point keeps its place in the picture. Stops near the poles
 * like camera_turn(). */
void camera_orbit(struct pose *pose, const double around[3], double right_rad,
                  double up_rad);

/* Moves the camera, without turning it, so that a box just fits into the
 * picture (pose_fit_place()). */
void camera_frame(struct pose *pose, double aspect, const double lo[3],
                  const double hi[3]);

/* Returns false if no point of a box can be in the picture. */
bool camera_sees_box(const struct pose *pose, double aspect, const double lo[3],
                     const double hi[3]);

/* Returns the distance of a point from the eye along the viewing direction,
 * which is the focus distance for it. It is negative behind the eye. */
double camera_depth(const struct pose *pose, const double point[3]);

#define FOVY_MIN_DEG 0.1
#define FOVY_MAX_DEG 170.0

/* Multiplies the tangent of half the field of view by `factor`. The result is
 * between FOVY_MIN_DEG and FOVY_MAX_DEG. */
void camera_widen(struct pose *pose, double factor);

/* ---- input ---- */

/*
 * The speed of moves is proportional to the distance of the surfaces around the
 * eye: slow in a room, slower at a wall, fast over a landscape, and independent
 * of the model's size. It grows while a key is held. Walls stop the eye.
 */

/* ---- held keys ---- */

/*
 * Terminals report presses and repeats of a key, but no releases. A key counts
 * as held until no repeat has come for 150 ms.
 */

enum held_keys_axis {
    HELD_KEYS_RIGHT,
    HELD_KEYS_UP,
    HELD_KEYS_FORWARD,
    HELD_KEYS_LOOK_RIGHT,
    HELD_KEYS_LOOK_UP,
    HELD_KEYS_WIDEN, /* field of view */
    HELD_KEYS_OPEN,  /* aperture */
    HELD_KEYS_AXES
};

/* Time between two steps: 60 per second. */
#define HELD_KEYS_STEP_NS 16666667u

/* State of the keys of all axes. In a zeroed struct no key is held. */
struct held_keys {
    /* start of the held time that no step has returned yet */
    uint64_t from_ns[HELD_KEYS_AXES];
    uint64_t until_ns[HELD_KEYS_AXES];
    int sign[HELD_KEYS_AXES];
};

/* Reports a press or repeat of a key of an axis; sign is 1 or -1. */
void held_keys_press(struct held_keys *m, enum held_keys_axis axis, int sign,
                     uint64_t now_ns);

/* Computes for each axis the time in seconds that it was held since the last
 * call, with the sign of its key. A new press counts as one step at once.
 * Returns false if all are 0. */
bool held_keys_step(struct held_keys *m, uint64_t now_ns,
                    double seconds[HELD_KEYS_AXES]);

/* Returns the time of the next held_keys_step(), or UINT64_MAX if no key is
 * held. */
uint64_t held_keys_next_ns(const struct held_keys *m);

/* Releases all keys. */
void held_keys_stop(struct held_keys *m);

/* ---- keys and the mouse ---- */

struct camera_input {
    struct held_keys motion;
    double scene_size;
    double reach;          /* distance that the speed is proportional to */
    double speed;          /* factor chosen by the person; 1 at first */
    uint64_t begun_ns;     /* time when the held key was pressed */
    struct surfaces walls; /* surfaces that stop moves; zero: none do */
    /* keys and drags orbit the pivot instead of looking around */
    bool is_orbiting;
    double pivot[3];
    /* distance to the pivot that an orbit returns to after a wall, while the
     * eye is where the orbit has left it */
    double orbit_distance, orbit_eye[3];
    bool is_stopped;  /* a surface stopped the last motion */
    uint32_t blocker; /* its object, or NO_INDEX if several are in the way */
    bool is_dragging;
    bool drag_orbits;
    bool has_dragged; /* the pointer moved since the press */
    int drag_x, drag_y;
};

/* Initialises the input for a scene between these corners. */
void camera_input_init(struct camera_input *s, const double lo[3],
                       const double hi[3]);

/* Adapts to new corners of the scene. Speed and pivot stay. */
void camera_input_resize(struct camera_input *s, const double lo[3],
                         const double hi[3]);

/* Sets the distances that the speed depends on: to the surfaces near the eye
 * (INFINITY: none), and to the scene's bounding box (0 inside). */
void camera_input_adapt(struct camera_input *s, double near, double away);

/* Returns the initial speed of moves in file units per second. */
double camera_input_speed(const struct camera_input *s);

/* Sets the centre of orbits. */
void camera_input_set_pivot(struct camera_input *s, const double pivot[3]);

/* Reports a new press of a key, which moves at the initial speed. */
void camera_input_begin(struct camera_input *s, uint64_t now_ns);

/* Moves the pose for the time that keys were held since the last call. Returns
 * true if it has changed. */
bool camera_input_step(struct camera_input *s, struct pose *pose,
                       uint64_t now_ns);

/* Returns true if a drag with this button orbits the pivot: always while
 * is_orbiting, else with modifiers or any button except the left one. */
bool camera_input_orbits(const struct camera_input *s,
                         const struct event *event);

/* Turns the pose with the pointer while a button is down. The picture of
 * width_px x height_px pixels covers the cells of `fit`. Returns true if the
 * pose has changed. */
bool camera_input_mouse(struct camera_input *s, struct pose *pose,
                        const struct event *event, const struct cells_rect *fit,
                        int width_px, int height_px);

/* Changes the speed by some steps of a factor 1.25; negative steps are
 * slower. */
void camera_input_change_speed(struct camera_input *s, int steps);

#endif
